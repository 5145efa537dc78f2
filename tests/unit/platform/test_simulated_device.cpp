// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/simulated_device.hpp"
#include "platform/devices/simulated/simulated_periodic_timer.hpp"
#include "tests/unit/platform/device_rig.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace tactus
{
namespace
{

/// Hand that rests at the origin, jumps to `target` in the first frame and stays.
std::unique_ptr<OperatorMotion> operator_that_jumps(const Vec3& target = Vec3::Zero())
{
    return std::make_unique<test::OperatorByLaw>([=](double) { return target; });
}

std::unique_ptr<SimulatedDevice> make(const SimulatedDeviceOptions& options,
                                      std::unique_ptr<OperatorMotion> hand)
{
    return std::move(SimulatedDevice::create(options, std::move(hand))).value();
}

std::string refusal(const SimulatedDeviceOptions& options)
{
    const auto made = SimulatedDevice::create(options, operator_that_jumps());
    return made ? std::string() : made.error().text;
}

/// Compliance of arm and grip of the default hand in series.
constexpr double kArmAndGrip_m_per_n = 1.0 / 200.0 + 1.0 / 2'000.0;

TEST(SimulatedDevice, settles_where_springs_and_force_balance)
{
    SimulatedDeviceOptions options;
    auto sut = make(options, operator_that_jumps(Vec3(0.01, 0.02, -0.03)));
    DeviceSample sample;
    for (int i = 0; i < 3'000; ++i)
    {
        sample = sut->read();
        sut->write({{1.0, 0.0, -2.0}, {}, 0.0});
    }
    EXPECT_NEAR(sample.position_world_m[0], 0.01 + kArmAndGrip_m_per_n, 1e-9);
    EXPECT_NEAR(sample.position_world_m[1], 0.02, 1e-9);
    EXPECT_NEAR(sample.position_world_m[2], -0.03 - 2.0 * kArmAndGrip_m_per_n, 1e-9);
}

TEST(SimulatedDevice, a_load_hangs_on_the_hand_until_it_is_carried)
{
    SimulatedDeviceOptions options;
    options.load = {0.1, Vec3(0.02, 0.0, 0.0), Vec3(0.0, 0.0, -1.0)};
    auto sut = make(options, operator_that_jumps());
    const auto settle = [&](const Wrench& wrench)
    {
        DeviceSample sample;
        for (int i = 0; i < 3'000; ++i)
        {
            sample = sut->read();
            sut->write(wrench);
        }
        return sample;
    };
    const double weight_n = 0.1 * 9.80665;
    const DeviceSample hangs = settle({});
    EXPECT_NEAR(hangs.position_world_m[2], -weight_n * kArmAndGrip_m_per_n, 1e-9);
    EXPECT_GT(hangs.rotation_world->at(1), 1e-3) << "x goes down";
    const DeviceSample carried = settle({{0.0, 0.0, weight_n}, {0.0, -0.02 * weight_n, 0.0}, 0.0});
    EXPECT_NEAR(carried.position_world_m[2], 0.0, 1e-9);
    EXPECT_NEAR(carried.rotation_world->at(1), 0.0, 1e-4);
    options.load.mass_kg = -1.0;
    EXPECT_NE(refusal(options).find("mass"), std::string::npos);
}

TEST(SimulatedDevice, trails_a_moving_hand_by_its_own_drag)
{
    SimulatedDeviceOptions options;
    auto sut = make(options, test::operator_along_x(1e-4)); // 0.1 m/s.
    DeviceSample sample;
    for (int i = 0; i <= 3'000; ++i)
    {
        sample = sut->read();
    }
    EXPECT_NEAR(sample.position_world_m[0], 0.3 - 0.1 * 1.0 * kArmAndGrip_m_per_n, 1e-6);
    ASSERT_TRUE(sample.velocity_world_m_per_s.has_value());
    EXPECT_NEAR((*sample.velocity_world_m_per_s)[0], 0.1, 1e-6);
}

TEST(SimulatedDevice, its_brake_drops_a_force_that_is_still_under_way)
{
    SimulatedDeviceOptions options;
    options.device.delay_s = 5e-3;
    auto sut = make(options, operator_that_jumps());
    for (int i = 0; i < 3; ++i)
    {
        static_cast<void>(sut->read());
        sut->write({{5.0, 0.0, 0.0}, {}, 0.0});
    }
    sut->brake();
    for (int i = 0; i < 20; ++i)
    {
        EXPECT_EQ(sut->read().position_world_m[0], 0.0);
    }
}

TEST(SimulatedDevice, repeats_bit_for_bit_and_takes_its_time_from_the_frame)
{
    SimulatedDeviceOptions options;
    options.rate_hz = 3'000; // The period is not a whole number of nanoseconds.
    auto one = make(options, test::operator_along_x(1e-5));
    auto two = make(options, test::operator_along_x(1e-5));
    for (std::int64_t i = 0; i <= 3'000; ++i)
    {
        const DeviceSample a = one->read();
        const DeviceSample b = two->read();
        ASSERT_EQ(a.position_world_m, b.position_world_m);
        ASSERT_EQ(*a.velocity_world_m_per_s, *b.velocity_world_m_per_s);
        EXPECT_EQ(a.time.ns, i * 1'000'000'000 / 3'000);
        one->write({{0.3, 0.1 * std::sqrt(static_cast<double>(i)), 0.0}, {}, 0.0});
        two->write({{0.3, 0.1 * std::sqrt(static_cast<double>(i)), 0.0}, {}, 0.0});
    }
}

TEST(SimulatedDevice, accepts_both_ends_of_its_rates_and_refuses_what_lies_beyond)
{
    SimulatedDeviceOptions options;
    for (const std::int64_t rate : {100, 10'000})
    {
        options.rate_hz = rate;
        EXPECT_EQ(refusal(options), "");
    }
    for (const std::int64_t rate : {-1, 0, 99, 10'001})
    {
        options.rate_hz = rate;
        EXPECT_NE(refusal(options).find("100..10000 Hz"), std::string::npos);
    }
}

TEST(SimulatedDevice, refuses_values_that_make_no_device)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    for (double DeviceLimits::*member :
         {&DeviceLimits::mass_kg, &DeviceLimits::force_max_n, &DeviceLimits::slew_max_n_per_s,
          &DeviceLimits::stiffness_max_n_per_m})
    {
        for (const double bad : {0.0, -1.0, nan, infinite})
        {
            SimulatedDeviceOptions options;
            options.device.*member = bad;
            EXPECT_NE(refusal(options).find("above zero"), std::string::npos);
        }
    }
    for (double DeviceLimits::*member :
         {&DeviceLimits::damping_n_s_per_m, &DeviceLimits::friction_n, &DeviceLimits::quantum_m,
          &DeviceLimits::delay_s, &DeviceLimits::added_damping_max_n_s_per_m})
    {
        for (const double bad : {-1.0, nan, infinite})
        {
            SimulatedDeviceOptions options;
            options.device.*member = bad;
            EXPECT_NE(refusal(options).find("not negative"), std::string::npos);
        }
    }
    SimulatedDeviceOptions options;
    options.hand.damping_n_s_per_m = -1.0;
    EXPECT_NE(refusal(options).find("not negative"), std::string::npos);
    options = {};
    options.brake_damping_n_s_per_m = nan;
    EXPECT_NE(refusal(options).find("brake"), std::string::npos);
    options = {};
    options.workspace_radius_m = 0.0;
    EXPECT_NE(refusal(options).find("radius is 0.0"), std::string::npos);
}

/// Drift after 2 N for half a second and a pause without reads and writes.
double drift_in_a_pause_m(std::optional<Duration> watchdog, Duration pause,
                          std::optional<Duration> brake_after = std::nullopt)
{
    SimulatedClock clock;
    SimulatedDeviceOptions options;
    options.clock = &clock;
    options.watchdog = watchdog;
    options.hand.grip_stiffness_n_per_m = 0.0; // The hand does not hold it.
    options.hand.grip_damping_n_s_per_m = 0.0;
    options.device.damping_n_s_per_m = 7.0; // The device comes to rest soon.
    auto sut = make(options, operator_that_jumps());
    DeviceSample before;
    for (int i = 0; i < 500; ++i)
    {
        before = sut->read();
        sut->write({{2.0, 0.0, 0.0}, {}, 0.0});
        clock.advance(milliseconds(1));
    }
    before = sut->read();
    clock.advance(brake_after.value_or(pause));
    if (brake_after)
    {
        sut->brake();
        clock.advance(pause - *brake_after);
    }
    const DeviceSample after = sut->read();
    EXPECT_EQ((after.time - before.time).ns, pause.ns);
    EXPECT_EQ(after.frame, before.frame + 1);
    return after.position_world_m[0] - before.position_world_m[0];
}

TEST(SimulatedDevice, holds_its_last_force_through_a_pause_unless_a_watchdog_ends_it)
{
    // The hand continues at its final speed, F over the damping, as long as the force.
    const double speed_m_per_s = 2.0 / 7.0;
    const double held_m = drift_in_a_pause_m(std::nullopt, milliseconds(100));
    EXPECT_NEAR(held_m, 0.1 * speed_m_per_s, 1e-5);
    // The hand then comes to rest by itself, in m / b seconds of the same speed.
    const double coasting_m = 0.1 / 7.0 * speed_m_per_s;
    EXPECT_NEAR(drift_in_a_pause_m(milliseconds(20), milliseconds(100)),
                0.019 * speed_m_per_s + coasting_m, 2e-4);
    EXPECT_LT(drift_in_a_pause_m(std::nullopt, milliseconds(100), milliseconds(20)),
              0.02 * speed_m_per_s + coasting_m);
    EXPECT_GT(drift_in_a_pause_m(std::nullopt, milliseconds(100), milliseconds(20)),
              0.02 * speed_m_per_s);
}

TEST(SimulatedDevice, tells_that_its_watchdog_has_ended_the_force_until_the_next_write)
{
    SimulatedClock clock;
    SimulatedDeviceOptions options;
    options.clock = &clock;
    options.watchdog = milliseconds(5);
    auto sut = make(options, operator_that_jumps());
    static_cast<void>(sut->read());
    sut->write({{1.0, 0.0, 0.0}, {}, 0.0});
    clock.advance(milliseconds(5) - nanoseconds(1));
    EXPECT_EQ(sut->status().state, DeviceState::force);
    EXPECT_EQ(sut->felt_force_world_n(), Vec3(1.0, 0.0, 0.0));
    clock.advance(nanoseconds(1));
    EXPECT_EQ(sut->status().state, DeviceState::idle);
    EXPECT_EQ(sut->felt_force_world_n(), Vec3(Vec3::Zero()));
    sut->write({{0.5, 0.0, 0.0}, {}, 0.0});
    EXPECT_EQ(sut->status().state, DeviceState::force);
    EXPECT_EQ(sut->felt_force_world_n(), Vec3(0.5, 0.0, 0.0));
}

TEST(SimulatedDevice, with_a_clock_counts_true_periods_and_catches_up_on_one_second_at_most)
{
    SimulatedClock clock(MonotonicTime{123});
    SimulatedDeviceOptions options;
    options.rate_hz = 3'000;
    options.clock = &clock;
    auto sut = make(options, operator_that_jumps());
    EXPECT_EQ(sut->read().time.ns, 0);
    EXPECT_EQ(sut->read().time.ns, 333'333); // Every reading is one period, however early.
    clock.advance(milliseconds(10));
    EXPECT_EQ(sut->read().time.ns, 10'000'000);
    clock.advance(milliseconds(3'600'000));
    EXPECT_EQ(sut->read().time.ns, 1'010'000'000);
}

TEST(SimulatedDevice, refuses_a_watchdog_without_a_clock_or_without_a_time)
{
    const SimulatedClock clock;
    SimulatedDeviceOptions options;
    options.watchdog = milliseconds(5);
    EXPECT_NE(refusal(options).find("watchdog"), std::string::npos);
    options.clock = &clock;
    EXPECT_EQ(refusal(options), "");
    options.watchdog = Duration{};
    EXPECT_NE(refusal(options).find("watchdog"), std::string::npos);
    options.watchdog.reset();
    options.speed_max_m_per_s = 0.0;
    EXPECT_NE(refusal(options).find("speed"), std::string::npos);
}

constexpr Duration kTick = milliseconds(1);
constexpr Duration kTickMargin = microseconds(100);

Cycle next(PeriodicTimer& timer)
{
    timer.sleep_until_margin();
    return timer.spin_until_deadline();
}

TEST(SimulatedPeriodicTimer, starts_every_frame_on_the_nanosecond_while_nothing_is_late)
{
    SimulatedClock clock(MonotonicTime{77});
    SimulatedPeriodicTimer sut(clock);
    ASSERT_TRUE(sut.start(kTick, kTickMargin));
    for (std::int64_t i = 1; i <= 1'000; ++i)
    {
        const Cycle cycle = next(sut);
        EXPECT_EQ(cycle.deadline.ns, 77 + i * 1'000'000);
        EXPECT_EQ(clock.now(), cycle.deadline);
        EXPECT_EQ(cycle.wake_lateness, Duration{});
        EXPECT_EQ(cycle.periods, 1U);
    }
    EXPECT_EQ(sut.counts().missed_periods, 0U);
}

TEST(SimulatedPeriodicTimer, runs_a_frame_at_once_that_is_less_than_a_period_late)
{
    const std::array script{LateWake{1, microseconds(400)}};
    SimulatedClock clock;
    SimulatedPeriodicTimer sut(clock, script);
    ASSERT_TRUE(sut.start(kTick, kTickMargin));
    static_cast<void>(next(sut));
    const Cycle late = next(sut);
    EXPECT_EQ(late.wake_lateness, microseconds(400));
    EXPECT_EQ(late.start_lateness, microseconds(300));
    EXPECT_EQ(late.periods, 1U);
    EXPECT_EQ(next(sut).start_lateness, Duration{}); // The grid is unchanged.
}

TEST(SimulatedPeriodicTimer, moves_to_the_next_grid_point_after_a_late_wake_of_many_periods)
{
    const std::array script{LateWake{1, microseconds(53'700)}};
    SimulatedClock clock;
    SimulatedPeriodicTimer sut(clock, script);
    ASSERT_TRUE(sut.start(kTick, kTickMargin));
    static_cast<void>(next(sut));
    const Cycle late = next(sut); // Due at 2 ms, woken at 55.6 ms.
    EXPECT_EQ(late.deadline.ns, 56'000'000);
    EXPECT_EQ(late.periods, 55U);
    EXPECT_EQ(late.wake_lateness, microseconds(53'700));
    EXPECT_EQ(late.start_lateness, Duration{});
    EXPECT_EQ(sut.counts().missed_periods, 54U);
    EXPECT_EQ(sut.counts().episodes, 1U);
    EXPECT_EQ(next(sut).periods, 1U);
}

TEST(SimulatedPeriodicTimer, sleeps_again_after_a_stall_and_never_without_time)
{
    SimulatedClock clock;
    // The second cycle's sleep ends late, and so does the one to the new grid point.
    const std::array script{LateWake{1, microseconds(5'300)}, LateWake{2, microseconds(7'300)}};
    SimulatedPeriodicTimer sut(clock, script);
    int sleeps = 0;
    sut.set_meanwhile([&sleeps] { ++sleeps; });
    const auto sleeps_of_next = [&]
    {
        const int before = sleeps;
        static_cast<void>(next(sut));
        return sleeps - before;
    };
    ASSERT_TRUE(sut.start(kTick, kTickMargin));
    EXPECT_EQ(sleeps_of_next(), 1);
    EXPECT_EQ(sleeps_of_next(), 3);
    EXPECT_EQ(sleeps_of_next(), 1);
    clock.advance(microseconds(1'500)); // Past the margin: no time to sleep.
    EXPECT_EQ(sleeps_of_next(), 0);
}

TEST(SimulatedPeriodicTimer, treats_a_frame_of_exactly_two_periods_as_one_lost)
{
    SimulatedClock clock;
    SimulatedPeriodicTimer sut(clock);
    ASSERT_TRUE(sut.start(kTick, kTickMargin));
    static_cast<void>(next(sut)); // Cycle at 1 ms.
    clock.advance(milliseconds(2));
    const Cycle cycle = next(sut);
    EXPECT_EQ(cycle.deadline.ns, 4'000'000);
    EXPECT_EQ(cycle.periods, 3U);
}

TEST(SimulatedClock, moves_only_when_told_to)
{
    SimulatedClock sut(MonotonicTime{10});
    EXPECT_EQ(sut.now().ns, 10);
    sut.advance_to(MonotonicTime{5});
    EXPECT_EQ(sut.now().ns, 10);
    const WallTime wall = sut.wall_now();
    sut.advance(nanoseconds(7));
    EXPECT_EQ(sut.now().ns, 17);
    EXPECT_EQ(sut.wall_now().ns - wall.ns, 7);
}

} // namespace
} // namespace tactus
