// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Tools that are more than a point, in whole frames: what they push with, that no face of their
/// core ever meets one of the model, and that a recording of it replays bit for bit.

#include "host_tools/shapes/shapes.hpp"
#include "platform/recording/replay.hpp"
#include "tests/property/frame_checks.hpp"
#include "tests/shared/solid_cores.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tactus::test
{

namespace
{

Mat3 turn(const Vec3& axis, double angle)
{
    return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// A tetrahedron; the hull of its corners.
const std::array<Vec3, 4>& spike()
{
    static const std::array<Vec3, 4> corners{Vec3(0, 0, -0.02), Vec3(0.006, 0, 0.01),
                                             Vec3(-0.004, 0.005, 0.01), Vec3(-0.004, -0.005, 0.01)};
    return corners;
}

std::vector<SolidCore> tools()
{
    const Vec3 half(0.012, 0.008, 0.004);
    const Segment segment{{-0.01, 0, 0}, {0.02, 0, 0.003}};
    const auto& s = spike();
    const TestModel& mesh = test_model("rigid-tool", make_uv_sphere(12, 16).value(), 60);
    SolidCore hull{"hull",
                   Hull::create(s).value(),
                   {{s[0], s[1], s[2]}, {s[0], s[2], s[3]}, {s[0], s[3], s[1]}, {s[1], s[2], s[3]}},
                   0.001};
    return {box_core("box", half, 0.001), segment_core("capsule", segment, 0.002), hull,
            box_core("skin", 2.0 * half, 0.0), mesh_core("mesh", mesh, 0.0015)};
}

RigOptions options_for(const SolidCore& tool)
{
    RigOptions options;
    options.pool_bytes = std::size_t{32} << 20U;
    ToolSpec spec;
    spec.radius_m = tool.radius_m;
    spec.core = tool.core;
    spec.wants_contacts = true;
    options.tools = {spec};
    return options;
}

std::vector<const TestModel*> models_for(const SolidCore& tool, const TestModel& object)
{
    std::vector<const TestModel*> models{&object};
    if (tool.mesh != nullptr)
    {
        models.push_back(tool.mesh);
    }
    return models;
}

/// A hand that goes from place to place through and around the model, and turns.
class Hand
{
public:
    Hand(const TestModel& model, Random& random) : model_(model), random_(random)
    {
        state_.position_m = away();
        aim_ = state_.position_m;
    }

    const ToolState& next()
    {
        if (random_.one_in(60))
        {
            const Face& face = model_.faces[random_.below(model_.faces.size())];
            aim_ = random_.one_in(8) ? away()
                                     : to_vec3(face[0]) + random_.in_cube(0.02 * model_.diagonal_m);
            axis_ = random_.in_cube(1.0) + Vec3(0, 0, 1e-3);
        }
        state_.position_m += 0.04 * (aim_ - state_.position_m);
        state_.rotation = turn(axis_, 0.02) * state_.rotation;
        return state_;
    }

private:
    Vec3 away() { return to_vec3(model_.faces[0][0]) + Vec3(2, 2, 2) * model_.diagonal_m; }

    const TestModel& model_;
    Random& random_;
    ToolState state_;
    Vec3 aim_;
    Vec3 axis_{0, 0, 1};
};

/// The core on its way between two frames.
void expect_no_crossing(const SolidCore& tool, const Vec3& center, const ToolOutput& before,
                        const ToolOutput& after, const TestModel& model)
{
    ASSERT_EQ(crossings_on_way(tool, {before.proxy_rotation, before.proxy_m, 1.0},
                               {after.proxy_rotation, after.proxy_m, 1.0}, center, model, 4),
              0);
}

/// Frames with a contact.
int run_hand(const SolidCore& tool, const TestModel& model, Random& random, std::uint32_t frames)
{
    RigOptions options = options_for(tool);
    options.faults.loss = 0.1;
    options.faults.delay_polls_max = 20;
    FrameRig rig(models_for(tool, model), options);
    Hand hand(model, random);
    ToolOutput last;
    const Vec3 center = rig.frame().tool(0).ball().center; // It is where it was made.
    int contacts = 0;
    for (std::uint32_t i = 0; i < frames; ++i)
    {
        const ToolState& state = hand.next();
        const FrameOutput output = rig.step(std::span(&state, 1), {});
        const ToolOutput& now = output.tools[0];
        SCOPED_TRACE(tool.name + " on " + model.name + ", frame " + std::to_string(i));
        EXPECT_TRUE(now.force_n.allFinite() && now.torque_nm.allFinite());
        EXPECT_LE(now.force_n.norm(), options.tools[0].force_max_n * (1.0 + 1e-12));
        EXPECT_LE(now.torque_nm.norm(), options.tools[0].torque_max_nm * (1.0 + 1e-12));
        EXPECT_TRUE(now.in_contact || now.force_n.isZero(0.0));
        if (i > 0)
        {
            expect_no_crossing(tool, center, last, now, model);
        }
        if (testing::Test::HasFailure())
        {
            return contacts;
        }
        contacts += now.in_contact ? 1 : 0;
        last = now;
    }
    return contacts;
}

} // namespace

TEST(RigidTools, never_cross_a_surface_seen_or_not)
{
    Random random(1);
    for (const SolidCore& tool : tools())
    {
        int contacts = 0;
        for (std::size_t i = 0; i < kSmallModels; ++i)
        {
            contacts += run_hand(tool, small_model(i), random, 400);
            ASSERT_FALSE(HasFailure());
        }
        EXPECT_GT(contacts, 300) << tool.name;
    }
}

TEST(RigidTools, pressed_on_a_fine_plate_rest_at_their_radius_and_push_by_their_depth)
{
    const TestModel& model = test_model("rigid-plate", make_thin_plate(24, 0.01).value(), 100);
    Vec3 low(1e9, 1e9, 1e9);
    Vec3 high = -low;
    for (const Face& face : model.faces)
    {
        for (const Vec3f& corner : face)
        {
            low = least_of(low, to_vec3(corner));
            high = greatest_of(high, to_vec3(corner));
        }
    }
    for (const SolidCore& tool : tools())
    {
        SCOPED_TRACE(tool.name);
        RigOptions options = options_for(tool);
        options.tools[0].force_max_n = 100.0;
        options.tools[0].torque_max_nm = 100.0;
        FrameRig rig(models_for(tool, model), options);
        ToolState state;
        const Vec3 goal(0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), high.z() - 0.002);
        const Vec3 above = goal + Vec3(0, 0, 0.2);
        state.position_m = above;
        rig.step(std::span(&state, 1), {});
        for (int i = 0; i < 900; ++i)
        {
            state.position_m.z() = std::max(goal.z(), state.position_m.z() - 5e-4);
            rig.step(std::span(&state, 1), {});
        }

        const FrameOutput output = rig.step(std::span(&state, 1), {});
        const ToolOutput pressed = output.tools[0];
        const double distance_m = output.pairs[0].lower_m;
        state.position_m = above;
        ToolOutput away;
        for (int i = 0; i < 100; ++i)
        {
            away = rig.step(std::span(&state, 1), {}).tools[0];
        }

        const double radius_m =
            std::max(tool.radius_m, kLeastSkin * PlacedCore(tool.core, {}).radius());
        const double depth_m = pressed.proxy_m.z() - goal.z();
        EXPECT_TRUE(pressed.in_contact);
        EXPECT_FALSE(pressed.frozen);
        EXPECT_NEAR(distance_m, radius_m, 1e-3 * radius_m);
        EXPECT_LE((pressed.force_n - Vec3(0, 0, 500.0 * depth_m)).norm(), 0.01);
        EXPECT_GT(depth_m, 0.002);
        EXPECT_EQ(away.proxy_m, above);
        EXPECT_EQ(away.force_n, Vec3(0, 0, 0));
        EXPECT_EQ(away.torque_nm, Vec3(0, 0, 0));
    }
}

TEST(RigidTools, a_box_pressed_flat_on_a_fine_plate_is_not_turned)
{
    const TestModel& model = test_model("rigid-plate", make_thin_plate(24, 0.01).value(), 100);
    const SolidCore box = tools()[0];
    FrameRig rig(models_for(box, model), options_for(box));
    ToolState state;
    state.position_m = Vec3(0.05, 0.05, 0.1);
    ToolOutput pressed;
    for (int i = 0; i < 900; ++i)
    {
        state.position_m.z() = std::max(0.01, state.position_m.z() - 5e-4);
        pressed = rig.step(std::span(&state, 1), {}).tools[0];
    }

    EXPECT_TRUE(pressed.in_contact);
    EXPECT_LE(pressed.torque_nm.norm(), 1e-4);
    EXPECT_LE((pressed.proxy_rotation - Mat3::Identity()).norm(), 1e-4);
    EXPECT_NEAR(pressed.force_n.z(), 500.0 * (pressed.proxy_m.z() - 0.01), 1e-3);
}

TEST(RigidTools, replay_bit_for_bit)
{
    Random random(2);
    for (const SolidCore& tool : tools())
    {
        RigOptions options = options_for(tool);
        options.record = true;
        FrameRig rig(models_for(tool, small_model(0)), options);
        Hand hand(small_model(0), random);
        int contacts = 0;
        for (int i = 0; i < 400; ++i)
        {
            const ToolState& state = hand.next();
            contacts += rig.step(std::span(&state, 1), {}).tools[0].in_contact ? 1 : 0;
        }
        EXPECT_GT(contacts, 0) << tool.name;

        const auto recording = Recording::parse(rig.finish_recording(), tool.name);
        ASSERT_TRUE(recording) << recording.error().text;
        const auto replayed = replay(recording.value());

        ASSERT_TRUE(replayed) << replayed.error().text;
        EXPECT_EQ(replayed.value().frames, 400U);
        EXPECT_FALSE(replayed.value().difference) << replayed.value().difference->text;
    }
}

} // namespace tactus::test
