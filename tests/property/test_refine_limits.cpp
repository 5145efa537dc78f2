// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Behaviour of refinement and loading when one of their lists is full.

#include "host_tools/shapes/shapes.hpp"
#include "tests/property/frame_checks.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <vector>

namespace tactus::test
{
namespace
{

/// Distances minus errors of the front's coarse faces from a point, ascending, in metres.
std::vector<double> coarse_distances(const Model& model, const Vec3& point)
{
    std::vector<double> distances;
    const auto quantum_m = static_cast<double>(model.header.quantum_m());
    for (std::uint32_t i = 0; i < model.forest.capacity(); ++i)
    {
        if (const PrimId prim{i};
            !model.forest.face(prim).id.is_none() && model.forest.error_of(prim) != 0)
        {
            const Triangle triangle = to_triangle(model.forest.corners_of(prim));
            const double distance = closest_point_on_triangle(point, triangle).gap.norm();
            distances.push_back(distance -
                                static_cast<double>(error_in_quanta(model.forest.error_of(prim))) *
                                    quantum_m);
        }
    }
    std::ranges::sort(distances);
    return distances;
}

/// 40,000 faces over a base mesh larger than kRefineHeap, all loaded.
class WideModel
{
public:
    WideModel() : rig(model(), with_room_for_all())
    {
        load_everything(rig);
        static_cast<void>(rig.step(far_away(), {}));
    }
    static const TestModel& model()
    {
        return test_model("bumpy-40k-wide", make_shape(Shape::bumpy_sphere, 40'000).value(),
                          3 * kRefineHeap);
    }
    static Vec3 far_away() { return Vec3(10.0, 10.0, 10.0) * model().diagonal_m; }

    /// One frame of the refiner alone, within `reach_m` of a point.
    FrameFault refine(const Vec3& point, double reach_m, const Budgets& budgets)
    {
        const RefineQuestion question{point, reach_m, 1.25 * reach_m, &memory};
        const std::uint32_t limit = std::min(budgets.splits, kMaxSplitsPerFrame);
        return refine({&question, 1}, {limit, limit}, budgets);
    }
    FrameFault refine(std::span<const RefineQuestion> questions, SplitLimits limits,
                      const Budgets& budgets)
    {
        work = WorkCounters{};
        const RefineRequest request{ModelId{0}, questions, &closure, {}};
        Refiner& refiner = rig.model().refiner;
        refiner.begin({&request, 1}, budgets, work);
        const FrameFault found = refiner.refine(request, limits, budgets, ++frame_, work);
        static_cast<void>(rig.model().tree.refit());
        return request.is_late() ? found : FrameFault::none;
    }
    [[nodiscard]] std::uint32_t held() const
    {
        std::uint32_t held = 0;
        const PageTable& pages = rig.frame().model(ModelId{0}).pages;
        for (std::uint32_t slot = 0; slot < pages.capacity(); ++slot)
        {
            held += static_cast<std::uint32_t>(std::popcount(pages.meta(slot).held));
        }
        return held;
    }

    FrameRig rig;
    RefineMemory memory;
    Closure closure;
    WorkCounters work;

private:
    std::uint32_t frame_{1'000'000};
};

Budgets unlimited(std::uint32_t splits)
{
    Budgets budgets;
    budgets.splits = splits;
    budgets.merges = 0;
    budgets.nodes = 1'000'000;
    budgets.triangles = 10'000'000;
    return budgets;
}

TEST(RefineLimits, a_full_heap_leaves_faces_for_the_next_frame_and_says_so)
{
    const Vec3 point = to_vec3(WideModel::model().faces[0][0]);
    for (const bool is_over : {false, true})
    {
        WideModel sut;
        const std::vector<double> distances = coarse_distances(sut.rig.model(), point);
        ASSERT_GT(distances.size(), 2 * kRefineHeap);
        // The heap also holds the look-ahead. A split adds a few faces and removes some.
        const std::size_t last = is_over ? 2 * kRefineHeap : kRefineHeap - 64;
        const double reach_m = distances[last] / (is_over ? 1.0 : 1.0 + Refiner::kLookAhead);

        const FrameFault faults = sut.refine(point, reach_m, unlimited(1));

        EXPECT_EQ(has_fault(faults, FrameFault::refine_heap_full), is_over);
        EXPECT_TRUE(has_fault(faults, FrameFault::split_budget_spent));
        EXPECT_LT(sut.memory.certified_m, reach_m) << "nothing is certified that was left out";
        EXPECT_EQ(sut.work.splits, 1U);
    }
}

TEST(RefineLimits, what_a_full_heap_leaves_out_is_split_in_later_frames)
{
    WideModel sut;
    const Vec3 point = to_vec3(WideModel::model().faces[0][0]);
    const double reach_m = coarse_distances(sut.rig.model(), point)[2 * kRefineHeap];
    bool was_full = false;
    FrameFault faults = FrameFault::split_budget_spent;
    for (int frame = 0; frame < 400 && faults != FrameFault::none; ++frame)
    {
        faults = sut.refine(point, reach_m, unlimited(kMaxSplitsPerFrame));
        was_full = was_full || has_fault(faults, FrameFault::refine_heap_full);
    }
    EXPECT_TRUE(was_full);
    EXPECT_EQ(faults, FrameFault::none);
    EXPECT_GE(sut.memory.certified_m, reach_m);
}

TEST(RefineLimits, what_may_wait_comes_when_nothing_else_is_wanted_and_has_a_limit_of_its_own)
{
    WideModel sut;
    const Vec3 point = to_vec3(WideModel::model().faces[0][0]);
    const double reach_m = coarse_distances(sut.rig.model(), point)[kRefineHeap / 2];
    RefineMemory memory_ahead;
    const RefineQuestion now{point, reach_m, 2.0 * reach_m, &sut.memory};
    RefineQuestion ahead = now;
    ahead.later_m = 0.7 * reach_m;
    ahead.center_m = point + Vec3(ahead.later_m, 0.0, 0.0);
    ahead.memory = &memory_ahead;
    const std::array questions{now, ahead};
    constexpr SplitLimits kLimits{64, 20};
    int frames_late = 0;
    int frames_ahead = 0;
    while (is_wanting(now) || is_wanting(ahead))
    {
        const FrameFault faults = sut.refine(questions, kLimits, unlimited(kLimits.now));
        ASSERT_EQ(faults == FrameFault::none, !is_wanting(now));
        if (is_wanting(now))
        {
            ++frames_late;
            ASSERT_GT(sut.work.splits, kLimits.later);
            ASSERT_TRUE(is_wanting(ahead)) << "before what is wanted now";
        }
        else if (is_wanting(ahead))
        {
            ++frames_ahead;
            ASSERT_LE(sut.work.splits, frames_ahead == 1 ? kLimits.now : kLimits.later);
        }
        ASSERT_LT(frames_ahead, 10'000);
    }
    EXPECT_GT(frames_late, 3);
    EXPECT_GT(frames_ahead, 3);
    const std::vector<double> left = coarse_distances(sut.rig.model(), ahead.center_m);
    EXPECT_GE(left.empty() ? reach_m : left.front(), memory_ahead.certified_m * (1.0 - 1e-12));
}

TEST(RefineLimits, as_many_records_are_held_as_the_limit_and_the_frame_says_when_one_is_not)
{
    WideModel sut;
    const TestModel& model = WideModel::model();
    Random random = Random::seeded(seed_of(740));
    // One split a frame, each for another place, and all places wanted: no closure is ever
    // complete.
    FrameFault faults = FrameFault::none;
    std::uint32_t before = 0;
    for (int frame = 0; frame < 20'000 && !has_fault(faults, FrameFault::held_records_full);
         ++frame)
    {
        before = sut.held();
        const Vec3 point = to_vec3(model.faces[random.below(model.faces.size())][0]);
        faults = sut.refine(point, 2.0 * model.diagonal_m, unlimited(1));
        ASSERT_TRUE(before == kMaxHeldRecords || !has_fault(faults, FrameFault::held_records_full))
            << before << " held before frame " << frame;
    }
    EXPECT_TRUE(has_fault(faults, FrameFault::held_records_full));
    EXPECT_EQ(before, kMaxHeldRecords);
    EXPECT_EQ(sut.held(), kMaxHeldRecords);
}

TEST(RefineLimits, no_more_is_merged_in_a_frame_than_the_limit_whatever_the_budget)
{
    WideModel sut;
    const TestModel& model = WideModel::model();
    const Vec3 point = to_vec3(model.faces[0][0]);
    for (int frame = 0; frame < 8; ++frame)
    {
        static_cast<void>(
            sut.refine(point, 0.5 * model.diagonal_m, unlimited(10 * kMaxSplitsPerFrame)));
        EXPECT_EQ(sut.work.splits, kMaxSplitsPerFrame);
    }
    Budgets budgets = unlimited(0);
    budgets.merges = 10 * kMaxMergesPerFrame;
    budgets.scanned = 100'000;

    static_cast<void>(sut.refine(WideModel::far_away(), 0.1 * model.diagonal_m, budgets));

    EXPECT_EQ(sut.work.merges, kMaxMergesPerFrame);
}

TEST(RefineLimits, what_is_left_behind_is_merged_without_a_look_in_vain)
{
    WideModel sut;
    const TestModel& model = WideModel::model();
    const Vec3 point = to_vec3(model.faces[0][0]);
    for (int frame = 0; frame < 4; ++frame)
    {
        static_cast<void>(sut.refine(point, 0.5 * model.diagonal_m, unlimited(kMaxSplitsPerFrame)));
    }
    const VertexForest& forest = sut.rig.model().forest;
    ASSERT_EQ(forest.refined_records(), 4 * kMaxSplitsPerFrame);
    Budgets budgets = unlimited(0);
    budgets.merges = 100;
    budgets.scanned = 100'000;
    for (int frame = 0; forest.refined_records() > 0; ++frame)
    {
        const std::uint32_t before = forest.refined_records();
        static_cast<void>(sut.refine(WideModel::far_away(), 0.1 * model.diagonal_m, budgets));
        // The first frame still holds the closure of the last split.
        ASSERT_TRUE(frame == 0 || sut.work.merges == std::min(before, 100U));
        ASSERT_EQ(sut.work.scanned, sut.work.merges);
        ASSERT_LT(frame, 20);
    }
}

/// Faults of tools of eight spheres each, near every object.
FrameFault faults_of_long_tools(std::uint32_t tools, std::uint32_t objects)
{
    const TestModel& model = small_model(0);
    RigOptions options = with_room_for_all();
    const double length_m = model.diagonal_m;
    const Segment segment{{-length_m, 0, 0}, {length_m, 0, 0}};
    options.tools.assign(tools, {0.01 * length_m, 500.0, 8.0, 1.0, segment});
    options.objects.assign(objects, ObjectSpec{ModelId{0}});
    FrameRig rig(model, options);
    const std::vector<Vec3> goals(tools, to_vec3(model.faces[0][0]));
    return rig.step(goals, {}).faults;
}

TEST(RefineLimits, a_frame_says_when_it_does_not_ask_for_what_a_tool_is_at)
{
    constexpr std::uint32_t kFive = 5 * kMaxCoverSpheres; // Present and four predicted covers.
    static_assert(9 * kFive < kMaxRankedRegions && 10 * kFive > kMaxRankedRegions);
    EXPECT_FALSE(has_fault(faults_of_long_tools(2, 5), FrameFault::ranking_full));
    EXPECT_TRUE(has_fault(faults_of_long_tools(3, 4), FrameFault::ranking_full));
}

TEST(RefineLimits, a_frame_walks_so_often_to_refine_and_no_more_and_says_so)
{
    EXPECT_EQ(walk_left(10, 0), 10U);
    EXPECT_EQ(walk_left(10, 10 * kFrameWalks - 3), 3U);
    EXPECT_EQ(walk_left(10, 10 * kFrameWalks), 0U);
    // One node for each walk, one walk for each sphere, and each tool's query.
    for (const std::uint32_t tools : {1U, 2U})
    {
        const TestModel& model = small_model(0);
        RigOptions options = with_room_for_all();
        const double length_m = model.diagonal_m;
        const Segment segment{{-length_m, 0, 0}, {length_m, 0, 0}};
        options.tools.assign(tools, {0.01 * length_m, 500.0, 8.0, 1.0, segment});
        FrameRig rig(model, options);
        Budgets budgets = unlimited(0);
        budgets.nodes = 1;
        const FrameOutput output =
            rig.step(std::vector<Vec3>(tools, to_vec3(model.faces[0][0])), budgets);
        EXPECT_EQ(output.work.nodes_visited, kFrameWalks + tools);
        EXPECT_TRUE(has_fault(output.faults, FrameFault::node_budget_spent));
    }
}

TEST(RefineLimits, a_query_that_is_cut_knows_no_less_than_the_last_one)
{
    const TestModel& model = small_model(0);
    RigOptions options = with_room_for_all();
    const double radius_m = 0.02 * model.diagonal_m;
    options.tools = {{radius_m, 500.0, 8.0, 1.0, Segment{{0, 0, 0}, {0, 0, radius_m}}}};
    FrameRig rig(model, options);
    const Vec3 surface_m = to_vec3(model.faces[0][0]);
    const ModelHeader& header = rig.model().header;
    const auto& extent = header.fields().extent_quanta;
    const Vec3 middle_m =
        0.5 * static_cast<double>(header.quantum_m()) * Vec3(extent[0], extent[1], extent[2]);
    const Vec3 outward = (surface_m - middle_m).normalized();
    const Vec3 place_m = surface_m + 2.2 * radius_m * outward;
    rig.settle(place_m, unlimited(kMaxSplitsPerFrame), 400);
    const double before_m = rig.step(place_m, unlimited(kMaxSplitsPerFrame)).pairs[0].lower_m;
    ASSERT_GT(before_m, radius_m);

    Budgets little = unlimited(0);
    little.nodes = 1;
    const double moved_m = 0.01 * radius_m;
    const FrameOutput output = rig.step(Vec3(place_m - moved_m * outward), little);
    const PairOutput& pair = output.pairs[0];
    ASSERT_TRUE(has_fault(output.faults, FrameFault::node_budget_spent));
    EXPECT_FALSE(pair.skipped);
    EXPECT_GE(pair.lower_m, before_m - 1.01 * moved_m);
    EXPECT_LE(pair.lower_m, before_m);
}

/// A tool with about nine tenths of a surface's capacity in reach of every object.
TEST(RefineLimits, a_frame_has_room_for_so_many_full_surfaces_and_says_when_it_needs_more)
{
    const TestModel& model = WideModel::model();
    const Vec3 place = to_vec3(model.faces[0][0]);
    std::vector<double> distances;
    for (const Face& face : model.faces)
    {
        distances.push_back(closest_point_on_triangle(place, to_triangle(face)).gap.norm());
    }
    std::ranges::sort(distances);
    const double reach_m = distances[kMaxLocalTriangles * 9 / 10];
    for (const std::uint32_t objects : {kLocalSurfaces, kLocalSurfaces + 1})
    {
        RigOptions options = with_room_for_all();
        options.tools = {{reach_m / 1.06, 500.0, 8.0, 1.0}};
        options.tools[0].query_only = true;
        options.objects.assign(objects, ObjectSpec{ModelId{0}});
        FrameRig rig(model, options);
        rig.settle(place, unlimited(kMaxSplitsPerFrame), 400);
        const FrameOutput output = rig.step(place, unlimited(kMaxSplitsPerFrame));
        EXPECT_EQ(has_fault(output.faults, FrameFault::surface_truncated),
                  objects > kLocalSurfaces);
        EXPECT_EQ(output.pairs[0].kind, AnswerKind::exact);
        EXPECT_GE(output.pairs[0].certified_radius_m, reach_m / 1.06);
        EXPECT_EQ(
            output.pairs[objects - 1].certified_radius_m<reach_m / 1.06, objects> kLocalSurfaces);
    }
}

TEST(RefineLimits, a_tool_that_is_a_mesh_looks_at_so_many_times_the_budget_in_each_walk)
{
    const TestModel& object = small_model(0);
    const TestModel& tool = small_model(1);
    // Walks of either model, present and predicted; of the cover; and of the query.
    constexpr std::uint32_t kWalks = 4 * kMeshRefineFactor + 1 + kMeshBudgetFactor;
    for (const std::uint32_t nodes : {1U, 1'000'000U})
    {
        RigOptions options = with_room_for_all();
        options.pool_bytes = std::size_t{32} << 20U;
        options.tools = {{1e-4, 500.0, 8.0, 1.0, MeshCore{ModelId{1}}, true}};
        FrameRig rig({&object, &tool}, options);
        Budgets budgets = unlimited(64);
        budgets.nodes = nodes;
        const FrameOutput output = rig.step(to_vec3(object.faces[0][0]), budgets);
        EXPECT_EQ(has_fault(output.faults, FrameFault::node_budget_spent), nodes == 1);
        EXPECT_EQ(output.work.nodes_visited <= kWalks, nodes == 1) << output.work.nodes_visited;
        EXPECT_GE(output.work.nodes_visited, kMeshBudgetFactor);
    }
}

/// Both meshes coincide, so that any walk of the two could visit all of them. A tool that only
/// renders force requests one meeting pair, and its neighbourhood.
void refine_equals(const TestModel& model, bool wants_contacts, bool fills)
{
    RigOptions options = with_room_for_all();
    options.pool_bytes = std::size_t{64} << 20U;
    options.static_when_it_fits = fills;
    options.tools = {
        {1e-3 * model.diagonal_m, 500.0, 8.0, 1.0, MeshCore{ModelId{1}}, wants_contacts}};
    FrameRig rig({&model, &model}, options);
    const Vec3 place_m(-model.origin_m[0], -model.origin_m[1], -model.origin_m[2]);
    const Budgets budgets;
    std::uint32_t nodes = 0; // Greatest work of a frame.
    std::uint32_t triangles = 0;
    std::uint32_t splits = 0;
    for (int still = 0, frame = 0; still < 50; ++frame)
    {
        const FrameOutput output = rig.step(place_m, budgets);
        nodes = std::max(nodes, output.work.nodes_visited);
        triangles = std::max(triangles, output.work.triangles_tested);
        splits += output.work.splits;
        still = output.work.splits == 0 ? still + 1 : 0;
        ASSERT_LT(frame, 3'000);
    }
    std::printf("%u splits, most nodes %u, triangles %u\n", splits, nodes, triangles);
    const PairOutput pair = rig.step(place_m, budgets).pairs[0];
    EXPECT_EQ(pair.kind, AnswerKind::exact);
    EXPECT_LT(pair.upper_m, 1e-12);
    EXPECT_EQ(pair.mesh->is_truncated, wants_contacts);
    EXPECT_EQ(pair.mesh->meeting.size() == 1, !wants_contacts);
    const std::uint32_t all = 2 * rig.model().header.counts().records;
    EXPECT_EQ(splits >= all, wants_contacts || fills);
    EXPECT_EQ(splits < all / 10, !wants_contacts && !fills);
    EXPECT_LE(nodes, 4 * budgets.nodes);
    EXPECT_LE(triangles, 4 * budgets.triangles);
}

TEST(RefineLimits, two_equal_meshes_in_one_place_are_refined_by_a_little_work_a_frame)
{
    const TestModel& model =
        test_model("bumpy-20k", make_shape(Shape::bumpy_sphere, 20'000).value(), 500);
    for (const bool wants_contacts : {false, true})
    {
        for (const bool fills : {false, true})
        {
            refine_equals(model, wants_contacts, fills);
        }
    }
}

} // namespace
} // namespace tactus::test
