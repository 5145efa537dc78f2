// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/force_fader.hpp"
#include "rt_core/limits.hpp"
#include "tests/shared/period.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ostream>
#include <string>

namespace tactus::test
{

namespace
{

constexpr double kForceMax_n = 8.0;
constexpr double kRounding_n = 1e-9;

/// Period with the frame's force and torque.
struct GuardedPeriod : ToolPeriod
{
    Vec3 force_n{0.0, 0.0, 0.0};
    Vec3 torque_nm{0.0, 0.0, 0.0};
};

/// Output of a period.
struct LetOut
{
    Vec3 force_n{0.0, 0.0, 0.0};
    Vec3 torque_nm{0.0, 0.0, 0.0};
    SafetyState state{SafetyState::reset};
    ForceOff causes{ForceOff::none};
};

/// One tool with a force, frame by frame.
class GuardedTool
{
public:
    GuardedTool() { input.force_n = kForce_n; }

    const LetOut& step(std::uint32_t periods = 1)
    {
        input.elapsed_periods = periods;
        input.elapsed_s = kPeriod_s * periods;
        input.sample_time_ns += 1'000'000;
        ToolForce force;
        force.push.force_n = input.force_n;
        force.torque.force_n = input.torque_nm;
        sut.step(force, input);
        return keep(force);
    }
    const LetOut& fade(ForceOff cause)
    {
        ToolForce force;
        sut.fade(force, kPeriod_s, cause);
        return keep(force);
    }
    void steps(int count)
    {
        for (int i = 0; i < count; ++i)
        {
            step();
        }
    }
    /// Steps until the force is at full gain.
    void warm_up()
    {
        steps(200);
        ASSERT_EQ(last.state, SafetyState::force);
        ASSERT_EQ(last.force_n, kForce_n);
    }

