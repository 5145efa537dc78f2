// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/telemetry_tap.hpp"
#include "tests/unit/hrtc/loop_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace tactus::hrtc::test
{

namespace
{

TEST(TelemetryTap, has_nothing_before_the_first_frame)
{
    const TelemetryTap sut(kPeriod);
    Telemetry telemetry;
    telemetry.frame = 7;
    EXPECT_FALSE(sut.try_read(telemetry));
    EXPECT_EQ(telemetry.frame, 7U);
}

TEST(TelemetryTap, shows_the_newest_frame_as_the_loop_had_it)
{
    LoopRigOptions options;
    options.frames = kSettled;
    LoopRig rig(options);
    rig.loop().run();
    Telemetry telemetry;
    ASSERT_TRUE(rig.telemetry.try_read(telemetry));
    EXPECT_EQ(telemetry.frame, kSettled);
    EXPECT_EQ(telemetry.period_ns, kPeriod.ns);
    EXPECT_EQ(telemetry.exact, rig.statistics().answers.exact);
    EXPECT_EQ(telemetry.separated, rig.statistics().answers.separated);
    EXPECT_EQ(telemetry.exact + telemetry.separated + telemetry.within_tolerance +
                  telemetry.bounded + telemetry.stale,
              kSettled);
    EXPECT_EQ(telemetry.tool_count, 1U);
    EXPECT_EQ(telemetry.model_count, 1U);
    EXPECT_EQ(telemetry.models[0].pages.capacity, rig.statistics().models[0].pages.capacity);
    EXPECT_EQ(telemetry.models[0].faces.used, rig.statistics().models[0].faces.used);
    EXPECT_GT(telemetry.models[0].faces.used, 0U);
    EXPECT_TRUE(telemetry.tools[0].in_contact);
    const Vec3& sent_n = rig.written_n(kSettled - 1);
    EXPECT_EQ(telemetry.tools[0].force_n[0], sent_n.x());
    EXPECT_EQ(telemetry.tools[0].force_n[2], sent_n.z());
    EXPECT_GT(telemetry.tools[0].proxy_m[0], telemetry.tools[0].position_m[0]); // Pressed in -x.
    EXPECT_EQ(telemetry.tools[0].rotation, (std::array{0.0, 0.0, 0.0, 1.0}));
    ASSERT_EQ(telemetry.pair_count, 1U);
    EXPECT_EQ(telemetry.pairs[0].tool, 0U);
    EXPECT_EQ(telemetry.pairs[0].object, 0U);
    EXPECT_EQ(telemetry.pairs[0].kind, AnswerKind::exact);
    EXPECT_LE(telemetry.pairs[0].lower_m, telemetry.pairs[0].upper_m);
    EXPECT_EQ(telemetry.pairs[0].force_n[0], -sent_n.x()); // The whole force is on the one object.
    EXPECT_EQ(telemetry.pairs[0].force_n[2], -sent_n.z());
}

TEST(ObjectTap, leaves_a_copy_alone_until_it_is_given_back)
{
    LoopRigOptions options;
    options.frames = 10;
    LoopRig rig(options);
    ObjectTap& sut = rig.telemetry.objects();
    EXPECT_EQ(sut.take(), nullptr);
    rig.loop().run();
    const ObjectsCopy* copy = sut.take();
    ASSERT_NE(copy, nullptr);
    const ObjectTable& objects = rig.frame().objects();
    EXPECT_EQ(copy->sweep_begin, 0U);
    EXPECT_EQ(copy->sweep_end, std::min(kObjectSweep, objects.capacity()));
    ASSERT_EQ(copy->objects.size(), 1U);
    EXPECT_EQ(copy->objects[0].number, 0U);
    EXPECT_EQ(copy->objects[0].pose.translation_m, objects[0].pose.translation_m);
    sut.show(objects, {});
    EXPECT_EQ(sut.take(), copy);
    sut.give_back(true);
    EXPECT_EQ(sut.take(), nullptr);
}

TEST(ObjectTap, lists_objects_of_pairs_once_and_in_turn_all_others)
{
    LoopRigOptions options;
    options.frames = 1;
    LoopRig rig(options);
    rig.loop().run();
    const ObjectTable& objects = rig.frame().objects();
    std::array<PairOutput, 2> pairs{}; // Two tools near object 0.
    ObjectTap sut;
    sut.show(objects, pairs);
    EXPECT_EQ(sut.take()->objects.size(), 1U);
    sut.give_back(false);
    sut.show(objects, pairs);
    EXPECT_EQ(sut.take()->sweep_begin, 0U) << "the range was not sent";
    sut.give_back(true);
    sut.show(objects, pairs);
    EXPECT_EQ(sut.take()->sweep_begin, objects.capacity() > kObjectSweep ? kObjectSweep : 0U);
}

TEST(TelemetryTap, sends_no_gripper_that_is_no_number)
{
    for (const double gripper_m :
         {0.03, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    {
        LoopRigOptions options;
        options.frames = 10;
        options.tamper = [gripper_m](std::uint64_t, DeviceSample& sample)
        {
            sample.buttons = 5;
            sample.gripper_m = gripper_m;
        };
        LoopRig rig(options);
        rig.loop().run();
        Telemetry telemetry;
        ASSERT_TRUE(rig.telemetry.try_read(telemetry));
        EXPECT_EQ(telemetry.tools[0].buttons, 5U);
        EXPECT_EQ(telemetry.tools[0].has_gripper, std::isfinite(gripper_m));
        EXPECT_EQ(telemetry.tools[0].gripper_m, std::isfinite(gripper_m) ? gripper_m : 0.0);
    }
}

/// Pair of a tool at the origin and an object that begins at this distance in that direction.
PairOutput pair_towards(const Vec3& inward, double distance_m)
{
    PairOutput pair;
    pair.nearest_point_m = distance_m * inward.normalized();
    pair.lower_m = pair.upper_m = distance_m;
    return pair;
}

TEST(SharePush, gives_each_wall_of_a_corner_its_part_and_nothing_to_what_is_not_touched)
{
    const std::array pairs{pair_towards(Vec3(1.0, 0.0, 0.0), 0.01),
                           pair_towards(Vec3(0.0, 1.0, 0.0), 0.01),
                           pair_towards(Vec3(0.0, 0.0, 1.0), 0.02)};
    std::array<Vec3, 3> pushes_n;
    share_push(pairs, 0.01, Vec3(3.0, 2.0, 0.0), pushes_n);
    EXPECT_LT((pushes_n[0] - Vec3(3.0, 0.0, 0.0)).norm(), 1e-9);
    EXPECT_LT((pushes_n[1] - Vec3(0.0, 2.0, 0.0)).norm(), 1e-9);
    EXPECT_EQ(pushes_n[2].norm(), 0.0);
}

TEST(SharePush, adds_up_to_the_push_whatever_the_normals_are)
{
    const std::array pairs{pair_towards(Vec3(1.0, 0.1, 0.0), 0.01),
                           pair_towards(Vec3(1.0, -0.1, 0.3), 0.01),
                           pair_towards(Vec3(-1.0, 0.0, 0.0), 0.01)};
    std::array<Vec3, 3> pushes_n;
    const Vec3 push_n(3.0, 2.0, -1.0); // Force with friction.
    share_push(pairs, 0.01, push_n, pushes_n);
    EXPECT_LT((pushes_n[0] + pushes_n[1] + pushes_n[2] - push_n).norm(), 1e-12);
    EXPECT_LT(pushes_n[2].norm(), 1e-12); // The object would have to pull.
}

TEST(SharePush, leaves_a_push_that_no_normal_explains_to_the_nearest)
{
    const std::array pairs{pair_towards(Vec3(1.0, 0.0, 0.0), 0.012),
                           pair_towards(Vec3(1.0, 0.0, 0.0), 0.011)};
    std::array<Vec3, 2> pushes_n;
    share_push(pairs, 0.01, Vec3(-1.0, 0.0, 0.0), pushes_n);
    EXPECT_EQ(pushes_n[0].norm(), 0.0);
    EXPECT_EQ(pushes_n[1].x(), -1.0);
    share_push({}, 0.01, Vec3(-1.0, 0.0, 0.0), {});
}

TEST(TelemetryTap, keeps_the_faults_of_frames_that_nobody_looked_at)
{
    LoopRigOptions options;
    options.tamper = [](std::uint64_t frame, DeviceSample& sample)
    { sample.valid = frame != kSettled; };
    LoopRig rig(options);
    rig.loop().run();
    Telemetry telemetry;
    ASSERT_TRUE(rig.telemetry.try_read(telemetry));
    const auto invalid = static_cast<std::uint32_t>(FrameFault::tool_invalid);
    EXPECT_EQ(telemetry.faults_now & invalid, 0U);
    EXPECT_EQ(telemetry.faults_seen & invalid, invalid);
}

} // namespace

} // namespace tactus::hrtc::test
