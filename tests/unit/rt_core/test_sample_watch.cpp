// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/sample_watch.hpp"
#include "rt_core/limits.hpp"
#include "tests/shared/period.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tactus::test
{

namespace
{

constexpr double kRounding_s = 1e-9; ///< Rounding of sums of frames.

/// Watch with its accepted goal, and a tool without contact.
class WatchedTool
{
public:
    SampleWatch::Verdict give(const Vec3& position_m, std::int64_t time_ns, bool valid = true)
    {
        ToolState sample;
        sample.position_m = position_m;
        sample.sample_time_ns = time_ns;
        sample.valid = valid;
        sample.rotation = rotation;
        const SampleWatch::Verdict verdict = sut.judge(sample, spec, goal, kPeriod_s);
        if (verdict.is_taken)
        {
            goal.position_m = position_m;
            goal.rotation = rotation;
        }
        return verdict;
    }
    /// Sample at the same place, rotated.
    SampleWatch::Verdict turn_to(double angle_rad)
    {
        rotation = Eigen::AngleAxisd(angle_rad, Vec3(0.6, 0.0, 0.8)).toRotationMatrix();
        return give(goal.position_m, 0);
    }
    /// Fault with the proxy at this place.
    [[nodiscard]] FrameFault fault_with(const Vec3& proxy_m)
    {
        ToolOutput output;
        output.proxy_m = proxy_m;
        output.proxy_rotation = proxy_rotation;
        output.in_contact = true;
        sut.look_for_return(output, spec, goal);
        return sut.fault();
    }

    SampleWatch sut;
    ToolSpec spec{0.002, 500.0, 8.0, 1.0};
    ProxyGoal goal;
    Mat3 rotation{Mat3::Identity()};
    Mat3 proxy_rotation{Mat3::Identity()}; ///< Rotation of the tool in contact.
};

const Vec3 kHere(0.1, 0.0, 0.0);

TEST(SampleWatch, tells_the_first_sample)
{
    WatchedTool tool;
    EXPECT_EQ(tool.sut.fault(), FrameFault::none);
    EXPECT_FALSE(tool.give(kHere, 0, false).is_taken);
    EXPECT_EQ(tool.fault_with(kHere), FrameFault::tool_invalid);

    const SampleWatch::Verdict first = tool.give(kHere, 0);
    EXPECT_TRUE(first.is_taken);
    EXPECT_TRUE(first.is_first);
    EXPECT_EQ(first.fault, FrameFault::none);
    EXPECT_EQ(tool.fault_with(kHere), FrameFault::none);
}

TEST(SampleWatch, takes_no_number_that_is_none_or_out_of_range)
{
    using Limits = std::numeric_limits<double>;
    for (const double bad : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(),
                             Limits::max(), kGoalRange_m, -kGoalRange_m})
    {
        for (Eigen::Index axis = 0; axis < 3; ++axis)
        {
            WatchedTool tool;
            ASSERT_TRUE(tool.give(kHere, 0).is_taken);
            Vec3 place = kHere;
            place[axis] = bad;
            const SampleWatch::Verdict verdict = tool.give(place, 0);
            EXPECT_FALSE(verdict.is_taken) << bad;
            EXPECT_EQ(verdict.fault, FrameFault::tool_invalid) << bad;
        }
    }
    WatchedTool tool;
    ASSERT_TRUE(tool.give(kHere, 0).is_taken);
    EXPECT_TRUE(tool.give(Vec3(0.1, Limits::denorm_min(), -0.0), 0).is_taken);
}

TEST(SampleWatch, takes_a_rotation_within_the_tolerance_alone)
{
    const auto sheared = [](double share)
    {
        Mat3 rotation = Mat3::Identity();
        rotation(0, 1) = share * kRotationTolerance;
        return rotation;
    };
    const Mat3 mirror = Vec3(1.0, 1.0, -1.0).asDiagonal();
    const Mat3 no_number = Mat3::Constant(std::numeric_limits<double>::quiet_NaN());
    for (const Mat3& rotation : {sheared(0.99), sheared(1.01), mirror, no_number,
                                 Mat3(Mat3::Identity() * 1.001), Mat3(Mat3::Zero())})
    {
        SampleWatch sut;
        ToolState sample;
        sample.rotation = rotation;
        const SampleWatch::Verdict verdict = sut.judge(sample, {}, {}, kPeriod_s);
        const bool is_rotation = rotation == sheared(0.99);
        EXPECT_EQ(verdict.is_taken, is_rotation) << rotation;
        EXPECT_EQ(verdict.fault, is_rotation ? FrameFault::none : FrameFault::tool_invalid);
    }
}

TEST(SampleWatch, knows_how_long_it_had_no_sample)
{
    WatchedTool tool;
    ASSERT_TRUE(tool.give(kHere, 0).is_taken);
    for (int frame = 1; frame <= 80; ++frame)
    {
        EXPECT_EQ(tool.give(kHere, 0, false).fault, FrameFault::tool_invalid);
    }
    const SampleWatch::Verdict again = tool.give(kHere, 0);
    EXPECT_TRUE(again.is_taken);
    EXPECT_NEAR(again.since_s, 81 * kPeriod_s, 1e-12);
}

TEST(SampleWatch, a_slow_device_is_not_stuck_and_a_stuck_one_is)
{
    WatchedTool tool;
    std::int64_t time_ns = 1'000;
    for (int frame = 0; frame < 40; ++frame) // New sample in every fourth frame.
    {
        const SampleWatch::Verdict verdict = tool.give(kHere, time_ns + frame / 4);
        EXPECT_EQ(verdict.is_taken, frame % 4 == 0);
        EXPECT_EQ(verdict.fault, FrameFault::none);
        EXPECT_EQ(tool.fault_with(kHere), FrameFault::none);
    }
    time_ns += 10;
    ASSERT_TRUE(tool.give(kHere, time_ns).is_taken);
    for (int frame = 1; frame < 100; ++frame)
    {
        const bool is_stuck = has_fault(tool.give(kHere, time_ns).fault, FrameFault::tool_stuck);
        const double blind_s = frame * kPeriod_s;
        EXPECT_TRUE(is_stuck || blind_s < kSampleHold_s + kRounding_s) << frame;
        EXPECT_TRUE(!is_stuck || blind_s > kSampleHold_s - kRounding_s) << frame;
    }
    EXPECT_EQ(tool.fault_with(kHere), FrameFault::tool_stuck);
}

TEST(SampleWatch, an_older_sample_is_not_taken_unless_the_clock_began_anew)
{
    WatchedTool tool;
    ASSERT_TRUE(tool.give(kHere, 5'000).is_taken);
    const SampleWatch::Verdict older = tool.give(kHere, 4'999);
    EXPECT_FALSE(older.is_taken);
    EXPECT_EQ(older.fault, FrameFault::tool_invalid);
    EXPECT_TRUE(tool.give(kHere, 5'001).is_taken);
    int refused = 0;
    while (refused < 1'000 && !tool.give(kHere, 10).is_taken)
    {
        ++refused;
    }
    EXPECT_NEAR(refused * kPeriod_s, kSampleHold_s + kFadeTime_s, 2.0 * kPeriod_s);
    EXPECT_TRUE(tool.give(kHere, 11).is_taken);
}

TEST(SampleWatch, a_jump_is_told_until_the_goal_is_near_the_proxy)
{
    WatchedTool tool;
    ASSERT_TRUE(tool.give(kHere, 0).is_taken);
    const SampleWatch::Verdict jump = tool.give(Vec3(10.0, 0.0, 0.0), 0);
    EXPECT_TRUE(jump.is_taken);
    EXPECT_EQ(jump.fault, FrameFault::tool_jumped);
    EXPECT_EQ(tool.fault_with(kHere), FrameFault::tool_jumped);
    EXPECT_EQ(tool.give(Vec3(9.95, 0.0, 0.0), 0).fault, FrameFault::none);
    EXPECT_EQ(tool.fault_with(kHere), FrameFault::tool_jumped) << "it is still far away";
    const double spring_m = tool.spec.force_max_n / tool.spec.stiffness_n_per_m;
    EXPECT_EQ(tool.fault_with(Vec3(9.95 - 1.01 * spring_m, 0.0, 0.0)), FrameFault::tool_jumped);
    EXPECT_EQ(tool.fault_with(Vec3(9.95 - 0.99 * spring_m, 0.0, 0.0)), FrameFault::none);
    EXPECT_EQ(tool.fault_with(kHere), FrameFault::none) << "once it was near, all is as ever";
}

TEST(SampleWatch, a_goal_has_jumped_that_is_so_many_times_too_fast)
{
    for (const double speed_max : {0.1, 1.0, 3.0}) // The least value used is 1 m/s.
    {
        const double limit_m = kJumpSpeeds * std::max(speed_max, 1.0) * kPeriod_s;
        for (const double share : {0.999, 1.001})
        {
            WatchedTool tool;
            tool.spec.speed_max_m_per_s = speed_max;
            ASSERT_TRUE(tool.give(kHere, 0).is_taken);
            EXPECT_EQ(tool.give(kHere + Vec3(0.0, share * limit_m, 0.0), 0).fault,
                      share < 1.0 ? FrameFault::none : FrameFault::tool_jumped)
                << speed_max;
        }
    }
}

TEST(SampleWatch, a_goal_has_jumped_that_turns_faster_than_any_hand)
{
    for (const double share : {0.999, 1.001})
    {
        WatchedTool tool;
        tool.spec.core = Box{Vec3(0.01, 0.02, 0.03)};
        ASSERT_TRUE(tool.give(kHere, 0).is_taken);
        EXPECT_EQ(tool.turn_to(share * kJumpRotation_rad_per_s * kPeriod_s).fault,
                  share < 1.0 ? FrameFault::none : FrameFault::tool_jumped);
        WatchedTool sphere;
        ASSERT_TRUE(sphere.give(kHere, 0).is_taken);
        EXPECT_EQ(sphere.turn_to(share * kJumpRotation_rad_per_s * kPeriod_s).fault,
                  FrameFault::none);
    }
}

TEST(SampleWatch, a_jump_of_the_rotation_is_told_until_the_spring_is_within_the_torque)
{
    WatchedTool tool;
    tool.spec.core = Box{Vec3(0.01, 0.02, 0.03)};
    tool.spec.angular_stiffness_nm_per_rad = 2.0;
    tool.spec.torque_max_nm = 0.5;
    ASSERT_TRUE(tool.give(kHere, 0).is_taken);
    EXPECT_EQ(tool.turn_to(2.0).fault, FrameFault::tool_jumped);
    EXPECT_EQ(tool.fault_with(kHere), FrameFault::tool_jumped);
    EXPECT_EQ(tool.turn_to(2.0).fault, FrameFault::none) << "itself it is no jump";
    EXPECT_EQ(tool.fault_with(kHere), FrameFault::tool_jumped) << "it is still far away";
    const auto proxy_behind = [&](double twist_rad)
    {
        tool.proxy_rotation =
            Eigen::AngleAxisd(2.0 - twist_rad, Vec3(0.6, 0.0, 0.8)).toRotationMatrix();
        return tool.fault_with(kHere);
    };
    EXPECT_EQ(proxy_behind(0.251), FrameFault::tool_jumped);
    EXPECT_EQ(proxy_behind(0.249), FrameFault::none);
}

TEST(SampleWatch, a_gap_in_the_samples_is_no_jump)
{
    WatchedTool tool;
    ASSERT_TRUE(tool.give(kHere, 0).is_taken);
    for (int frame = 0; frame < 19; ++frame)
    {
        static_cast<void>(tool.give(kHere, 0, false));
    }
    // The speed is 50 m/s for 20 frames.
    EXPECT_EQ(tool.give(kHere + Vec3(1.0, 0.0, 0.0), 0).fault, FrameFault::none);
    EXPECT_EQ(tool.give(kHere, 0).fault, FrameFault::tool_jumped);
}

} // namespace

} // namespace tactus::test