    static inline const Vec3 kForce_n{1.0, -2.0, 3.0};
    static inline const SafetyLimits kLimits{1.0, kForceMax_n, 500.0, 0.5,
                                             0.4, 0.0,         0.0,   kRotationMax_rad_per_s};
    ForceFader sut{kLimits};
    GuardedPeriod input;
    LetOut last;

private:
    const LetOut& keep(const ToolForce& force)
    {
        last = {force.push.force_n, force.torque.force_n, force.state, force.causes};
        return last;
    }
};

/// Cause with its name and the input that sets it.
struct Cause
{
    const char* name;
    ForceOff cause;
    void (*begin)(GuardedPeriod& input);
    void (*end)(GuardedPeriod& input);
};

void PrintTo(const Cause& cause, std::ostream* out)
{
    *out << cause.name;
}

template <ForceOff cause>
constexpr Cause known(const char* name)
{
    return {name, cause, [](GuardedPeriod& input) { input.causes = cause; },
            [](GuardedPeriod& input) { input.causes = ForceOff::none; }};
}

template <FrameFault fault>
constexpr Cause faulty(const char* name, ForceOff cause)
{
    return {name, cause, [](GuardedPeriod& input) { input.faults = fault; },
            [](GuardedPeriod& input) { input.faults = FrameFault::none; }};
}

/// Causes that last until they end; the lost force and the stall have separate tests.
const Cause kCauses[] = {
    known<ForceOff::software>("software"),
    known<ForceOff::disconnect>("disconnect"),
    known<ForceOff::deadman>("deadman"),
    known<ForceOff::stale>("stale"),
    known<ForceOff::server>("server"),
    faulty<FrameFault::tool_stuck>("stuck", ForceOff::stale),
    faulty<FrameFault::tool_invalid>("invalid", ForceOff::garbage),
    faulty<FrameFault::tool_jumped>("jumped", ForceOff::garbage),
    {"velocity", ForceOff::velocity,
     [](GuardedPeriod& input)
     {
         input.has_velocity = true;
         input.velocity_m_per_s = Vec3(0.0, 1.5, 0.0);
     },
     [](GuardedPeriod& input) { input.velocity_m_per_s = Vec3(0.0, 0.1, 0.0); }},
    {"turning", ForceOff::velocity,
     [](GuardedPeriod& input)
     {
         input.has_rotation = true;
         input.rotation_rad_per_s = Vec3(0.0, 1.01 * kRotationMax_rad_per_s, 0.0);
     },
     [](GuardedPeriod& input) { input.rotation_rad_per_s = Vec3(0.0, 1.0, 0.0); }},
    {"no_number", ForceOff::garbage,
     [](GuardedPeriod& input) { input.force_n.x() = std::numeric_limits<double>::quiet_NaN(); },
     [](GuardedPeriod& input) { input.force_n = GuardedTool::kForce_n; }},
};

class FadeCause : public testing::TestWithParam<Cause>
{
protected:
    /// Greatest force of the damping.
    static double damping_max_n(const GuardedPeriod& input)
    {
        return std::min(GuardedTool::kLimits.damping_n_s_per_m * input.velocity_m_per_s.norm(),
                        kDampingForceShare * kForceMax_n);
    }
    GuardedTool tool;
};

INSTANTIATE_TEST_SUITE_P(Each, FadeCause, testing::ValuesIn(kCauses),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(FadeCause, fades_the_last_force_from_the_first_frame_and_names_itself)
{
    tool.warm_up();
    GetParam().begin(tool.input);
    const double before_n = tool.last.force_n.norm();
    const double damping_n = damping_max_n(tool.input);
    double elapsed_s = 0.0;
    while (elapsed_s < kFadeTime_s - 0.5 * kPeriod_s)
    {
        const LetOut out = tool.step();
        elapsed_s += kPeriod_s;
        EXPECT_TRUE(has_cause(out.causes, GetParam().cause));
        const Vec3 ramp_n = GuardedTool::kForce_n * std::max(1.0 - elapsed_s / kFadeTime_s, 0.0);
        EXPECT_LE((out.force_n - ramp_n).norm(), damping_n + kRounding_n) << elapsed_s;
        EXPECT_LE(out.force_n.norm(), before_n + damping_n + kRounding_n);
    }
    tool.step(); // The last one, except for rounding.
    EXPECT_EQ(tool.last.force_n.norm(), 0.0);
    for (int i = 0; i < 100; ++i)
    {
        EXPECT_EQ(tool.step().force_n.norm(), 0.0);
        const bool is_gone = GetParam().cause == ForceOff::disconnect;
        EXPECT_EQ(tool.last.state, is_gone ? SafetyState::reset : SafetyState::idle);
    }
}

TEST_P(FadeCause, comes_back_by_the_ramp_after_any_time)
{
    for (const int bad_frames : {1, 2, 10, 49, 50, 51, 500})
    {
        GuardedTool one;
        one.warm_up();
        GetParam().begin(one.input);
        const double damping_n = damping_max_n(one.input);
        for (int i = 0; i < bad_frames; ++i)
        {
            one.step();
        }
        GetParam().end(one.input);
        const double step_max_n =
            2.0 * kForceMax_n * kPeriod_s / kRiseTime_s + damping_n + kRounding_n;
        int frames = 0;
        for (Vec3 last_n = one.last.force_n; one.last.force_n != GuardedTool::kForce_n; ++frames)
        {
            one.step();
            EXPECT_LE((one.last.force_n - last_n).norm(), step_max_n) << bad_frames;
            EXPECT_EQ(one.last.state, SafetyState::force);
            last_n = one.last.force_n;
            ASSERT_LT(frames, 102) << bad_frames;
        }
        EXPECT_GE(frames, std::min(2 * bad_frames, 100) - 1);
    }
}

TEST(ForceFader, fades_the_present_force_of_a_proxy_that_is_held_and_goes_on_with_it)
{
    for (const FrameFault held : {FrameFault::proxy_halted, FrameFault::proxy_over_constrained,
                                  FrameFault::proxy_halted | FrameFault::proxy_over_constrained})
    {
        GuardedTool tool;
        tool.warm_up();
        tool.input.faults = held;
        for (int frame = 1; frame <= 20; ++frame)
        {
            tool.input.force_n = GuardedTool::kForce_n * (1.0 - 0.02 * frame); // The hand retreats.
            const double gain = 1.0 - frame * kPeriod_s / kFadeTime_s;
            EXPECT_EQ(tool.step().state, SafetyState::brake);
            EXPECT_NEAR((tool.last.force_n - gain * tool.input.force_n).norm(), 0.0, kRounding_n);
        }
        tool.input.faults = FrameFault::none;
        for (int frame = 1; frame <= 20; ++frame)
        {
            tool.input.force_n *= 0.99;
            const double gain = 0.6 + frame * kPeriod_s / kRiseTime_s;
            EXPECT_EQ(tool.step().state, SafetyState::force);
            EXPECT_NEAR((tool.last.force_n - gain * tool.input.force_n).norm(), 0.0, kRounding_n);
        }
    }
}

TEST(ForceFader, a_held_proxy_with_bad_data_fades_as_bad_data_do)
{
    GuardedTool tool;
    tool.warm_up();
    tool.input.faults = FrameFault::proxy_halted | FrameFault::tool_invalid;
    tool.input.force_n = Vec3(5.0, 0.0, 0.0);
    tool.step();
    const Vec3 ramp_n = GuardedTool::kForce_n * (1.0 - kPeriod_s / kFadeTime_s);
    EXPECT_NEAR((tool.last.force_n - ramp_n).norm(), 0.0, kRounding_n);
    EXPECT_EQ(tool.last.causes, ForceOff::halted | ForceOff::garbage);
}

TEST(ForceFader, damps_turning_while_it_fades_and_by_a_share_of_the_torque_at_most)
{
    SafetyLimits limits = GuardedTool::kLimits;
    limits.damping_nm_s_per_rad = 1e-3;
    limits.rotation_max_rad_per_s = 0.0; // There is no limit.
    for (const double turning : {10.0, 1e6})
    {
        GuardedTool tool;
        tool.sut = ForceFader(limits);
        tool.input.rotation_rad_per_s = Vec3(0.0, turning, 0.0);
        tool.input.has_rotation = true;
        tool.warm_up();
        EXPECT_EQ(tool.last.torque_nm, Vec3(0.0, 0.0, 0.0)) << "none at the whole gain";
        tool.input.causes = ForceOff::stale;
        tool.steps(25);
        const double most_nm = kDampingForceShare * limits.torque_max_nm;
        EXPECT_NEAR(tool.last.torque_nm.y(), -std::min(1e-3 * turning, most_nm), 1e-9);
        tool.input.rotation_rad_per_s.x() = std::numeric_limits<double>::quiet_NaN();
        EXPECT_EQ(tool.step().torque_nm, Vec3(0.0, 0.0, 0.0)) << "it has not turned";
    }
}

TEST(ForceFader, finds_how_fast_a_device_turns_that_does_not_tell_it)
{
    SafetyLimits limits = GuardedTool::kLimits;
    limits.damping_nm_s_per_rad = 1e-3;
    for (const double turning : {0.9 * kRotationMax_rad_per_s, 1.1 * kRotationMax_rad_per_s})
    {
        GuardedTool tool;
        tool.sut = ForceFader(limits);
        tool.warm_up();
        for (const std::uint32_t periods : {1U, 4U}) // Real time after a stall.
        {
            tool.input.turned_rad.z() += turning * kPeriod_s * periods;
            const ForceOff causes = tool.step(periods).causes;
            EXPECT_EQ(has_cause(causes, ForceOff::velocity), turning > kRotationMax_rad_per_s);
        }
        EXPECT_LT(tool.last.torque_nm.z(), 0.0) << "it fades, so turning is damped";
        EXPECT_EQ(tool.last.torque_nm.head<2>().norm(), 0.0);
        const double share = 4.0 * tool.sut.gain() * (1.0 - tool.sut.gain());
        EXPECT_NEAR(tool.last.torque_nm.z(), -share * 1e-3 * turning, 1e-9);
    }
}

TEST(ForceFader, begins_only_once_the_twist_is_within_the_devices_torque)
{
    SafetyLimits limits = GuardedTool::kLimits;
    limits.stiffness_nm_per_rad = 2.0;
    GuardedTool tool;
    tool.sut = ForceFader(limits);
    tool.input.twist_rad = 0.21;
    for (int i = 0; i < 200; ++i)
    {
        EXPECT_EQ(tool.step().state, SafetyState::idle);
    }
    tool.input.twist_rad = 0.19;
    EXPECT_EQ(tool.step().state, SafetyState::force);
}

TEST(ForceFader, a_torque_goes_as_the_force_goes)
{
    GuardedTool tool;
    tool.input.torque_nm = Vec3(0.0, 0.3, 0.0);
    tool.warm_up();
    EXPECT_EQ(tool.last.torque_nm, tool.input.torque_nm);
    tool.input.causes = ForceOff::deadman;
    tool.step();
    EXPECT_NEAR(tool.last.torque_nm.y(), 0.3 * (1.0 - kPeriod_s / kFadeTime_s), 1e-12);
    tool.input.causes = ForceOff::none;
    tool.input.torque_nm = Vec3(0.0, 4.0, 0.0);
    for (int i = 0; i < 200; ++i)
    {
        const double before_nm = tool.last.torque_nm.norm();
        tool.step();
        EXPECT_LE(tool.last.torque_nm.norm() - before_nm,
                  2.0 * 0.4 * kPeriod_s / kRiseTime_s + 1e-9);
    }
    EXPECT_NEAR(tool.last.torque_nm.norm(), 0.4, 1e-12) << "the device's largest";
    tool.input.torque_nm.z() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(tool.step().causes, ForceOff::garbage);
}

/// Input of the later stages when they limit a force.
TEST(ForceFader, what_went_out_in_its_place_is_what_fades)
{
    GuardedTool tool;
    tool.warm_up();
    ToolForce sent;
    sent.push.force_n = 0.25 * GuardedTool::kForce_n;
    tool.sut.follow(sent);
    EXPECT_EQ(tool.step().force_n, GuardedTool::kForce_n) << "without a cause the frame's counts";
    tool.sut.follow(sent);
    tool.input.causes = ForceOff::stale;
    for (int frame = 1; frame <= 50; ++frame)
    {
        const double gain = 1.0 - frame * kPeriod_s / kFadeTime_s;
        EXPECT_LT((tool.step().force_n - gain * sent.push.force_n).norm(), kRounding_n) << frame;
    }
}

TEST(ForceFader, without_a_frame_the_last_force_fades_by_the_same_law)
{
    GuardedTool tool;
    tool.warm_up();
    for (int frame = 1; frame <= 60; ++frame)
    {
        const LetOut out = tool.fade(ForceOff::assertion);
        const double gain = std::max(0.0, 1.0 - frame * kPeriod_s / kFadeTime_s);
        EXPECT_NEAR((out.force_n - gain * GuardedTool::kForce_n).norm(), 0.0, kRounding_n);
        EXPECT_EQ(out.causes, ForceOff::assertion);
    }
    EXPECT_EQ(tool.sut.state(), SafetyState::idle);
}

TEST(ForceFader, makes_no_force_before_the_first_good_sample)
{
    GuardedTool tool;
    tool.input.faults = FrameFault::tool_invalid;
    for (int i = 0; i < 10; ++i)
    {
        EXPECT_EQ(tool.step().state, SafetyState::reset);
        EXPECT_EQ(tool.last.force_n.norm(), 0.0);
    }
    tool.input.faults = FrameFault::none;
    EXPECT_EQ(tool.step().state, SafetyState::force);
    EXPECT_NEAR(tool.last.force_n.norm(), GuardedTool::kForce_n.norm() * kPeriod_s / kRiseTime_s,
                kRounding_n);
}

TEST(ForceFader, a_stall_takes_as_much_of_the_force_as_its_true_time_says)
{
    for (const std::uint32_t periods : {2U, 3U, 10U, 49U, 50U, 1'000U, 4'000'000'000U})
    {
        GuardedTool tool;
        tool.warm_up();
        EXPECT_EQ(tool.step(periods).causes, ForceOff::stall);
        const double gain = std::max(1.0 - periods * kPeriod_s / kFadeTime_s, 0.0);
        EXPECT_NEAR(tool.sut.gain(), gain, 1e-12) << periods;
        EXPECT_NEAR((tool.last.force_n - gain * GuardedTool::kForce_n).norm(), 0.0, kRounding_n);
        EXPECT_EQ(tool.step().causes, ForceOff::none);
        EXPECT_NEAR(tool.sut.gain(), std::min(gain + kPeriod_s / kRiseTime_s, 1.0), 1e-12);
    }
}

TEST(ForceFader, goes_on_from_what_the_device_has_left_of_the_force)
{
    GuardedTool tool;
    tool.warm_up();
    tool.input.force_left = 0.7;
    EXPECT_EQ(tool.step().causes, ForceOff::watchdog);
    EXPECT_NEAR(tool.sut.gain(), 0.7, 1e-12);
    tool.input.force_left = 0.999; // The force's own decrease is steeper.
    tool.step();
    EXPECT_NEAR(tool.sut.gain(), 0.7 - kPeriod_s / kFadeTime_s, 1e-12);
    tool.input.force_left = 1.0;
    EXPECT_EQ(tool.step().causes, ForceOff::none);
    EXPECT_GT(tool.sut.gain(), 0.7 - kPeriod_s / kFadeTime_s);
}

TEST(ForceFader, a_force_that_the_device_has_dropped_starts_again_from_zero)
{
    GuardedTool tool;
    tool.warm_up();
    tool.input.force_left = 0.0;
    EXPECT_EQ(tool.step().causes, ForceOff::watchdog);
    EXPECT_EQ(tool.last.state, SafetyState::idle);
    EXPECT_EQ(tool.last.force_n.norm(), 0.0);
    tool.input.force_left = 1.0;
    Vec3 last_n = tool.last.force_n;
    for (int i = 0; i < 100; ++i)
    {
        EXPECT_EQ(tool.step().state, SafetyState::force);
        EXPECT_LE((tool.last.force_n - last_n).norm(),
                  GuardedTool::kForce_n.norm() * kPeriod_s / kRiseTime_s + kRounding_n);
        last_n = tool.last.force_n;
    }
    EXPECT_NEAR((last_n - GuardedTool::kForce_n).norm(), 0.0, kRounding_n);
}

TEST(ForceFader, does_not_pull_a_hand_that_is_deeper_than_the_device_is_strong)
{
    GuardedTool tool;
    tool.input.stretch_m = 1.01 * kForceMax_n / 500.0;
    for (int i = 0; i < 10; ++i)
    {
        EXPECT_EQ(tool.step().state, SafetyState::idle);
        EXPECT_EQ(tool.last.force_n.norm(), 0.0);
    }
    tool.input.stretch_m = 0.99 * kForceMax_n / 500.0;
    EXPECT_EQ(tool.step().state, SafetyState::force);
    tool.warm_up();
    tool.input.stretch_m = 0.5; // Pressed deeper: the force stays.
    EXPECT_EQ(tool.step().state, SafetyState::force);
}

TEST(ForceFader, a_fast_hand_is_calm_again_at_a_share_of_the_limit)
{
    for (const bool turns : {false, true})
    {
        GuardedTool tool;
        (turns ? tool.input.has_rotation : tool.input.has_velocity) = true;
        const auto is_off_at = [&](double share)
        {
            Vec3& speed = turns ? tool.input.rotation_rad_per_s : tool.input.velocity_m_per_s;
            speed = Vec3(0.0, 0.0, share * (turns ? kRotationMax_rad_per_s : 1.0));
            return tool.step().causes == ForceOff::velocity;
        };
        EXPECT_FALSE(is_off_at(0.99));
        EXPECT_TRUE(is_off_at(1.01));
        EXPECT_TRUE(is_off_at(1.01 * kCalmSpeedShare));
        EXPECT_FALSE(is_off_at(0.99 * kCalmSpeedShare));
        EXPECT_FALSE(is_off_at(0.99));
    }
}

TEST(ForceFader, finds_the_speed_of_a_device_that_does_not_tell_it)
{
    for (const double speed : {0.9, 1.1})
    {
        GuardedTool tool;
        tool.step();
        for (const std::uint32_t periods : {1U, 4U}) // Real time after a stall.
        {
            tool.input.device_m += Vec3(speed * kPeriod_s * periods, 0.0, 0.0);
            EXPECT_EQ(has_cause(tool.step(periods).causes, ForceOff::velocity), speed > 1.0);
        }
    }
    // A slow device repeats its sample: the hand neither rests nor jumps meanwhile.
    GuardedTool tool;
    tool.step();
    for (int i = 0; i < 12; ++i)
    {
        if (i % 4 == 3)
        {
            tool.input.device_m += Vec3(0.9 * 4 * kPeriod_s, 0.0, 0.0);
        }
        else
        {
            tool.input.sample_time_ns -= 1'000'000;
        }
        EXPECT_EQ(tool.step().causes, ForceOff::none) << i;
    }
}

TEST(ForceFader, damps_the_motion_while_it_fades_and_not_at_either_end)
{
    GuardedTool tool;
    tool.input.force_n.setZero();
    tool.input.has_velocity = true;
    tool.input.velocity_m_per_s = Vec3(0.8, 0.0, 0.0);
    tool.steps(200);
    EXPECT_EQ(tool.last.force_n.norm(), 0.0);
    tool.input.causes = ForceOff::deadman;
    double most_n = 0.0;
    for (int i = 0; i < 60; ++i)
    {
        EXPECT_LE(tool.step().force_n.x(), 0.0);
        EXPECT_EQ(tool.last.force_n.tail<2>().norm(), 0.0);
        most_n = std::max(most_n, -tool.last.force_n.x());
    }
    EXPECT_NEAR(most_n, 0.5 * 0.8, 1e-12);
    EXPECT_EQ(tool.last.force_n.norm(), 0.0);
}

TEST(ForceFader, damps_nothing_on_the_way_back_where_nothing_is_felt)
{
    for (const bool is_touching : {false, true})
    {
        GuardedTool tool;
        tool.input.force_n = is_touching ? GuardedTool::kForce_n : Vec3(0.0, 0.0, 0.0);
        tool.input.has_velocity = true;
        tool.input.velocity_m_per_s = Vec3(0.8, 0.0, 0.0);
        tool.steps(200);
        tool.input.causes = ForceOff::deadman;
        tool.steps(60);
        tool.input.causes = ForceOff::none;
        double most_n = 0.0;
        for (int i = 0; i < 100; ++i)
        {
            const Vec3 way_back_n = tool.step().force_n - tool.sut.gain() * tool.input.force_n;
            most_n = std::max(most_n, way_back_n.norm());
        }
        EXPECT_GE(most_n, is_touching ? 0.9 * 0.5 * 0.8 : 0.0);
        EXPECT_LE(most_n, is_touching ? 0.5 * 0.8 + kRounding_n : 0.0);
    }
}

/// Random causes at any time and of any length, with stalls, and a varying force: the header's law
/// holds in every frame. The hand rests, so nothing is damped.
TEST(ForceFader, never_steps_farther_than_its_law)
{
    Random random(71);
    GuardedTool tool;
    const Cause* cause = nullptr;
    Vec3 frame_n = tool.input.force_n;
    std::array<int, kSafetyStates> seen{};
    for (int frame = 0; frame < 200'000; ++frame)
    {
        if (random.one_in(40))
        {
            if (cause != nullptr)
            {
                cause->end(tool.input);
            }
            const Cause& next = kCauses[random.below(std::size(kCauses))];
            cause = next.cause == ForceOff::velocity || random.one_in(2) ? nullptr : &next;
        }
        const Vec3 last_frame_n = frame_n;
        frame_n = Vec3(0.95 * frame_n + random.in_cube(0.2));
        tool.input.force_n = frame_n;
        if (cause != nullptr)
        {
            cause->begin(tool.input);
        }
        const Vec3 before_n = tool.last.force_n;
        const bool was_whole = tool.sut.gain() >= 1.0;
        const std::uint32_t periods = random.one_in(50) ? 1 + random.below(8U) : 1;
        const LetOut out = tool.step(periods);
        const double step_n = (out.force_n - before_n).norm();
        const double elapsed_s = kPeriod_s * periods;
        ++seen[static_cast<std::size_t>(out.state)];
        ASSERT_LE(out.force_n.norm(), kForceMax_n + kRounding_n) << frame;
        if (out.causes == ForceOff::none)
        {
            const double own_n = was_whole ? (frame_n - last_frame_n).norm() : 0.0;
            ASSERT_LE(step_n, 2.0 * kForceMax_n * elapsed_s / kRiseTime_s + own_n + kRounding_n)
                << frame;
            continue;
        }
        ASSERT_LE(step_n, kForceMax_n * elapsed_s / kFadeTime_s + kRounding_n) << frame;
        ASSERT_LE(out.force_n.norm(), before_n.norm() + kRounding_n) << frame;
        ASSERT_NEAR(out.force_n.cross(before_n).norm(), 0.0, 1e-6) << frame; // Straight to zero.
    }
    EXPECT_TRUE(std::ranges::none_of(seen, [](int count) { return count < 1'000; }));
}

} // namespace

} // namespace tactus::test
