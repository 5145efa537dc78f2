// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/placed_core.hpp"
#include "tests/property/frame_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::test
{

namespace
{

/// Truth for a frame's answer of a tool with a core: every face of the source, measured by the
/// kernels, which have their own oracles.
struct Truth
{
    double distance_m{std::numeric_limits<double>::infinity()};
    /// Upper bound, rounded like the frame's.
    double upper_m{std::numeric_limits<double>::infinity()};
    std::size_t touching{0};
    std::size_t nearly_touching{0};
};

Truth measure(const TestModel& model, const PlacedCore& core, double radius_m)
{
    Truth truth;
    for (const Face& face : model.faces)
    {
        const ClosestPoints closest = core.closest(to_triangle(face));
        truth.distance_m = std::min(truth.distance_m, closest.distance);
        truth.upper_m = std::min(truth.upper_m, closest.distance + closest.distance_error);
        truth.touching += closest.distance <= radius_m ? 1U : 0U;
        truth.nearly_touching += closest.distance <= radius_m + 1e-9 ? 1U : 0U;
    }
    return truth;
}

Mat3 turned(Random& random, double most)
{
    return Eigen::AngleAxisd{random.between(-most, most),
                             (random.in_cube(1.0) + Vec3(0, 0, 1e-3)).normalized()}
        .toRotationMatrix();
}

/// Random walk along the surface with rotations and jumps.
class Walk
{
public:
    Walk(const TestModel& model, Random& random) : model_(model), random_(random) { jump(); }

    ToolState next()
    {
        if (random_.one_in(40))
        {
            jump();
        }
        state_.position_m += random_.in_cube(0.004 * model_.diagonal_m);
        state_.rotation = turned(random_, 0.05) * state_.rotation;
        return state_;
    }

private:
    void jump()
    {
        state_.position_m = place_at_distance(model_, random_, 0.02 * model_.diagonal_m);
        state_.rotation = turned(random_, 3.0);
    }

    const TestModel& model_;
    Random& random_;
    ToolState state_;
};

ToolSpec tool_with(const ToolCore& core, double radius_m)
{
    ToolSpec spec;
    spec.radius_m = radius_m;
    spec.core = core;
    spec.wants_contacts = true;
    spec.query_only = true; // Answers are then requested everywhere.
    return spec;
}

struct CoreCase
{
    const char* name;
    ToolCore core; ///< Core for a model with a diagonal of 1 m.
    double radius; ///< Radius for the same model.
};

std::array<CoreCase, 4> core_cases()
{
    return {{{"capsule", Segment{{0, 0, -0.08}, {0, 0, 0.08}}, 0.01},
             {"needle", Segment{{0, 0, 0}, {0.2, 0, 0}}, 0.0},
             {"box", Box{{0.05, 0.03, 0.02}}, 0.0},
             {"rounded_plate", Box{{0.06, 0.06, 0.0}}, 0.005}}};
}

ToolSpec scaled_tool(const CoreCase& kind, double diagonal_m)
{
    ToolCore core = kind.core;
    if (auto* segment = std::get_if<Segment>(&core))
    {
        segment->from *= diagonal_m;
        segment->to *= diagonal_m;
    }
    else if (auto* box = std::get_if<Box>(&core))
    {
        box->half *= diagonal_m;
    }
    return tool_with(core, kind.radius * diagonal_m);
}

/// Hand that moves through the model's surface faster than a rigid tool follows in one step.
class Sweep
{
public:
    Sweep(const TestModel& model, Random& random)
        : from_(place_at_distance(model, random, 0.05 * model.diagonal_m))
        , way_(random.in_cube(0.5 * model.diagonal_m))
        , turn_(turned(random, 0.1))
    {
    }

    ToolState next()
    {
        const double phase = 0.15 * frame_++;
        state_.position_m = from_ + (1.0 - std::cos(phase)) * way_;
        state_.rotation = turn_ * state_.rotation;
        return state_;
    }

private:
    Vec3 from_;
    Vec3 way_;
    Mat3 turn_;
    ToolState state_;
    int frame_{0};
};

/// Counts that show that the test is not empty.
struct Seen
{
    int exact{0};
    int contacts{0};
};

void check_contacts(const ContactReport& report, const Truth& truth)
{
    ASSERT_LE(report.contacts.size(), truth.nearly_touching);
    if (report.is_complete)
    {
        ASSERT_GE(report.contacts.size() + 2, truth.touching) << "but for rounding";
    }
}

void check_pair(const PairOutput& pair, const Truth& truth, double diagonal_m, Seen& seen)
{
    const double slack = 1e-13 * diagonal_m;
    ASSERT_LE(pair.lower_m, truth.distance_m + slack);
    ASSERT_GE(pair.upper_m, truth.distance_m - slack);
    ASSERT_NE(pair.contacts, nullptr);
    check_contacts(*pair.contacts, truth);
    if (pair.kind == AnswerKind::exact)
    {
        ++seen.exact;
        ASSERT_NEAR(pair.upper_m, truth.upper_m, slack);
        ASSERT_NEAR((pair.point_m - pair.nearest_point_m).norm(), truth.distance_m,
                    1e-9 * diagonal_m);
        seen.contacts += static_cast<int>(pair.contacts->contacts.size());
    }
}

void check_frames(const TestModel& model, const CoreCase& kind, Random& random, Seen& seen)
{
    RigOptions options;
    options.tools = {scaled_tool(kind, model.diagonal_m)};
    options.faults.loss = random.one_in(2) ? 0.2 : 0.0;
    FrameRig rig(model, options);
    Walk walk(model, random);
    Budgets budgets;
    budgets.splits = random.one_in(2) ? 64 : 1 + random.below(8);
    for (int frame = 0; frame < 100; ++frame)
    {
        SCOPED_TRACE(model.name + ", " + kind.name + ", frame " + std::to_string(frame));
        const ToolState tool = walk.next();
        const FrameOutput output = rig.step(std::span(&tool, 1), budgets);
        const PlacedCore core(options.tools[0].core, {tool.rotation, tool.position_m, 1.0});
        expect_all_budgets_kept(output, budgets);
        check_pair(output.pairs[0], measure(model, core, options.tools[0].radius_m),
                   model.diagonal_m, seen);
        if (testing::Test::HasFatalFailure())
        {
            return;
        }
    }
}

} // namespace

TEST(ToolCores, every_frame_brackets_the_distance_and_exact_ones_are_the_full_meshs)
{
    Random random(401);
    Seen seen;
    for (std::size_t model = 0; model < 3; ++model)
    {
        for (const CoreCase& kind : core_cases())
        {
            check_frames(small_model(model), kind, random, seen);
        }
    }
    EXPECT_GT(seen.exact, 100);
    EXPECT_GT(seen.contacts, 100);
}

TEST(ToolCores, answers_of_frames_with_several_steps_are_of_the_place_that_they_name)
{
    Random random(403);
    const TestModel& model = small_model(0);
    const double slack = 1e-13 * model.diagonal_m;
    int elsewhere = 0;
    for (const CoreCase& kind : core_cases())
    {
        RigOptions options;
        ToolSpec spec = scaled_tool(kind, model.diagonal_m);
        spec.radius_m = std::max(spec.radius_m, 0.005 * model.diagonal_m);
        spec.query_only = false;
        spec.speed_max_m_per_s = 1e3 * model.diagonal_m;
        options.tools = {spec};
        FrameRig rig(model, options);
        Sweep hand(model, random);
        Vec3 began_m = hand.next().position_m;
        for (int frame = 0; frame < 120; ++frame)
        {
            const ToolState tool = hand.next();
            const FrameOutput output = rig.step(std::span(&tool, 1), {});
            const PairOutput& pair = output.pairs[0];
            const PlacedCore core(spec.core, {pair.tool_rotation, pair.tool_m, 1.0});
            const Truth truth = measure(model, core, spec.radius_m);
            ASSERT_LE(pair.lower_m, truth.distance_m + slack) << kind.name << frame;
            ASSERT_GE(pair.upper_m, truth.distance_m - slack) << kind.name << frame;
            elsewhere += (pair.tool_m - began_m).norm() > slack ? 1 : 0;
            began_m = output.tools[0].proxy_m;
        }
    }
    EXPECT_GT(elsewhere, 20);
}

TEST(ToolCores, a_turned_and_scaled_object_gives_the_same_answers)
{
    Random random(402);
    const TestModel& model = small_model(0);
    for (const CoreCase& kind : core_cases())
    {
        ObjectPose pose;
        pose.rotation = turned(random, 3.0);
        pose.translation_m = random.in_cube(5.0);
        pose.scale = 2.5;
        pose.revision = 0;
        RigOptions options;
        options.tools = {scaled_tool(kind, model.diagonal_m)};
        RigOptions larger = options;
        larger.tools = {scaled_tool(kind, model.diagonal_m * pose.scale)};
        FrameRig here(model, options);
        FrameRig there(model, larger);
        there.place_object(pose);
        Walk walk(model, random);
        for (int frame = 0; frame < 60; ++frame)
        {
            const ToolState tool = walk.next();
            ToolState moved = tool;
            moved.position_m = to_world(pose, tool.position_m);
            moved.rotation = pose.rotation * tool.rotation;
            const PairOutput a = here.step(std::span(&tool, 1), {}).pairs[0];
            const PairOutput b = there.step(std::span(&moved, 1), {}).pairs[0];
            if (a.kind == AnswerKind::exact && b.kind == AnswerKind::exact)
            {
                ASSERT_NEAR(b.upper_m, a.upper_m * pose.scale, 1e-12);
                ASSERT_EQ(b.contacts->contacts.size(), a.contacts->contacts.size());
            }
        }
    }
}

TEST(ToolCores, a_rotation_that_is_none_keeps_the_last_pose_and_is_reported)
{
    const TestModel& model = small_model(0);
    RigOptions options;
    options.tools = {scaled_tool(core_cases()[2], model.diagonal_m)};
    FrameRig rig(model, options);
    ToolState tool;
    tool.position_m = Vec3(2.0, 2.0, 2.0) * model.diagonal_m;
    const FrameOutput first = rig.step(std::span(&tool, 1), {});
    EXPECT_EQ(first.faults & FrameFault::tool_invalid, FrameFault::none);
    const double lower_m = first.pairs[0].lower_m;
    for (const Mat3& wrong :
         {Mat3(Mat3::Zero()), Mat3(2.0 * Mat3::Identity()), Mat3(-1.0 * Mat3::Identity()),
          Mat3(Mat3::Constant(std::numeric_limits<double>::quiet_NaN()))})
    {
        tool.rotation = wrong;
        const FrameOutput output = rig.step(std::span(&tool, 1), {});
        EXPECT_EQ(output.faults & FrameFault::tool_invalid, FrameFault::tool_invalid);
        EXPECT_LE(output.pairs[0].lower_m, lower_m * (1.0 + 1e-12));
        EXPECT_GT(output.pairs[0].lower_m, 0.9 * lower_m);
    }
}

} // namespace tactus::test
