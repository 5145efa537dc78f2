// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/assert.hpp"
#include "rt_core/limits.hpp"
#include "tests/unit/hrtc/loop_rig.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <string>
#include <thread>

namespace tactus::hrtc::test
{
namespace
{

constexpr std::uint64_t kFadeFrames = 51; ///< kFadeTime_s, and one for rounding.
constexpr std::uint64_t kBadFrames = 100; ///< Frames that a cause lasts.

bool is_bad(std::uint64_t frame)
{
    return frame >= kSettled && frame < kSettled + kBadFrames;
}

/// Options that act in the frame in which the force has settled.
LoopRigOptions when_settled(void (*act)(LoopRig&))
{
    return {.meanwhile = [act](LoopRig& rig, std::uint64_t frame)
            { frame == kSettled ? act(rig) : void(); }};
}

/// Change of the device's readings, with the loop's expected reaction.
struct Trouble
{
    const char* name;
    ForceOff cause;
    std::uint64_t notice; ///< Frames until it can be detected.
    void (*tamper)(std::uint64_t frame, DeviceSample& sample);
    std::vector<DeviceFault> faults{};     ///< Faults of the device, from kSettled for kBadFrames.
    SafetyState state{SafetyState::brake}; ///< First state that follows.
};

void PrintTo(const Trouble& trouble, std::ostream* out)
{
    *out << trouble.name;
}

void leave(std::uint64_t /*frame*/, DeviceSample& /*sample*/) {}

const Trouble kTroubles[] = {
    {"disconnected", ForceOff::disconnect, 0,
     [](std::uint64_t frame, DeviceSample& sample) { sample.connected = !is_bad(frame); }},
    {"let_go", ForceOff::deadman, 0,
     [](std::uint64_t frame, DeviceSample& sample) { sample.deadman_held = !is_bad(frame); }},
    {"invalid", ForceOff::garbage, 0,
     [](std::uint64_t frame, DeviceSample& sample) { sample.valid = !is_bad(frame); }},
    {"no_number", ForceOff::garbage, 0,
     [](std::uint64_t frame, DeviceSample& sample)
     {
         sample.position_world_m[1] =
             is_bad(frame) ? std::numeric_limits<double>::quiet_NaN() : sample.position_world_m[1];
     }},
    {"elsewhere", ForceOff::garbage, 0,
     [](std::uint64_t frame, DeviceSample& sample)
     { sample.position_world_m[0] += is_bad(frame) ? 3.0 : 0.0; }},
    {"stuck", ForceOff::stale, 20,
     [](std::uint64_t frame, DeviceSample& sample)
     { sample.time.ns = is_bad(frame) ? milliseconds(kSettled - 1).ns : sample.time.ns; }},
    {"too_fast", ForceOff::velocity, 0,
     [](std::uint64_t frame, DeviceSample& sample)
     { (*sample.velocity_world_m_per_s)[1] += is_bad(frame) ? 11.0 : 0.0; }},
    {"device_drops_out",
     ForceOff::garbage,
     0,
     leave,
     {{DeviceFaultKind::dropout, kSettled, kBadFrames}}},
    {"device_says_nan",
     ForceOff::garbage,
     0,
     leave,
     {{DeviceFaultKind::nan, kSettled, kBadFrames}}},
    {"device_disconnects",
     ForceOff::disconnect,
     0,
     leave,
     {{DeviceFaultKind::disconnect, kSettled, kBadFrames}},
     SafetyState::reset}, // Nothing fades: an absent device makes no force.
};

/// Troubles of a 6-DoF device with a rigid tool.
const Trouble kRotationTroubles[] = {
    {"no_rotation", ForceOff::garbage, 0,
     [](std::uint64_t frame, DeviceSample& sample)
     {
         (*sample.rotation_world)[2] =
             is_bad(frame) ? std::numeric_limits<double>::quiet_NaN() : (*sample.rotation_world)[2];
     }},
    {"turned_wildly", ForceOff::garbage, 0,
     [](std::uint64_t frame, DeviceSample& sample)
     {
         // Rotation by 1.1 rad about z in every other frame, as of encoders that lose their
         // position.
         if (is_bad(frame) && frame % 2 == 0)
         {
             const double half_sine = 0.5226872289306592;
             const double half_cosine = 0.8525245220595057;
             const auto [x, y, z, w] = *sample.rotation_world;
             sample.rotation_world = {
                 half_cosine * x - half_sine * y, half_cosine * y + half_sine * x,
                 half_cosine * z + half_sine * w, half_cosine * w - half_sine * z};
         }
     }},
    {"turns_too_fast", ForceOff::velocity, 0,
     [](std::uint64_t frame, DeviceSample& sample)
     { (*sample.angular_velocity_world_rad_per_s)[1] += is_bad(frame) ? 70.0 : 0.0; }},
};

/// Pressed off its middle, so that the surface rotates it.
LoopRigOptions with_a_lever(const Trouble& trouble)
{
    return {.tamper = trouble.tamper,
            .faults = trouble.faults,
            .core = Segment{Vec3(0.0, 0.008, 0.0), Vec3(0.0, 0.01, 0.0)},
            .angular_stiffness_nm_per_rad = 0.5};
}

/// Written forces or torques, with their normal changes.
struct Course
{
    const std::vector<Vec3>& written;
    double own_step;      ///< Change between frames without disturbance.
    double damping;       ///< Damping of the hand that sinks into the wall while the force fades.
    double back_step_max; ///< Greatest change during the return.
    double off;           ///< Final deviation as a share of the value before.
};

/// Expects a linear fade from the frame in which the trouble can be detected, and a ramp back.
void expect_to_fade_and_return(const Course& course, std::uint64_t known)
{
    const double before = course.written[kSettled - 1].norm();
    for (std::uint64_t frame = known; frame < kSettled + kBadFrames; ++frame)
    {
        const double left = 1.0 - static_cast<double>(frame - known + 1) * kPeriod_s / kFadeTime_s;
        const double most =
            frame >= known + kFadeFrames
                ? 0.0
                : std::max(left, 0.0) * (before + course.own_step) + course.damping + kRounding_n;
        EXPECT_LE(course.written[frame].norm(), most) << frame;
    }
    EXPECT_LE(LoopRig::largest_step(course.written, kSettled + kBadFrames, 1'900),
              course.back_step_max);
    EXPECT_NEAR(course.written[1'900].norm(), before, course.off * before);
}

using HapticLoopTrouble = testing::TestWithParam<Trouble>;
using HapticLoopTorqueTrouble = HapticLoopTrouble;

const auto kByName = [](const auto& test) { return std::string(test.param.name); };
INSTANTIATE_TEST_SUITE_P(Each, HapticLoopTrouble, testing::ValuesIn(kTroubles), kByName);
INSTANTIATE_TEST_SUITE_P(Each, HapticLoopTorqueTrouble, testing::ValuesIn(kTroubles), kByName);
INSTANTIATE_TEST_SUITE_P(Turning, HapticLoopTorqueTrouble, testing::ValuesIn(kRotationTroubles),
                         kByName);

TEST_P(HapticLoopTrouble, fades_the_force_within_two_periods_and_brings_it_back_by_the_ramp)
{
    LoopRig rig({.tamper = GetParam().tamper, .faults = GetParam().faults});
    rig.run();
    const std::uint64_t known = kSettled + GetParam().notice;
    const double before_n = rig.written_n(kSettled - 1).norm();
    ASSERT_GT(before_n, 1.0);
    // The hand is slower than 0.3 m/s.
    const double damping_n =
        GetParam().cause == ForceOff::velocity ? 8.0 * kDampingForceShare : 0.5 * 0.3;
    EXPECT_LT(rig.written_n(known + 1).norm(), 0.97 * before_n + 4.0 * 0.04 * 0.96 * damping_n);
    expect_to_fade_and_return({rig.device().written_n, kOwnStep_n, damping_n, kBackStep_n, 0.05},
                              known);

    const std::vector<SafetyEvent> events = rig.events();
    const auto noted = std::ranges::find_if(events, [](const SafetyEvent& event)
                                            { return has_cause(event.causes, GetParam().cause); });
    ASSERT_NE(noted, events.end());
    EXPECT_LE(noted->frame, known + 1);
    EXPECT_EQ(noted->state, GetParam().state);
    const SafetyState left =
        GetParam().cause == ForceOff::disconnect ? SafetyState::reset : SafetyState::idle;
    EXPECT_TRUE(std::ranges::any_of(events, [&](const SafetyEvent& event)
                                    { return event.state == left && event.frame > known; }));
}

TEST_P(HapticLoopTorqueTrouble, fades_the_torque_as_the_force_and_brings_it_back)
{
    LoopRig rig(with_a_lever(GetParam()));
    rig.run();
    const std::uint64_t known = kSettled + GetParam().notice;
    ASSERT_GT(rig.written_nm(kSettled - 1).norm(), 1e-3);
    const double own_step_nm = rig.largest_step_nm(kSettled - 200, kSettled - 1);
    const double torque_max_nm = rig.device().info().limits.rotation.torque_max_nm;
    expect_to_fade_and_return({rig.device().written_nm, own_step_nm, 0.0,
                               2.0 * torque_max_nm * kPeriod_s / kRiseTime_s + own_step_nm, 0.1},
                              known);
    for (std::uint64_t frame = known + kFadeFrames; frame < kSettled + kBadFrames; ++frame)
    {
        EXPECT_EQ(rig.written_n(frame).norm(), 0.0) << frame;
    }
    const std::vector<SafetyEvent> events = rig.events();
    EXPECT_TRUE(std::ranges::any_of(
        events, [&](const SafetyEvent& event)
        { return event.frame <= known + 1 && has_cause(event.causes, GetParam().cause); }));
}

/// Causes of the events after the first one, to the run's end.
std::vector<ForceOff> causes_of(LoopRig& rig)
{
    std::vector<ForceOff> causes;
    for (const SafetyEvent& event : rig.events())
    {
        if (event.frame > 0 && event.causes != ForceOff::software)
        {
            causes.push_back(event.causes);
        }
    }
    return causes;
}

TEST(HapticLoop, a_jittering_device_keeps_its_force_with_no_more_than_the_noise_in_it)
{
    LoopRigOptions options;
    options.faults = {{DeviceFaultKind::jitter, kSettled, 900}};
    LoopRig rig(options);
    rig.run();
    const double before_n = rig.written_n(kSettled - 1).norm();
    const double noise_n = std::sqrt(3.0) * FaultyDevice::kJitter_m * options.stiffness_n_per_m;
    EXPECT_GT(rig.largest_step_n(kSettled, 1'900), 0.1 * noise_n);
    EXPECT_LT(rig.largest_step_n(kSettled - 1, 1'900), 2.0 * noise_n + kOwnStep_n);
    for (std::uint64_t frame = kSettled; frame < 1'900; ++frame)
    {
        EXPECT_NEAR(rig.written_n(frame).norm(), before_n, noise_n + kOwnStep_n) << frame;
    }
    EXPECT_EQ(causes_of(rig), std::vector<ForceOff>{});
}

TEST(HapticLoop, time_that_falls_back_ends_the_force_until_the_clock_is_believed_again)
{
    LoopRig rig({.faults = {{DeviceFaultKind::time_jump, kSettled - 200, 200}}});
    rig.run();
    // The clock may jump ahead, since samples may be lost.
    const double before_n = rig.written_n(kSettled - 1).norm();
    EXPECT_GT(before_n, 1.0);
    EXPECT_LE(rig.largest_step_n(kSettled - 202, kSettled - 1), kOwnStep_n);
    EXPECT_LT(rig.written_n(kSettled + 1).norm(), 0.99 * before_n);
    EXPECT_EQ(rig.written_n(kSettled + kFadeFrames).norm(), 0.0);
    EXPECT_LE(rig.largest_step_n(kSettled - 1, 1'900), kBackStep_n);
    EXPECT_NEAR(rig.written_n(1'900).norm(), before_n, 0.05 * before_n);
    const std::vector<ForceOff> causes = causes_of(rig);
    ASSERT_FALSE(causes.empty());
    EXPECT_EQ(causes.front(), ForceOff::garbage);
}

TEST(HapticLoop, encoders_that_were_stuck_come_back_as_a_hand_that_is_too_fast)
{
    // The hand is in free air, has just begun to press, or is at the bottom.
    const double damping_n = 8.0 * kDampingForceShare; // Greatest damping, against that speed.
    for (const std::uint64_t begin : {100U, 300U, 400U})
    {
        LoopRig rig({.faults = {{DeviceFaultKind::stuck, begin, kSettled - begin}},
                     .speed_max_m_per_s = 1.0});
        rig.run();
        LoopRig whole({});
        whole.run();
        EXPECT_LE(rig.largest_step_n(begin, kSettled - 1), kOwnStep_n) << begin;
        EXPECT_LT(rig.written_n(kSettled - 1).norm(), 0.8 * whole.written_n(1'900).norm()) << begin;
        EXPECT_LE(rig.largest_step_n(kSettled - 1, 1'900), kBackStep_n + damping_n) << begin;
        EXPECT_NEAR(rig.written_n(1'900).norm(), whole.written_n(1'900).norm(), 0.1) << begin;
        const std::vector<ForceOff> causes = causes_of(rig);
        ASSERT_FALSE(causes.empty()) << begin;
        EXPECT_EQ(causes.front(), ForceOff::velocity) << begin;
    }
}

TEST(HapticLoop, begins_without_a_force_and_ends_without_one)
{
    LoopRig rig({});
    rig.run();
    ASSERT_EQ(rig.device().written_n.size(), 2'001U);
    EXPECT_EQ(rig.written_n(0).norm(), 0.0);
    EXPECT_GT(rig.written_n(1'900).norm(), 1.0);
    EXPECT_EQ(rig.written_n(1'999).norm(), 0.0);
    EXPECT_LE(rig.largest_step_n(1'900, 2'000), 8.0 * kPeriod_s / kFadeTime_s);
    const std::vector<SafetyEvent> events = rig.events();
    ASSERT_EQ(events.size(), 3U);
    EXPECT_EQ(events[0].state, SafetyState::force);
    EXPECT_EQ(events[1].causes, ForceOff::software);
    EXPECT_EQ(events[2].state, SafetyState::idle);
}

TEST(HapticLoop, fades_the_force_before_it_stops)
{
    LoopRig rig(when_settled([](LoopRig& running) { running.loop().stop(); }));
    rig.run();
    EXPECT_TRUE(rig.loop().is_done());
    const std::uint64_t frames = rig.loop().frames_done();
    EXPECT_GE(frames, kSettled + kFadeFrames - 1);
    EXPECT_LE(frames, kSettled + kFadeFrames + 1);
    EXPECT_EQ(rig.written_n(frames - 1).norm(), 0.0);
    EXPECT_LE(rig.largest_step_n(kSettled, frames - 1), 8.0 * kPeriod_s / kFadeTime_s);
}

TEST(HapticLoop, a_lost_server_ends_the_force_unless_the_model_is_here_as_a_whole)
{
    for (const bool is_static : {false, true})
    {
        LoopRig rig({.meanwhile = [](LoopRig& running, std::uint64_t frame)
                     { running.servers_gone.set(0, is_bad(frame)); },
                     .static_model = is_static});
        rig.run();
        const double before_n = rig.written_n(kSettled - 1).norm();
        const double after_n = rig.written_n(kSettled + kFadeFrames).norm();
        EXPECT_GT(before_n, 1.0);
        EXPECT_EQ(after_n == 0.0, !is_static);
        EXPECT_EQ(std::ranges::count(rig.events(), ForceOff::server, &SafetyEvent::causes) > 0,
                  !is_static);
        EXPECT_LE(rig.largest_step_n(kSettled, 1'900), 8.0 * kPeriod_s / kFadeTime_s);
        EXPECT_NEAR(rig.written_n(1'900).norm(), before_n, 0.05 * before_n);
    }
}

/// A tool rests at the coarse surface of the first model, with the second one nearby.
TEST(HapticLoop, a_piece_that_does_not_come_ends_the_force_where_the_tool_is_at_its_model)
{
    for (const std::uint32_t starved : {0U, 1U})
    {
        LoopRig rig({.frames = kSettled, .is_coarse = true, .neighbour_m = 0.02});
        rig.starved.set(starved, true);
        rig.run();
        EXPECT_GT(rig.statistics().pairs[1].in_all(), 500U);
        EXPECT_GT(rig.statistics().data_limited_frames, 100U);
        const std::vector<SafetyEvent> events = rig.events();
        EXPECT_EQ(LoopRig::has(events, ForceOff::starved), starved == 0) << starved;
    }
}

TEST(HapticLoop, the_first_frame_after_a_stall_counts_its_true_time)
{
    for (const std::int64_t lost : {1, 4, 30, 80})
    {
        LoopRig rig({.late_wakes = {{kSettled, milliseconds(lost)}}});
        rig.run();
        const std::vector<SafetyEvent> events = rig.events();
        const auto noted = std::ranges::find(events, ForceOff::stall, &SafetyEvent::causes);
        ASSERT_NE(noted, events.end()) << lost;
        const double before_n = rig.written_n(noted->frame - 1).norm();
        // The frame's own period, the lost ones, and the rest to the next grid point of the timer.
        const double gain =
            std::max(1.0 - static_cast<double>(lost + 2) * kPeriod_s / kFadeTime_s, 0.0);
        EXPECT_NEAR(rig.written_n(noted->frame).norm(), gain * before_n, kOwnStep_n) << lost;
        EXPECT_LE(rig.largest_step_n(noted->frame, 1'900), kBackStep_n) << lost;
        EXPECT_NEAR(rig.written_n(1'900).norm(), before_n, 0.05 * before_n) << lost;
    }
}

/// Handler like the program's: it never returns.
HapticLoop* failing_loop = nullptr;
LoopRig* failing_rig = nullptr;

void report_and_leave(const char* /*condition*/, const char* /*file*/, int /*line*/) noexcept
{
    failing_loop->fail();
    // Written since the last good frame: a straight line to zero, and then the brake.
    const std::vector<Vec3>& sent = failing_rig->device().written_n;
    const double before_n = sent[kSettled - 1].norm();
    const std::size_t faded = sent.size() - kSettled;
    bool is_straight = before_n > 1.0 && faded == kFadeFrames;
    for (std::size_t i = 0; i < faded; ++i)
    {
        const double left =
            std::max(1.0 - static_cast<double>(i + 1) * kPeriod_s / kFadeTime_s, 0.0);
        is_straight = is_straight && std::abs(sent[kSettled + i].norm() - left * before_n) < 1e-9;
    }
    const bool is_braked = failing_rig->device().status().state == DeviceState::brake;
    const std::vector<SafetyEvent> events = failing_rig->events();
    const bool is_noted =
        std::ranges::count(events, ForceOff::assertion, &SafetyEvent::causes) == 1;
    std::_Exit((is_straight ? 0 : 1) + (is_braked ? 0 : 2) + (is_noted ? 0 : 4) +
               (failing_loop->has_failed() ? 0 : 8) + 40);
}

TEST(HapticLoopDeathTest, an_assertion_on_the_haptic_thread_fades_the_last_force_and_brakes)
{
    LoopRig rig(
        {.tamper = [](std::uint64_t frame, DeviceSample&) { TACTUS_ASSERT(frame < kSettled); }});
    failing_rig = &rig;
    failing_loop = &rig.loop();
    set_assert_handler(report_and_leave);
    EXPECT_EXIT(rig.loop().run(), testing::ExitedWithCode(40), "");
    set_assert_handler(nullptr);
}

TEST(HapticLoop, a_release_that_has_begun_does_not_undo_the_brake_of_a_bug)
{
    // The supervisor brakes; the loop releases it.
    LoopRig rig(when_settled([](LoopRig& running) { running.device().brake(); }));
    rig.device().before_release = [&] { std::thread([&] { rig.loop().fail(); }).join(); };
    rig.run();
    EXPECT_EQ(rig.loop().frames_done(), kSettled + 1);
    EXPECT_EQ(rig.device().status().state, DeviceState::brake);
    EXPECT_EQ(rig.device().felt_n().norm(), 0.0);
}

} // namespace
} // namespace tactus::hrtc::test
