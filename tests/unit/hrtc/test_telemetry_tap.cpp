// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/telemetry_tap.hpp"
#include "tests/unit/hrtc/loop_rig.hpp"

#include <gtest/gtest.h>

#include <cstdint>

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
    EXPECT_EQ(telemetry.decided, rig.statistics().answers.decided);
    EXPECT_EQ(telemetry.exact + telemetry.decided + telemetry.bracket + telemetry.stale, kSettled);
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
