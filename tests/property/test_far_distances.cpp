// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Pairs whose distance is requested at any range (ToolSpec::wants_distance), against every face of
/// the source.

#include "rt_core/geometry/placed_core.hpp"
#include "tests/property/frame_checks.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace tactus::test
{
namespace
{

constexpr int kFramesMax = 4'000; ///< Limit of frames until an answer must be exact.

ToolSpec measuring_tool(double radius_m, const ToolCore& core = PointCore{})
{
    ToolSpec spec;
    spec.radius_m = radius_m;
    spec.core = core;
    spec.query_only = true;
    spec.wants_distance = true;
    return spec;
}

ObjectPose some_pose(Random& random, double diagonal_m)
{
    ObjectPose pose;
    pose.rotation = Eigen::AngleAxisd{random.between(-3.0, 3.0),
                                      (random.in_cube(1.0) + Vec3(0, 0, 1e-3)).normalized()}
                        .toRotationMatrix();
    pose.translation_m = random.in_cube(3.0 * diagonal_m);
    pose.scale = random.between(0.5, 2.0);
    return pose;
}

/// The bounds must hold the truth, and an exact answer must equal it.
void check(const PairOutput& pair, double truth_m, double slack_m)
{
    ASSERT_LE(pair.lower_m, truth_m + slack_m);
    ASSERT_GE(pair.upper_m, truth_m - slack_m);
    if (pair.kind == AnswerKind::exact)
    {
        ASSERT_LE(pair.upper_m - pair.lower_m, slack_m);
        ASSERT_NEAR((pair.point_m - pair.nearest_point_m).norm(), truth_m, 2.0 * slack_m);
    }
}

using FarDistances = EachModel<5'600>;

TEST_P(FarDistances, of_a_point_become_the_source_meshs_in_bounded_frames)
{
    RigOptions options;
    options.tools = {measuring_tool(0.005 * model_.diagonal_m)};
    options.faults.loss = 0.1;
    FrameRig sut(model_, options);
    for (const double far : {0.05, 0.3, 1.0, 20.0})
    {
        SCOPED_TRACE(far);
        const Vec3 place_m = place_at_distance(model_, random_, far * model_.diagonal_m);
        const auto truth_m = static_cast<double>(brute_distance(place_m, model_.faces));
        const double slack_m = 1e-12 * model_.diagonal_m + 1e-13 * place_m.norm();
        Budgets budgets;
        budgets.splits = 8 + random_.below(57);
        bool is_exact = false;
        for (int frame = 0; frame < kFramesMax && !is_exact; ++frame)
        {
            const FrameOutput output = sut.step(place_m, budgets);
            expect_all_budgets_kept(output, budgets);
            ASSERT_EQ(output.pairs.size(), 1U);
            check(output.pairs[0], truth_m, slack_m);
            ASSERT_FALSE(HasFatalFailure()) << frame;
            is_exact = output.pairs[0].kind == AnswerKind::exact;
        }
        EXPECT_TRUE(is_exact);
    }
}

TEST_P(FarDistances, of_a_tool_that_moves_hold_the_truth_in_every_frame)
{
    RigOptions options;
    options.tools = {measuring_tool(0.002 * model_.diagonal_m)};
    FrameRig sut(model_, options);
    const Vec3 from_m = place_at_distance(model_, random_, 0.5 * model_.diagonal_m);
    const Vec3 to_m = place_at_distance(model_, random_, 0.01 * model_.diagonal_m);
    int exact = 0;
    constexpr int kFrames = 1'500;
    for (int frame = 0; frame < kFrames; ++frame)
    {
        const double share = 0.5 - 0.5 * std::cos(0.01 * frame);
        const Vec3 place_m = from_m + share * (to_m - from_m);
        const FrameOutput output = sut.step(place_m);
        check(output.pairs[0], static_cast<double>(brute_distance(place_m, model_.faces)),
              1e-12 * model_.diagonal_m);
        ASSERT_FALSE(HasFatalFailure()) << frame;
        exact += output.pairs[0].kind == AnswerKind::exact ? 1 : 0;
    }
    EXPECT_GT(exact, kFrames / 2);
}

INSTANTIATE_TEST_SUITE_P(EachModel, FarDistances, testing::Range<std::size_t>(0, kSmallModels));

TEST(FarDistance, is_told_of_every_object_and_every_core)
{
    const std::uint64_t seed = seed_of(5'610);
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random = Random::seeded(seed);
    const std::array models{&small_model(0), &small_model(2)};
    const double size_m = models[0]->diagonal_m;
    RigOptions options = with_room_for_all();
    options.tools = {measuring_tool(0.01 * size_m),
                     measuring_tool(0.004 * size_m, Segment{{0, 0, -0.05 * size_m},
                                                            {0, 0.01 * size_m, 0.08 * size_m}}),
                     measuring_tool(0.0, Box{{0.03 * size_m, 0.02 * size_m, 0.01 * size_m}})};
    for (std::uint32_t i = 0; i < 6; ++i)
    {
        options.objects.push_back(ObjectSpec{ModelId{i % 2}});
        options.poses.push_back(some_pose(random, size_m));
    }
    FrameRig sut({models[0], models[1]}, options);
    std::vector<ToolState> tools(3);
    for (ToolState& tool : tools)
    {
        tool.position_m = random.in_cube(3.0 * size_m);
        tool.rotation = some_pose(random, size_m).rotation;
    }
    FrameOutput output;
    bool is_exact = false;
    for (int frame = 0; frame < kFramesMax && !is_exact; ++frame)
    {
        output = sut.step(std::span<const ToolState>(tools), Budgets{});
        is_exact = std::ranges::all_of(output.pairs, [](const PairOutput& pair)
                                       { return pair.kind == AnswerKind::exact; });
    }
    EXPECT_TRUE(is_exact);
    ASSERT_EQ(output.pairs.size(), 18U);
    for (const PairOutput& pair : output.pairs)
    {
        SCOPED_TRACE(std::to_string(pair.tool) + " at " + std::to_string(pair.object));
        const ObjectPose& pose = sut.pose(pair.object);
        const ToolState& tool = tools[pair.tool];
        const PlacedCore core(options.tools[pair.tool].core,
                              in_frame(pose, {tool.rotation, tool.position_m, 1.0}));
        double truth_m = kInfinity;
        for (const Face& face : models.at(pair.object % 2)->faces)
        {
            truth_m = std::min(truth_m, core.closest(to_triangle(face)).distance * pose.scale);
        }
        check(pair, truth_m, 1e-9 * size_m);
    }
}

/// The same rig and frames without the request, which shows that the tests above can fail.
TEST(FarDistance, is_a_bracket_where_nobody_asks)
{
    const TestModel& model = small_model(0);
    RigOptions options;
    options.tools = {measuring_tool(0.005 * model.diagonal_m)};
    options.tools[0].wants_distance = false;
    FrameRig sut(model, options);
    FrameOutput output;
    for (int frame = 0; frame < kFramesMax; ++frame)
    {
        output = sut.step(Vec3(2.0, 0.3, 0.2) * model.diagonal_m);
    }
    EXPECT_EQ(output.pairs[0].kind, AnswerKind::separated);
    EXPECT_GT(output.pairs[0].upper_m - output.pairs[0].lower_m, 0.01 * model.diagonal_m);
}

/// Forces of a pressing hand beside a query-only tool far away.
std::vector<Vec3> forces_beside(bool wants_distance)
{
    const TestModel& model = small_model(0);
    const Vec3 top_m = to_vec3(
        std::ranges::max_element(model.faces, {}, [](const Face& face) { return face[0][2]; })
            ->at(0));
    RigOptions options;
    options.tools = {ToolSpec{0.01 * model.diagonal_m, 500.0, 8.0, 1.0},
                     measuring_tool(0.005 * model.diagonal_m)};
    options.tools[1].wants_distance = wants_distance;
    FrameRig sut(model, options);
    std::vector<Vec3> forces_n;
    for (int frame = 0; frame < 1'500; ++frame)
    {
        const double height_m = 0.01 * model.diagonal_m + 0.004 * std::cos(0.005 * frame);
        const Vec3 aside_m = 0.02 * model.diagonal_m * Vec3(std::sin(0.003 * frame), 0.0, 0.0);
        const std::vector<Vec3> goals_m{top_m + aside_m + Vec3(0.0, 0.0, height_m),
                                        Vec3(-1.5, 0.3, 0.2) * model.diagonal_m};
        const FrameOutput output = sut.step(goals_m, Budgets{});
        forces_n.push_back(output.tools[0].force_n);
    }
    return forces_n;
}

TEST(FarDistance, takes_nothing_from_a_tool_that_touches)
{
    const std::vector<Vec3> alone_n = forces_beside(false);
    EXPECT_EQ(forces_beside(true), alone_n);
    EXPECT_TRUE(std::ranges::any_of(alone_n, [](const Vec3& n) { return n.norm() > 0.5; }));
}

} // namespace
} // namespace tactus::test
