// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/machine.hpp"
#include "platform/loop/supervisor.hpp"
#include "platform/machine/posix/posix_clock.hpp"
#include "platform/machine/posix/posix_periodic_timer.hpp"
#include "rt_core/limits.hpp"
#include "tests/unit/hrtc/loop_rig.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace tactus::hrtc::test
{
namespace
{

constexpr Duration kHang = milliseconds(80); ///< Longer than a soft brake.
constexpr Duration kShortHang = milliseconds(10);
/// Delay of the machine in waking the supervisor.
constexpr Duration kLate = microseconds(50);
constexpr double kStepBack_n = 8.0 * kPeriod_s / kRiseTime_s + kOwnStep_n;

/// Force on the hand while the loop hung in a reading, in steps of 10 us.
struct FeltForce
{
    Duration after; ///< Time since the last beat.
    double force_n{0.0};
};

/// The loop hangs for a while; the supervisor, if any, checks on its own schedule.
struct HangingLoop
{
    HangingLoop(std::optional<Duration> own_watchdog, bool is_supervised, Duration hang = kHang)
        : hang_(hang)
        , rig_(options(own_watchdog, is_supervised))
        , supervisor_({rig_.tools(), &rig_.loop().heartbeat(), &rig_.clock(), nullptr, kPeriod})
    {
        rig_.loop().run();
    }

    [[nodiscard]] LoopRig& rig() { return rig_; }
    [[nodiscard]] Supervisor& supervisor() { return supervisor_; }
    [[nodiscard]] const std::vector<FeltForce>& felt() const { return felt_; }
    /// Time from the last beat to the last force.
    [[nodiscard]] Duration held() const
    {
        Duration last{};
        for (const FeltForce& felt : felt_)
        {
            last = felt.force_n > 0.0 ? felt.after : last;
        }
        return last;
    }

private:
    LoopRigOptions options(std::optional<Duration> own_watchdog, bool is_supervised)
    {
        LoopRigOptions made;
        made.watchdog = own_watchdog;
        made.tamper = [this, is_supervised](std::uint64_t frame, DeviceSample&)
        {
            if (is_supervised)
            {
                static_cast<void>(supervisor_.check()); // A running loop is never braked.
            }
            if (frame == kSettled)
            {
                hang(is_supervised);
            }
        };
        return made;
    }

    void hang(bool is_supervised)
    {
        const MonotonicTime beat = *rig_.loop().heartbeat().last();
        MonotonicTime wake = beat;
        for (SimulatedClock& clock = rig_.virtual_clock(); clock.now() - beat < hang_;
             clock.advance(microseconds(10)))
        {
            if (is_supervised && clock.now() >= wake + kLate)
            {
                wake = supervisor_.check();
            }
            felt_.push_back({clock.now() - beat, rig_.device().felt_n().norm()});
        }
    }

    Duration hang_;
    LoopRig rig_;
    Supervisor supervisor_;
    std::vector<FeltForce> felt_;
};

TEST(Supervisor, fades_a_held_force_from_three_periods_after_the_last_beat_on)
{
    HangingLoop sut(std::nullopt, true);
    const double first_n = sut.felt().front().force_n;
    EXPECT_GT(first_n, 1.0);
    const Duration begin = kPeriod * 3;
    const double step_n = first_n * to_seconds(microseconds(10)) / to_seconds(kBrakeFade);
    double last_n = first_n;
    for (const FeltForce& felt : sut.felt())
    {
        EXPECT_LE(last_n - felt.force_n, step_n + 1e-9) << felt.after.ns; // No jump.
        EXPECT_LE(felt.force_n, last_n);
        last_n = felt.force_n;
    }
    EXPECT_GE(sut.held(), begin + kBrakeFade - microseconds(10));
    EXPECT_LE(sut.held(), begin + kLate + kBrakeFade + microseconds(10));
    EXPECT_EQ(sut.felt().back().force_n, 0.0);
    EXPECT_EQ(sut.supervisor().brakes(), 1U); // One brake for many checks.
    std::vector<SafetyEvent> events;
    sut.supervisor().log().take_into(events);
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].causes, ForceOff::watchdog);
    EXPECT_TRUE(events[0].by_supervisor);
}

TEST(Supervisor, without_it_a_device_that_holds_its_force_holds_it_all_the_time)
{
    HangingLoop sut(std::nullopt, false);
    EXPECT_GE(sut.held(), kHang - microseconds(10));
    EXPECT_GT(sut.felt().back().force_n, 1.0);
}

