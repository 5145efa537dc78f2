// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Choice of the bounding volume: the same faces in a tree of boxes and in one of 18-DOPs, with the
/// same queries and changes. Both use the portable kernels, since the 18-DOP's loops have no
/// others.

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/math/infinity.hpp"
#include "tests/bench/cases.hpp"
#include "tests/bench/local_changes.hpp"
#include "tests/bench/static_model.hpp"
#include "tests/bench/timed_queries.hpp"
#include "tests/shared/dop18_tree.hpp"
#include "tests/shared/nearest_walk.hpp"

#include <string>
#include <utility>

namespace tactus::bench
{

namespace
{

constexpr double kVolumeNear_diag = 2.0 * kRadius_diag;
constexpr double kTolerance_diag = 1e-9;

/// All faces of a fully refined model, in the order of their ids.
std::vector<ChangedFace> faces_of(const Model& model)
{
    std::vector<ChangedFace> faces;
    for (std::uint32_t face = 0; face < model.header.counts().face_ids(); ++face)
    {
        if (const PrimId prim = model.forest.find({face}); !prim.is_none())
        {
            faces.push_back(model.forest.describe(prim));
            faces.back().prim = {static_cast<std::uint32_t>(faces.size() - 1)};
        }
    }
    return faces;
}

/// Tree over all faces, with its memory.
template <typename Tree>
class WholeTree
{
public:
    WholeTree(const std::vector<ChangedFace>& faces, const AbTree& pattern)
        : capacities_{static_cast<std::uint32_t>(faces.size()),
                      pattern.blocks_used() + 2 * Tree::kReserve,
                      pattern.nodes_used() + 2 * Tree::kReserve}
        , memory_(required_bytes(capacities_) / sizeof(Line))
        , arena_(std::as_writable_bytes(std::span(memory_)))
        , pool_(arena_, capacities_)
        , tree_(pool_, ModelId{0}, capacities_, pattern.quantum_m(), portable_kernels())
    {
        for (const ChangedFace& face : faces)
        {
            tree_.insert(face);
        }
        tree_.refit();
    }

    [[nodiscard]] Tree& tree() { return tree_; }
    /// Memory in use, not that of the pools.
    [[nodiscard]] double used_mib() const
    {
        const double bytes =
            static_cast<double>(tree_.nodes_used()) * sizeof(typename Tree::Node) +
            static_cast<double>(tree_.blocks_used()) * (sizeof(BlockGeometry) + sizeof(BlockSide));
        return bytes / 0x1p20;
    }

private:
    struct alignas(Arena::kAlignment) Line
    {
        std::byte bytes[Arena::kAlignment];
    };

    static std::size_t required_bytes(const TreeCapacities& capacities)
    {
        Arena arena = Arena::measuring();
        const typename Tree::Pool pool(arena, capacities);
        return arena.used();
    }

    TreeCapacities capacities_;
    std::vector<Line> memory_;
    Arena arena_;
    typename Tree::Pool pool_;
    Tree tree_;
};

template <typename Tree>
class WalkQuery final : public PointQuery
{
public:
    WalkQuery(const Tree& tree, std::string name) : name_(std::move(name)), walk_(tree) {}

    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] double distance_m(const Vec3& point_m, double band_m) override
    {
        return walk_.least_m(point_m, band_m);
    }
    [[nodiscard]] std::uint64_t visits() const { return walk_.visits(); }

private:
    std::string name_;
    test::NearestWalk<Tree> walk_;
};

struct VolumeFigures
{
    Spread near_us;
    Spread flight_us;
    double visits{0.0}; ///< Nodes and blocks, mean of the near questions.
    Spread refit_us;
    double node_bytes{0.0};
    double used_mib{0.0};
    std::uint64_t hash{0}; ///< Hash of the answers, the same for every volume.
};

template <typename Tree>
VolumeFigures measure(const CaseContext& context, const std::string& name, const Scene& scene,
                      const Model& model, const std::vector<ChangedFace>& faces)
{
    WholeTree<Tree> whole(faces, model.tree);
    if (!whole.tree().is_complete())
    {
        throw Failure(name + ": the tree has no room for all faces");
    }
    const std::uint32_t frames = context.options.frames_or(4 * kCycleFrames, kCycleFrames);
    const Questions questions = ask(scene, touch_motion(scene.touch(), frames));
    const double band_m = kVolumeNear_diag * scene.model.diagonal_m;
    const double tolerance_m = kTolerance_diag * scene.model.diagonal_m;
    const std::uint32_t passes = context.options.passes_or(5, 3);
    WalkQuery query(whole.tree(), name);
    const auto banded = time_queries(query, questions, band_m, tolerance_m, passes);
    const auto visits = static_cast<double>(query.visits());
    const auto unbounded = time_queries(query, questions, kInfinity, tolerance_m, passes);
    VolumeFigures figures;
    figures.near_us = spread_of(chosen(banded.us.least(), questions.nearer_than(band_m)));
    figures.flight_us = spread_of(unbounded.us.least());
    figures.visits = visits / static_cast<double>(passes * questions.points_m.size());
    figures.node_bytes = sizeof(typename Tree::Node);
    figures.used_mib = whole.used_mib();
    figures.hash = banded.hash + 3 * unbounded.hash;
    std::vector<PrimId> prims;
    for (const ChangedFace& face : faces)
    {
        prims.push_back(face.prim);
    }
    const ChangeTimes changes =
        time_clustered_faces(whole.tree(), prims, places_on(scene), passes,
                             [&](PrimId prim) { return faces[prim.value].corners_m[0]; });
    figures.refit_us = spread_of(changes.refit_us.least());
    return figures;
}

void add_rows(CaseRows& rows, const VolumeFigures& dop, const VolumeFigures& box)
{
    const auto add = [&](const char* metric, const char* unit, double value, double peer)
    {
        Row& row = rows.add(std::string("18-DOP ") + metric, value, unit);
        row.peer = "AABB";
        row.peer_value = peer;
    };
    add("T_Q near.p50", "us", dop.near_us.p50, box.near_us.p50);
    add("T_Q near.p99", "us", dop.near_us.p99, box.near_us.p99);
    add("T_Q exact flight.p50", "us", dop.flight_us.p50, box.flight_us.p50);
    add("T_Q exact flight.p99", "us", dop.flight_us.p99, box.flight_us.p99);
    add("visits, banded, mean", "nodes", dop.visits, box.visits);
    add("T_B, 64 faces.p50", "us", dop.refit_us.p50, box.refit_us.p50);
    add("a node", "B", dop.node_bytes, box.node_bytes);
    add("the tree", "MiB", dop.used_mib, box.used_mib);
}

} // namespace

void run_volume_case(const CaseContext& context, const VolumeCase& test_case)
{
    const Scene& touched = context.scenes.get(test_case.scene);
    const PinnedCore pinned(context.options.core);
    StaticModel model(touched);
    const Model& refined = model.model();
    const std::vector<ChangedFace> faces = faces_of(refined);
    const auto box = measure<AbTree>(context, "AABB", touched, refined, faces);
    const auto dop = measure<test::Dop18Tree>(context, "18-DOP", touched, refined, faces);
    if (box.hash != dop.hash)
    {
        throw Failure("the volumes give different answers");
    }
    Row common = context.common_row(touched.model.name);
    common.frames = context.options.frames_or(4 * kCycleFrames, kCycleFrames);
    common.hash = dop.hash;
    CaseRows rows(context.rows, common);
    add_rows(rows, dop, box);
}

} // namespace tactus::bench
