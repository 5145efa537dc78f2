// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Refit after a local change of a fully refined tree, at places distributed over the surface. The
/// time of a place is the least of its passes; quantiles are over places.

#include "rt_core/records/changed_face.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/bench/cases.hpp"
#include "tests/bench/least_times.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/bench/static_model.hpp"
#include "tests/shared/random.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace tactus::bench
{

namespace
{

constexpr std::size_t kPlaces = 100;
constexpr std::uint32_t kClusteredFaces = 64;
/// Error code that faces change to and back from, so that their boxes grow and shrink.
constexpr ErrorCode kChangedError = 8;

/// The `count` items nearest to a point, with positions by `place_of`.
template <typename Item, typename PlaceOf>
std::vector<Item> nearest_items(const std::vector<Item>& items, const Vec3& point_m,
                                std::size_t count, const PlaceOf& place_of)
{
    std::vector<std::pair<double, std::size_t>> ranked;
    for (std::size_t i = 0; i < items.size(); ++i)
    {
        ranked.emplace_back((place_of(items[i]) - point_m).squaredNorm(), i);
    }
    count = std::min(count, ranked.size());
    std::nth_element(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count) - 1,
                     ranked.end());
    std::vector<Item> nearest;
    for (std::size_t i = 0; i < count; ++i)
    {
        nearest.push_back(items[ranked[i].second]);
    }
    return nearest;
}

struct ChangeTimes
{
    LeastTimes refit_us{kPlaces};
    LeastTimes all_us{kPlaces};
    std::uint64_t nodes{0}; ///< Refitted blocks and nodes, in total.
};

/// Times `change(there)` with its refit, there and back, `passes` times.
template <typename Change>
void time_change(AbTree& tree, std::size_t place, std::uint32_t passes, ChangeTimes& times,
                 const Change& change)
{
    for (std::uint32_t i = 0; i < 2 * passes; ++i)
    {
        const BenchClock::time_point start = BenchClock::now();
        change(i % 2 == 0);
        const BenchClock::time_point changed = BenchClock::now();
        const AbTree::RefitWork work = tree.refit();
        const BenchClock::time_point end = BenchClock::now();
        times.refit_us.keep(place, microseconds(changed, end));
        times.all_us.keep(place, microseconds(start, end));
        times.nodes += work.blocks + work.nodes;
    }
}

/// Points of the surface, evenly distributed over the order of its faces.
std::vector<Vec3> places_on(const Scene& scene)
{
    std::vector<Vec3> places;
    for (std::size_t i = 0; i < kPlaces; ++i)
    {
        const std::size_t face = test::mixed(kSeed, i) % scene.model.faces.size();
        places.push_back(to_vec3(scene.model.faces[face][0]));
    }
    return places;
}

/// Changes the error of the nearest `prims` at each place, and back. `corner_of` returns a prim's
/// first corner.
template <typename CornerOf>
ChangeTimes time_clustered_faces(AbTree& tree, const std::vector<PrimId>& prims,
                                 const std::vector<Vec3>& places, std::uint32_t passes,
                                 const CornerOf& corner_of)
{
    ChangeTimes times;
    for (std::size_t place = 0; place < places.size(); ++place)
    {
        const auto cluster = nearest_items(prims, places[place], kClusteredFaces,
                                           [&](PrimId prim) { return to_vec3(corner_of(prim)); });
        std::vector<Vec3f> corners;
        for (const PrimId prim : cluster)
        {
            corners.push_back(corner_of(prim));
        }
        const auto change = [&](bool there)
        {
            for (std::size_t i = 0; i < cluster.size(); ++i)
            {
                tree.move_corner(cluster[i], 0, corners[i], there ? kChangedError : ErrorCode{0});
            }
        };
        time_change(tree, place, passes, times, change);
    }
    return times;
}

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