TEST(Supervisor, a_device_with_a_watchdog_ends_the_force_by_itself)
{
    for (const bool is_supervised : {false, true})
    {
        HangingLoop sut(milliseconds(2), is_supervised);
        EXPECT_GT(sut.felt().front().force_n, 1.0); // The last write was a period before the beat.
        EXPECT_LE(sut.held(), milliseconds(2) - kPeriod);
        EXPECT_GE(sut.held(), milliseconds(2) - kPeriod - microseconds(10));
        EXPECT_EQ(sut.supervisor().brakes(), is_supervised ? 1U : 0U);
    }
}

TEST(Supervisor, a_loop_that_comes_back_fades_its_force_in_from_zero)
{
    for (const auto& [watchdog, is_supervised] : {std::pair(std::optional<Duration>(), true),
                                                  std::pair(std::optional(milliseconds(2)), false)})
    {
        HangingLoop sut(watchdog, is_supervised);
        LoopRig& rig = sut.rig();
        const double before_n = rig.written_n(kSettled - 1).norm();
        EXPECT_EQ(rig.written_n(kSettled).norm(), 0.0);
        EXPECT_LE(rig.largest_step_n(kSettled, 1'900), kStepBack_n);
        EXPECT_NEAR(rig.written_n(1'900).norm(), before_n, 0.05 * before_n);
        const std::vector<SafetyEvent> events = rig.events();
        EXPECT_TRUE(std::ranges::any_of(events,
                                        [](const SafetyEvent& event)
                                        {
                                            return event.frame == kSettled &&
                                                   has_cause(event.causes, ForceOff::watchdog) &&
                                                   event.state == SafetyState::idle;
                                        }));
    }
}

TEST(Supervisor, a_loop_that_comes_back_during_the_fade_goes_on_from_there)
{
    HangingLoop sut(std::nullopt, true, kShortHang);
    LoopRig& rig = sut.rig();
    const double before_n = rig.written_n(kSettled - 1).norm();
    const double felt_n = sut.felt().back().force_n;
    EXPECT_LT(felt_n, 0.9 * before_n);
    EXPECT_GT(felt_n, 0.8 * before_n);
    EXPECT_NEAR(rig.written_n(kSettled).norm(), felt_n, 0.02 * before_n + kOwnStep_n);
    // The stall is then an ordinary one.
    EXPECT_GT(rig.written_n(kSettled + 1).norm(), 0.5 * before_n);
    EXPECT_LE(rig.largest_step_n(kSettled + 2, 1'900), kStepBack_n);
    EXPECT_NEAR(rig.written_n(1'900).norm(), before_n, 0.05 * before_n);
}

/// A device whose own thread hangs too does not fade: brake() is called when the fade should be
/// over.
TEST(Supervisor, brakes_at_once_when_the_fade_should_be_over)
{
    struct Deaf final : public WrappedDevice
    {
        using WrappedDevice::WrappedDevice;
        void brake() noexcept override { ++brakes; }
        void brake_softly() noexcept override { ++soft_brakes; }
        int brakes{0};
        int soft_brakes{0};
    };
    SimulatedClock clock;
    Heartbeat heartbeat;
    std::vector<ToolSetup> tools(1);
    auto device =
        SimulatedDevice::create({}, std::make_unique<PressingOperator>(
                                        Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0), 0.1, kPress_m));
    ASSERT_TRUE(device) << device.error().text;
    tools[0].device = std::make_unique<Deaf>(std::move(device).value());
    const auto& deaf = static_cast<const Deaf&>(*tools[0].device);
    Supervisor sut({tools, &heartbeat, &clock, nullptr, kPeriod});
    heartbeat.beat(clock.now());
    clock.advance(kPeriod * 3);
    for (int i = 0; i < 50; ++i)
    {
        EXPECT_EQ(sut.check(), clock.now() + kPeriod);
        EXPECT_EQ(deaf.soft_brakes, 1);
        EXPECT_EQ(deaf.brakes, 0);
        clock.advance(kPeriod);
    }
    static_cast<void>(sut.check());
    EXPECT_EQ(deaf.brakes, 1);
    heartbeat.beat(clock.now()); // The loop is back.
    static_cast<void>(sut.check());
    EXPECT_EQ(deaf.brakes, 1);
}

TEST(Supervisor, looks_when_the_silence_would_be_long_enough)
{
    LoopRig rig({});
    Heartbeat heartbeat;
    Supervisor sut({rig.tools(), &heartbeat, &rig.clock(), nullptr, kPeriod});
    SimulatedClock& clock = rig.virtual_clock();
    EXPECT_EQ(sut.check(), clock.now() + kPeriod * 3); // The loop has not begun.
    clock.advance(milliseconds(100));
    EXPECT_EQ(sut.check(), clock.now() + kPeriod * 3);
    EXPECT_EQ(sut.brakes(), 0U);

    heartbeat.beat(clock.now());
    const MonotonicTime due = sut.check();
    EXPECT_EQ(due, clock.now() + kPeriod * 3);
    clock.advance_to(due - nanoseconds(1));
    EXPECT_EQ(sut.check(), due);
    EXPECT_EQ(sut.brakes(), 0U);
    clock.advance(nanoseconds(1));
    EXPECT_EQ(sut.check(), due + kPeriod);
    EXPECT_EQ(sut.brakes(), 1U);

    heartbeat.beat(clock.now()); // The loop is back, and hangs again.
    clock.advance(kPeriod * 3);
    static_cast<void>(sut.check());
    EXPECT_EQ(sut.brakes(), 2U);
    heartbeat.beat(clock.now());
    heartbeat.rest(); // Regular end.
    clock.advance(kPeriod * 10);
    static_cast<void>(sut.check());
    EXPECT_EQ(sut.brakes(), 2U);
}

TEST(Supervisor, is_as_patient_as_it_is_told_and_more_so_where_the_kernel_promises_nothing)
{
    LoopRig rig({});
    Heartbeat heartbeat;
    Supervisor sut({rig.tools(), &heartbeat, &rig.clock(), nullptr, kPeriod, 10});
    SimulatedClock& clock = rig.virtual_clock();
    heartbeat.beat(clock.now());
    const MonotonicTime due = clock.now() + kPeriod * 10;
    EXPECT_EQ(sut.check(), due);
    clock.advance_to(due - nanoseconds(1));
    EXPECT_EQ(sut.check(), due);
    EXPECT_EQ(sut.brakes(), 0U);
    clock.advance_to(due);
    static_cast<void>(sut.check());
    EXPECT_EQ(sut.brakes(), 1U);

    Machine machine;
    for (const char* preemption : {"PREEMPT_DYNAMIC", "PREEMPT", "none stated"})
    {
        machine.preemption = preemption;
        EXPECT_EQ(silent_periods(machine), 10U);
    }
    machine.preemption = "PREEMPT_RT";
    EXPECT_EQ(silent_periods(machine), 3U);
}

TEST(Supervisor, stands_one_above_the_loop_and_beside_it)
{
    RtThreadOptions loop;
    loop.priority = RtThreadOptions::kPriorityMax;
    const RtThreadOptions free = Supervisor::thread_beside(loop);
    EXPECT_EQ(free.priority, 99);
    EXPECT_FALSE(free.cpu);
    loop.cpu = 0;
    const RtThreadOptions beside = Supervisor::thread_beside(loop);
    EXPECT_NE(beside.cpu, std::optional(0));
}

/// Real threads in real time, without claims about durations.
TEST(Supervisor, brakes_a_device_whose_reading_hangs_and_lets_the_loop_come_back)
{
    const PosixClock clock;
    PosixPeriodicTimer timer;
    PosixPeriodicTimer alarm;
    std::atomic<bool> is_hanging{false};
    std::atomic<bool> may_go_on{false};
    std::atomic<std::uint64_t> brakes_seen{0};
    LoopRigOptions options;
    options.clock = &clock;
    options.timer = &timer;
    options.frames = 1'000'000; // The run ends below.
    options.tamper = [&](std::uint64_t frame, DeviceSample&)
    {
        if (frame == 100)
        {
            is_hanging.store(true);
            is_hanging.notify_one();
            may_go_on.wait(false);
        }
    };
    LoopRig rig(options);
    Supervisor sut({rig.tools(), &rig.loop().heartbeat(), &clock, &alarm, kPeriod});
    RtThreadOptions thread;
    thread.allow_no_rt = true;
    thread.priority = 10;
    auto supervising = RtThread::start(Supervisor::thread_beside(thread), [&] { sut.run(); });
    ASSERT_TRUE(supervising) << supervising.error().text;
    std::thread looping([&] { rig.loop().run(); });

    is_hanging.wait(false);
    const std::uint64_t before = sut.brakes(); // A busy machine may have stalled the loop already.
    while (rig.device().status().state != DeviceState::brake ||
           rig.device().status().force_left > 0.0)
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(rig.device().felt_n().norm(), 0.0);
    brakes_seen.store(sut.brakes());
    may_go_on.store(true);
    may_go_on.notify_one();
    const std::uint64_t frames = rig.loop().frames_done();
    while (rig.loop().frames_done() < frames + 20)
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    rig.loop().stop();
    looping.join();
    sut.stop();
    supervising.value().join();
    EXPECT_GE(sut.brakes(), 1U);
    EXPECT_LE(before, brakes_seen.load());
    EXPECT_NE(rig.device().status().state, DeviceState::brake); // The brake was released.
    // A loop that a busy machine stalled earlier is already braked and logs no change.
    EXPECT_TRUE(std::ranges::any_of(
        rig.events(), [](const SafetyEvent& event)
        { return event.frame <= 100 && has_cause(event.causes, ForceOff::watchdog); }));
}

} // namespace
} // namespace tactus::hrtc::test
