// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I5 in scenes whose objects and tools are added, moved and removed: all bounds and clearances
/// hold the distance found by trying all objects.

#include "rt_core/frame/list_touches.hpp"
#include "rt_core/geometry/object_speed_limit.hpp"
#include "tests/shared/face_tree.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/safe_force.hpp"
#include "tests/shared/surface_points.hpp"
#include "tests/stability/scene_trial.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::test
{
namespace
{

constexpr std::uint32_t kPlaces = 24; ///< Places of objects.

RigOptions scene_options(double diagonal_m, std::uint32_t tools)
{
    RigOptions options = with_room_for_all();
    options.tools.assign(tools, ToolSpec{0.01 * diagonal_m, 500.0, 8.0, 1.0});
    options.capacities.objects = kPlaces;
    options.faults.delay_polls_max = 8;
    return options;
}

TEST(Scene, of_objects_that_come_move_and_go_is_answered_truly_and_refuses_what_it_must)
{
    SceneFigures all;
    for (std::uint64_t trial = 0; trial < 4; ++trial)
    {
        const std::vector<const TestModel*> models{&small_model(2 * trial % kSmallModels),
                                                   &small_model(2 * (trial + 1) % kSmallModels)};
        const Hardship usual{"late", {}, scene_options(models[0]->diagonal_m, 3)};
        all.add(run_scene_trial({models, usual, 3, seed_of(2'100 + trial), 800}));
    }
    EXPECT_TRUE(all.truth.holds()) << all.truth.summary();
    EXPECT_EQ(all.truth.trials, 3'200U);
    EXPECT_GT(all.exact, 100U);
    EXPECT_GT(all.refused, 200U);
    EXPECT_GT(all.gone, 500U);
    EXPECT_GT(all.variants, 3U);
}

/// Sphere that is pressed into a cube's top: the highest vertex of the model.
class Pressed
{
public:
    explicit Pressed(std::uint32_t objects = 1)
    {
        RigOptions options = with_room_for_all();
        options.tools = {{0.02 * model.diagonal_m, 500.0, 8.0, 1.0}};
        options.capacities.objects = 8;
        options.objects.assign(objects, ObjectSpec{ModelId{0}});
        rig.emplace(model, options);
        force.emplace(options.tools[0], 1e-3);
        top = to_vec3(
            std::ranges::max_element(model.faces, {}, [](const Face& face) { return face[0][2]; })
                ->at(0));
    }
    /// Steps with the sphere's centre this far above the vertex.
    ToolOutput step(double height_m)
    {
        const Vec3 goal = top + Vec3(0.0, 0.0, height_m);
        output = rig->step(goal);
        const Vec3 before_n = sent_n;
        sent_n = force->step(output.tools[0], goal);
        step_n = (sent_n - before_n).norm();
        return output.tools[0];
    }
    /// Descends from above until it touches, 1 mm deep.
    void press()
    {
        for (int i = 0; i < 400; ++i)
        {
            step(std::max(0.06 * model.diagonal_m - 0.0005 * i, pressed_m()));
        }
    }
    /// Steps at one height; no change of the force may be greater than `most_n`.
    void rest(int frames, double height_m, double most_n = kInfinity)
    {
        for (int i = 0; i < frames; ++i)
        {
            step(height_m);
            EXPECT_LE(step_n, most_n) << i;
        }
    }
    [[nodiscard]] double pressed_m() const { return 0.02 * model.diagonal_m - 0.001; }
    [[nodiscard]] SceneChange change(SceneChangeKind kind, std::uint32_t generation) const
    {
        SceneChange change;
        change.kind = kind;
        change.generation = generation;
        change.object.model = ModelId{0};
        return change;
    }

    const TestModel& model = small_model(0);
    std::optional<FrameRig> rig;
    std::optional<SafeForce> force;
    Vec3 top{0.0, 0.0, 0.0};
    FrameOutput output;
    Vec3 sent_n{0.0, 0.0, 0.0};
    double step_n{0.0};
};

/// Change of force in a frame while 8 N fade in kFadeTime_s.
constexpr double kFadeStep_n = 8.0 * 1e-3 / kFadeTime_s;

TEST(SceneChanges, an_object_that_goes_under_a_tool_lets_its_force_fade)
{
    Pressed sut;
    sut.press();
    ASSERT_GT(sut.sent_n.norm(), 0.3);
    sut.rig->change(sut.change(SceneChangeKind::object_goes, 0));
    EXPECT_TRUE(sut.step(sut.pressed_m()).lost_object);
    EXPECT_TRUE(has_fault(sut.output.faults, FrameFault::object_lost));
    EXPECT_TRUE(sut.output.pairs.empty());
    EXPECT_EQ(sut.output.tools[0].clear_m, kInfinity);
    EXPECT_GT(sut.sent_n.norm(), 0.3 * 0.9);
    for (int i = 0; i < 200; ++i)
    {
        EXPECT_FALSE(sut.step(sut.pressed_m()).lost_object);
        ASSERT_LE(sut.step_n, 2.0 * kFadeStep_n);
    }
    EXPECT_EQ(sut.sent_n, Vec3(0.0, 0.0, 0.0));
}

/// Random depth and speed, with an immediate next touch: from the frame on in which an object
/// surrounded a tool, the force grows at most by the spring's part of the hand's motion and by the
/// return of a lost force (ForceFader).
TEST(SceneChanges, an_object_that_came_round_a_tool_and_was_left_makes_a_force_without_a_step)
{
    constexpr double kRiseStep_n = 2.0 * 8.0 * 1e-3 / kRiseTime_s;
    const std::uint64_t seed = seed_of(2'330);
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random = Random::seeded(seed);
    Pressed sut;
    sut.press();
    double height_m = sut.pressed_m();
    const auto go_to = [&](double goal_m, double way_m)
    {
        const double before_m = height_m;
        height_m += std::clamp(goal_m - height_m, -way_m, way_m);
        sut.step(height_m);
        return 500.0 * std::abs(height_m - before_m);
    };
    for (std::uint32_t round = 0; round < 30; ++round)
    {
        sut.rig->change(sut.change(SceneChangeKind::object_goes, round));
        const double depth_m = random.between(0.0, 0.004);
        const auto frames = random.below(120U); // 50 of them let the force fade.
        for (std::uint32_t frame = 0; frame <= frames; ++frame)
        {
            go_to(sut.pressed_m() - depth_m, 0.001);
        }
        sut.rig->change(sut.change(SceneChangeKind::object_comes, round + 1));
        const double way_m = random.between(0.0001, 0.0005);
        bool was_joined = false;
        for (std::uint32_t frame = 0; frame < 300 && !was_joined; ++frame)
        {
            go_to(1.0, way_m);
            was_joined = sut.output.pairs[0].is_joined;
            ASSERT_LE(sut.step_n, kRiseStep_n) << "round " << round << ", frame " << frame;
            ASSERT_EQ(sut.output.tools[0].force_n, Vec3(0.0, 0.0, 0.0));
        }
        ASSERT_TRUE(was_joined);
        for (std::uint32_t frame = 0; frame < 200; ++frame)
        {
            const double spring_n = go_to(sut.pressed_m(), way_m);
            ASSERT_LE(sut.step_n, (frame < 100 ? kRiseStep_n : 0.0) + spring_n + 1e-9)
                << "round " << round << ", frame " << frame;
        }
        ASSERT_GT(sut.sent_n.norm(), 0.3) << "round " << round;
    }
}

/// The object was far away in the last frame, and unknown.
TEST(SceneChanges, an_object_that_leaps_into_a_tool_makes_no_force_until_the_tool_is_clear_of_it)
{
    Pressed sut(2);
    const double height_m = 0.06 * sut.model.diagonal_m;
    SceneChange change = sut.change(SceneChangeKind::object_moves, 0);
    change.number = 1;
    change.pose.translation_m = Vec3(0.0, 0.0, 10.0);
    sut.rig->change(change);
    sut.rest(50, height_m);
    ASSERT_EQ(sut.output.pairs.size(), 1U);
    change.pose.translation_m.z() = height_m - 0.02 * sut.model.diagonal_m + 0.001;
    sut.rig->change(change);
    sut.rest(100, height_m, 0.0);
    ASSERT_EQ(sut.sent_n, Vec3(0.0, 0.0, 0.0));
    ASSERT_EQ(sut.output.pairs.size(), 2U);
    EXPECT_FALSE(sut.output.pairs[1].is_joined);
    for (int i = 0; i < 100 && !sut.output.pairs[1].is_joined; ++i)
    {
        sut.step(height_m + 0.0002 * i);
        ASSERT_EQ(sut.sent_n, Vec3(0.0, 0.0, 0.0)) << i;
    }
    EXPECT_TRUE(sut.output.pairs[1].is_joined);
}

/// A jump of 20 mm, more than 8 N / 500 N/m: onto the tool, and beside it.
TEST(SceneChanges, an_object_that_jumps_at_a_tool_is_lost_before_the_touch)
{
    for (const double height_m : {0.015, 0.035})
    {
        Pressed sut;
        const double above_m = 0.02 * sut.model.diagonal_m + height_m;
        sut.rest(50, above_m);
        ASSERT_FALSE(sut.output.tools[0].in_contact);
        ObjectPose pose;
        pose.translation_m = Vec3(0.0, 0.0, 0.02);
        sut.rig->place_object(pose);
        EXPECT_EQ(sut.step(above_m).lost_object, height_m < 0.02 + kTouchSlack_m) << height_m;
        sut.rest(200, above_m, 2.0 * 8.0 * 1e-3 / kRiseTime_s);
    }
}

/// Motion is reported only if it may change the force; motion that carries the proxy always.
TEST(SceneChanges, tell_how_far_an_object_at_the_tool_went_and_took_it_along)
{
    Pressed sut;
    sut.press();
    EXPECT_EQ(sut.output.tools[0].object_way_m, 0.0);
    EXPECT_EQ(sut.output.tools[0].carried_m, Vec3(0.0, 0.0, 0.0));
    ObjectPose pose;
    for (int i = 1; i <= 10; ++i)
    {
        pose.translation_m = Vec3(0.0, 0.0, 1e-4 * i);
        sut.rig->place_object(pose);
        const ToolOutput output = sut.step(sut.pressed_m());
        EXPECT_NEAR(output.object_way_m, 1e-4, 1e-12);
        EXPECT_EQ(output.object_rotation_rad, 0.0);
        EXPECT_NEAR((output.carried_m - Vec3(0.0, 0.0, 1e-4)).norm(), 0.0, 1e-12);
    }
    pose.rotation = Eigen::AngleAxisd(1e-3, Vec3::UnitX()).toRotationMatrix();
    sut.rig->place_object(pose);
    const ToolOutput turned = sut.step(sut.pressed_m());
    EXPECT_NEAR(turned.object_rotation_rad, 1e-3, 1e-9);
    EXPECT_GE(turned.object_way_m, turned.carried_m.norm());
    sut.rest(300, 0.5 * sut.model.diagonal_m);
    pose.translation_m.z() += 1e-4;
    sut.rig->place_object(pose);
    EXPECT_EQ(sut.step(0.5 * sut.model.diagonal_m).object_way_m, 0.0);
}

/// Gap between tool and object, with the expected list.
struct ListedCase
{
    double gap_m;
    std::size_t listed;
    bool is_in_reach;
};

/// Checks the list when the object may move at 0.5 m/s. A second, equal tool without a force is
/// never listed.
void expect_listed(const ToolSpec& tool, std::span<const ListedCase> cases)
{
    const TestModel& model = small_model(0);
    RigOptions options = with_room_for_all();
    options.tools.assign(2, tool);
    options.tools[0].wants_distance = options.tools[1].wants_distance = true;
    options.tools[1].query_only = true;
    FrameRig rig(model, options);
    Vec3 outermost(-kInfinity, 0.0, 0.0);
    for (const Face& face : model.faces)
    {
        for (const auto& corner : face)
        {
            const Vec3 corner_m = to_vec3(corner);
            outermost = corner_m.x() > outermost.x() ? corner_m : outermost;
        }
    }
    for (const ListedCase& at : cases)
    {
        const Vec3 goal_m = outermost + Vec3(at.gap_m, 0.0, 0.0);
        FrameOutput output;
        for (int i = 0; i < 400; ++i)
        {
            output = rig.step(std::vector{goal_m, goal_m}, Budgets{});
        }
        ObjectTouches touches;
        list_touches(rig.frame(), output.pairs, ObjectSpeedLimit{0.5}, touches);
        ASSERT_EQ(touches.size(), at.listed) << at.gap_m;
        if (at.listed > 0)
        {
            EXPECT_EQ(touches[0].tool, 0U);
            EXPECT_EQ(touches[0].is_in_reach, at.is_in_reach) << at.gap_m;
            EXPECT_GE(touches[0].radius_m, 0.002);
            EXPECT_LE((touches[0].place_m - goal_m).norm(), 1e-6);
        }
    }
}

/// A tool of 2 mm at 1 m/s is near from 5 mm on, and may approach by 30 mm within 20 ms.
TEST(SceneTouches, are_what_a_tool_with_a_force_may_meet_within_20_ms_and_near_ones_say_so)
{
    constexpr std::array<ListedCase, 5> kCases{{{0.0069, 1, true},
                                                {0.0071, 1, false},
                                                {0.0369, 1, false},
                                                {0.0371, 0, false},
                                                {0.0069, 1, true}}};
    expect_listed({0.002, 500.0, 8.0, 1.0}, kCases);
}

/// The tool may approach by 12 mm within 20 ms at 0.1 m/s. A displacement of 24 mm makes 12 N at
/// 500 N/m.
TEST(SceneTouches, are_also_what_a_leap_that_is_no_jump_may_bring)
{
    constexpr std::array<ListedCase, 2> kCases{{{0.0309, 1, false}, {0.0311, 0, false}}};
    expect_listed({0.002, 500.0, 12.0, 0.1}, kCases);
}

TEST(SceneChanges, an_object_that_comes_beside_a_touch_leaves_its_force_as_it_is)
{
    Pressed sut;
    sut.press();
    const Vec3 before_n = sut.sent_n;
    SceneChange change = sut.change(SceneChangeKind::object_comes, 0);
    change.number = 3;
    sut.rig->change(change); // Around the tool and the object that it touches.
    for (int i = 0; i < 50; ++i)
    {
        sut.step(sut.pressed_m());
        ASSERT_NEAR((sut.sent_n - before_n).norm(), 0.0, 1e-9);
    }
    EXPECT_EQ(sut.output.pairs.size(), 2U);
}

TEST(SceneChanges, an_object_that_jumps_under_a_tool_lets_its_force_fade)
{
    Pressed sut;
    sut.press();
    ObjectPose pose;
    pose.translation_m = Vec3(0.0, 0.0, -0.05); // More than 8 N / 500 N/m.
    sut.rig->place_object(pose);
    EXPECT_TRUE(sut.step(sut.pressed_m()).lost_object);
    sut.rest(200, sut.pressed_m(), 2.0 * kFadeStep_n);
}

TEST(SceneChanges, an_object_that_feels_otherwise_changes_the_force_in_small_steps)
{
    Pressed sut;
    sut.press();
    // The tool comes to rest, so that nothing would be evaluated any more.
    sut.rest(100, sut.pressed_m());
    const double before_n = sut.output.tools[0].force_n.norm();
    const double depth_m = before_n / 500.0;
    SceneChange change = sut.change(SceneChangeKind::object_feels, 0);
    change.object.material.stiffness_n_per_m = 100.0;
    const auto feel = [&](double stiffness_n_per_m)
    {
        const double from_n = sut.output.tools[0].force_n.norm();
        change.object.material.stiffness_n_per_m = stiffness_n_per_m;
        sut.rig->change(change);
        // The pressing hand rests: only the material makes steps, a fiftieth of the change each.
        const double most_n =
            1.05 * 1e-3 / kMaterialBlend_s * std::abs(stiffness_n_per_m * depth_m - from_n);
        Vec3 last_n = sut.output.tools[0].force_n;
        for (int i = 0; i < 60; ++i)
        {
            sut.step(sut.pressed_m());
            const Vec3 now_n = sut.output.tools[0].force_n;
            ASSERT_LE((now_n - last_n).norm(), most_n + 1e-6) << i;
            last_n = now_n;
        }
        EXPECT_NEAR(last_n.norm(), stiffness_n_per_m * depth_m, 1e-3 * before_n);
    };
    feel(100.0);
    feel(400.0);
    change.object.material.static_friction = -1.0;
    sut.rig->change(change);
    sut.step(sut.pressed_m());
    EXPECT_EQ(sut.output.scene.refused[static_cast<std::size_t>(ChangeRefusal::bad_material)], 1U);
    EXPECT_NEAR(sut.output.tools[0].force_n.norm(), 400.0 * depth_m, 1e-3 * before_n);
    change.object.material.static_friction = 0.0;
    change.object.material.damping_n_s_per_m = 5.0;
    feel(400.0);
    EXPECT_EQ(sut.output.pairs[0].damping_n_s_per_m, 5.0);
}

TEST(SceneChanges, a_tool_that_goes_and_comes_knows_nothing_of_before)
{
    Pressed sut;
    sut.press();
    sut.rig->change(sut.change(SceneChangeKind::tool_goes, 0));
    EXPECT_TRUE(sut.step(sut.pressed_m()).is_gone);
    EXPECT_EQ(sut.output.tools[0].force_n, Vec3(0.0, 0.0, 0.0));
    EXPECT_TRUE(sut.output.pairs.empty());
    sut.rig->change(sut.change(SceneChangeKind::tool_goes, 0));
    sut.step(sut.pressed_m());
    EXPECT_EQ(sut.output.scene.refused[static_cast<std::size_t>(ChangeRefusal::not_here)], 1U);
    sut.rig->change(sut.change(SceneChangeKind::tool_comes, 0));
    EXPECT_FALSE(sut.step(sut.pressed_m() - 0.002).is_gone);
    EXPECT_FALSE(sut.output.pairs[0].is_joined);
    sut.rig->change(sut.change(SceneChangeKind::tool_comes, 0));
    SceneChange unknown = sut.change(SceneChangeKind::tool_comes, 0);
    unknown.number = 1;
    sut.rig->change(unknown);
    sut.step(sut.pressed_m());
    EXPECT_EQ(sut.output.scene.refused[static_cast<std::size_t>(ChangeRefusal::already_here)], 1U);
    EXPECT_EQ(sut.output.scene.refused[static_cast<std::size_t>(ChangeRefusal::number_too_big)],
              1U);
    for (int i = 0; i < 200; ++i)
    {
        sut.step(sut.pressed_m() + 0.0005 * std::min(i, 100));
    }
    sut.press();
    EXPECT_GT(sut.sent_n.norm(), 0.3);
}

TEST(SceneChanges, of_one_frame_are_taken_up_to_the_limit_and_the_rest_is_counted)
{
    for (const std::uint32_t count : {kMaxSceneChanges, kMaxSceneChanges + 1, 1'000U})
    {
        Pressed sut;
        SceneChange change = sut.change(SceneChangeKind::object_moves, 0);
        for (std::uint32_t i = 0; i < count; ++i)
        {
            change.pose.translation_m.x() = 1e-3 * i;
            sut.rig->change(change);
        }
        sut.step(1.0);
        EXPECT_EQ(sut.output.scene.refused[static_cast<std::size_t>(ChangeRefusal::too_many)],
                  count - kMaxSceneChanges);
        EXPECT_NEAR(sut.rig->frame().objects()[0].pose.translation_m.x(),
                    1e-3 * (kMaxSceneChanges - 1), 1e-12);
    }
}

/// Objects in one place, near each tool: as many pairs as the capacity.
FrameOutput crowd(std::uint32_t tools, std::uint32_t objects, std::uint32_t pairs = 0)
{
    const TestModel& model = small_model(0);
    RigOptions options = with_room_for_all();
    options.tools.assign(tools, ToolSpec{0.01 * model.diagonal_m});
    options.objects.assign(objects, ObjectSpec{ModelId{0}});
    options.capacities.pairs = pairs;
    FrameRig rig(model, options);
    const std::vector<Vec3> goals(tools, to_vec3(model.faces[0][0]));
    FrameOutput output;
    for (std::uint32_t i = 0; i <= tools / kBroadWalks; ++i) // Frames until each has had its walk.
    {
        output = rig.step(goals, Budgets{});
    }
    EXPECT_TRUE(std::ranges::is_sorted(output.pairs, {},
                                       [](const PairOutput& pair)
                                       { return std::pair(pair.tool, pair.object); }));
    // The rest is the rig's.
    output.tools = {};
    output.pairs = {};
    output.models = {};
    return output;
}

TEST(SceneCrowd, has_a_pair_of_each_tool_and_object_up_to_the_limit_and_says_what_it_leaves_out)
{
    const FrameOutput all = crowd(4, kMaxPairs / 4);
    EXPECT_EQ(all.scene.pairs, kMaxPairs);
    EXPECT_FALSE(has_fault(all.faults, FrameFault::scene_over_capacity));
    const FrameOutput full = crowd(4, kMaxPairs / 4 + 1);
    EXPECT_TRUE(has_fault(full.faults, FrameFault::scene_over_capacity));
    EXPECT_EQ(full.scene.pairs, kMaxPairs); // All are equally near.
    EXPECT_FALSE(has_fault(crowd(1, kMaxNear).faults, FrameFault::scene_over_capacity));
    const FrameOutput over = crowd(1, kMaxNear + 1);
    EXPECT_TRUE(has_fault(over.faults, FrameFault::scene_over_capacity));
    EXPECT_EQ(over.scene.pairs, kMaxNear);
    EXPECT_EQ(over.scene.tools_over_capacity, 1U);
}

TEST(SceneCrowd, ends_for_frames_at_rest_with_the_tool_that_was_crowded)
{
    const TestModel& model = small_model(0);
    RigOptions options = with_room_for_all();
    options.static_when_it_fits = true;
    options.tools.assign(2, ToolSpec{0.01 * model.diagonal_m});
    options.objects.assign(kMaxNear + 1, ObjectSpec{ModelId{0}});
    FrameRig sut(model, options);
    const Vec3 amid_m = to_vec3(model.faces[0][0]);
    const std::vector<Vec3> goals_m{amid_m, amid_m + Vec3(10.0 * model.diagonal_m, 0.0, 0.0)};
    ASSERT_TRUE(has_fault(sut.step(goals_m, Budgets{}).faults, FrameFault::scene_over_capacity));
    SceneChange change;
    change.kind = SceneChangeKind::tool_goes;
    sut.change(change);
    std::uint32_t rested = 0;
    for (int i = 0; i < 1'000 && rested < 2; ++i)
    {
        const FrameOutput output = sut.step(goals_m, Budgets{});
        rested += output.work.skipped.times()[static_cast<std::size_t>(Skip::frames)];
        EXPECT_FALSE(has_fault(output.faults, FrameFault::scene_over_capacity)) << "frame " << i;
    }
    EXPECT_EQ(rested, 2U);
}

/// Two objects and one pair: the sphere must not move where it is not tracked.
TEST(SceneCrowd, stops_a_tool_where_what_is_near_is_not_followed)
{
    const TestModel& model = small_model(0);
    RigOptions options = with_room_for_all();
    options.tools = {{0.01 * model.diagonal_m, 500.0, 8.0, 1.0}};
    options.objects.assign(2, ObjectSpec{ModelId{0}});
    options.capacities.pairs = 1;
    FrameRig rig(model, options);
    const double apart_m = 0.001 * model.diagonal_m;
    ObjectPose beside;
    beside.translation_m = Vec3(apart_m, 0.0, 0.0);
    rig.place_object(beside, 1);
    Vec3 goal(1.5 * model.diagonal_m, 0.0, 0.0);
    const FaceTree tree(model.faces);
    bool exceeded_capacity = false;
    for (int i = 0; i < 3'000; ++i)
    {
        goal.x() -= 0.001 * model.diagonal_m;
        const FrameOutput output = rig.step(goal);
        for (const double at_m : {0.0, apart_m})
        {
            ASSERT_GE(tree.nearest(output.tools[0].proxy_m - Vec3(at_m, 0.0, 0.0)).distance_m,
                      0.01 * model.diagonal_m * (1.0 - 2.0 * kContactTolerance))
                << "frame " << i;
        }
        ASSERT_EQ(output.scene.pairs, 1U);
        exceeded_capacity = exceeded_capacity || output.scene.walled_tools > 0;
    }
    EXPECT_TRUE(exceeded_capacity);
}

/// A row of many models passes under a tool's hand; no tool comes near the others.
TEST(Scene, of_the_most_models_only_those_near_a_tool_are_looked_at_and_that_changes_nothing)
{
    std::vector<const TestModel*> models;
    for (std::uint32_t i = 0; i < kMaxModels; ++i)
    {
        models.push_back(small_models()[i % kSmallModels]);
    }
    const double diagonal_m = models[0]->diagonal_m;
    const double apart_m = 2.0 * diagonal_m;
    RigOptions options = scene_options(diagonal_m, 1);
    options.pool_bytes = std::size_t{48} << 20U;
    options.capacities = {};
    for (std::uint32_t i = 0; i < kMaxModels; ++i)
    {
        options.objects.push_back({ModelId{i}, {400.0, 0.3, 0.2, 0.0}});
        options.poses.emplace_back();
        options.poses.back().translation_m = apart_m * Vec3(i % 16, i / 16, 0.0);
    }
    FrameRig::validate_every(200); // Each validation visits all slots for each model.
    FrameRig usual(models, options);
    options.variant.asks_near_models_only = false;
    FrameRig sut(models, options);
    Vec3 goal_m = to_vec3(models[0]->faces[0][0]);
    std::uint32_t contacts = 0;
    for (int frame = 0; frame < 600; ++frame)
    {
        goal_m += Vec3(0.002 * apart_m, 0.0, 0.0);
        const FrameOutput expected = sut.step(goal_m);
        const FrameOutput output = usual.step(goal_m);
        const auto skipped = output.work.skipped.times()[static_cast<std::size_t>(Skip::models)];
        ASSERT_GE(skipped, frame < 2 ? 0U : kMaxModels - 8) << "frame " << frame;
        ASSERT_EQ(output.pairs.size(), expected.pairs.size());
        for (std::size_t i = 0; i < output.pairs.size(); ++i)
        {
            ASSERT_EQ(output.pairs[i].lower_m, expected.pairs[i].lower_m) << "frame " << frame;
            ASSERT_EQ(output.pairs[i].upper_m, expected.pairs[i].upper_m) << "frame " << frame;
        }
        ASSERT_EQ(output.tools[0].force_n, expected.tools[0].force_n) << "frame " << frame;
        contacts += output.tools[0].in_contact ? 1U : 0U;
        for (std::uint32_t i = 0; i < kMaxModels; ++i)
        {
            ASSERT_EQ(output.models[i].state_hash, expected.models[i].state_hash)
                << "frame " << frame << ", model " << i;
        }
    }
    FrameRig::validate_every(TACTUS_VALIDATED_EVERY);
    EXPECT_GT(contacts, 20U);
}

/// Refinement behind the tool is merged before the model becomes inactive.
TEST(Scene, a_model_that_a_tool_has_left_is_its_base_mesh_again_before_it_rests)
{
    const std::vector<const TestModel*> models{&small_model(0), &small_model(1)};
    const double diagonal_m = models[0]->diagonal_m;
    RigOptions options = scene_options(diagonal_m, 1);
    options.tools[0].query_only = true;
    options.objects = {{ModelId{0}, {}}, {ModelId{1}, {}}};
    options.poses.resize(2);
    options.poses[1].translation_m = Vec3(10.0 * diagonal_m, 0.0, 0.0);
    FrameRig sut(models, options);
    const Vec3 first_m = to_vec3(models[0]->faces[0][0]);
    const Vec3 second_m = to_vec3(models[1]->faces[0][0]) + options.poses[1].translation_m;
    FrameOutput output;
    for (int frame = 0; frame < 400; ++frame)
    {
        output = sut.step(first_m);
    }
    ASSERT_GT(output.models[0].refined_records, 10U);
    for (int frame = 0; frame < 2'000; ++frame)
    {
        output = sut.step(first_m + std::min(frame / 500.0, 1.0) * (second_m - first_m));
    }
    EXPECT_EQ(output.models[0].refined_records, 0U);
    EXPECT_GT(output.models[1].refined_records, 10U);
    EXPECT_EQ(output.work.skipped.times()[static_cast<std::size_t>(Skip::models)], 1U);
}

} // namespace
} // namespace tactus::test
