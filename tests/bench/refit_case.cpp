// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Refit after a local change of a fully refined tree, at places distributed over the surface. The
/// time of a place is the least of its passes; quantiles are over places.

#include "tests/bench/cases.hpp"
#include "tests/bench/least_times.hpp"
#include "tests/bench/local_changes.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/static_model.hpp"

#include <map>

namespace tactus::bench
{

namespace
{

constexpr std::size_t kMovedVertices = 180;
/// Displacement of vertices, there and back: a fraction of an edge.
constexpr double kMove_diag = 1e-4;

/// Row of a block that holds a vertex.
struct VertexRow
{
    std::uint32_t block{0};
    std::uint32_t row{0};
    Vec3f position_m{};
};

/// Vertex rows of a tree by position.
using VertexRows = std::map<Vec3f, std::vector<VertexRow>>;

VertexRows vertex_rows(const AbTree& tree)
{
    VertexRows rows;
    for (std::uint32_t block = 0; block < tree.pool().capacities().blocks; ++block)
    {
        const std::uint32_t used = tree.is_block_in_use(block) ? tree.block(block).vertices : 0U;
        for (std::uint32_t row = 0; row < kBlockVertices; ++row)
        {
            if (((used >> row) & 1U) != 0)
            {
                const auto& at = tree.block(block).coordinates;
                const Vec3f position{at[0][row], at[1][row], at[2][row]};
                rows[position].push_back({block, row, position});
            }
        }
    }
    return rows;
}

ChangeTimes time_faces(Model& model, const std::vector<Vec3>& places, std::uint32_t passes)
{
    std::vector<PrimId> prims;
    for (std::uint32_t face = 0; face < model.header.counts().face_ids(); ++face)
    {
        if (const PrimId prim = model.forest.find({face}); !prim.is_none())
        {
            prims.push_back(prim);
        }
    }
    return time_clustered_faces(model.tree, prims, places, passes,
                                [&](PrimId prim) { return model.forest.corners_of(prim)[0]; });
}

ChangeTimes time_vertices(AbTree& tree, const std::vector<Vec3>& places, float move_m,
                          std::uint32_t passes)
{
    const VertexRows rows = vertex_rows(tree);
    std::vector<Vec3f> vertices;
    for (const auto& [position, uses] : rows)
    {
        vertices.push_back(position);
    }
    ChangeTimes times;
    for (std::size_t place = 0; place < places.size(); ++place)
    {
        std::vector<VertexRow> moved;
        for (const Vec3f& vertex :
             nearest_items(vertices, places[place], kMovedVertices,
                           [](const Vec3f& position) { return to_vec3(position); }))
        {
            const std::vector<VertexRow>& uses = rows.at(vertex);
            moved.insert(moved.end(), uses.begin(), uses.end());
        }
        const auto change = [&](bool there)
        {
            for (const VertexRow& use : moved)
            {
                Vec3f to = use.position_m;
                to[2] += there ? move_m : 0.0F;
                tree.move_vertex(use.block, use.row, to);
            }
        };
        time_change(tree, place, passes, times, change);
    }
    return times;
}

} // namespace

void run_refit_case(const CaseContext& context, const RefitCase& test_case)
{
    const Scene& scene = context.scenes.get(test_case.scene);
    const PinnedCore pinned(context.options.core);
    StaticModel made(scene);
    Model& model = made.model();
    const std::vector<Vec3> places = places_on(scene);
    const std::uint32_t passes = context.options.passes_or(6, 3);
    const ChangeTimes faces = time_faces(model, places, passes);
    const auto move_m = static_cast<float>(kMove_diag * scene.model.diagonal_m);
    const ChangeTimes vertices = time_vertices(model.tree, places, move_m, passes);

    Row common = context.common_row(scene.model.name);
    common.frames = kPlaces;
    common.hash = model.forest.state_hash() + faces.nodes + 3 * vertices.nodes;
    CaseRows rows(context.rows, common);
    const Spread refit = spread_of(faces.refit_us.least());
    rows.add("64 clustered faces.p50", refit.p50, "us", goal_if(test_case.clustered));
    rows.add("64 clustered faces.max", refit.max, "us");
    const Spread with_change = spread_of(faces.all_us.least());
    rows.add("64 clustered faces, change included.p50", with_change.p50, "us");
    rows.add("64 clustered faces, change included.max", with_change.max, "us");
    const Spread moved = spread_of(vertices.all_us.least());
    rows.add("180 vertices.p50", moved.p50, "us", goal_if(test_case.moved_median));
    rows.add("180 vertices.max", moved.max, "us", goal_if(test_case.moved_worst));
    rows.add("180 vertices, refit alone.p50", quantile(vertices.refit_us.least(), 0.5), "us");
}

} // namespace tactus::bench
