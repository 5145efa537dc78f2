// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/passivity_observer.hpp"
#include "rt_core/force/velocity_window.hpp"
#include "tests/shared/period.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>

namespace tactus::test
{

namespace
{

DeviceLimits lossless()
{
    DeviceLimits device;
    device.damping_n_s_per_m = 0.0;
    device.added_damping_max_n_s_per_m = 5.0;
    return device;
}

double quantised(double value, double quantum)
{
    return std::floor(value / quantum + 0.5) * quantum;
}

} // namespace

TEST(SentForces, are_at_the_device_at_once_without_delay)
{
    SentForces sut(0.0);
    EXPECT_EQ(sut.mean_since(1), Vec3(0, 0, 0));
    sut.send(Vec3(1, 2, 3));
    EXPECT_EQ(sut.mean_since(1), Vec3(1, 2, 3));
    sut.send(Vec3(4, 5, 6));
    EXPECT_EQ(sut.mean_since(4), Vec3(4, 5, 6));
    sut.replace_newest(Vec3(7, 8, 9));
    EXPECT_EQ(sut.mean_since(1), Vec3(7, 8, 9));
}

TEST(SentForces, arrive_late_as_a_time_line_of_fine_steps_says)
{
    for (const int delay_in_tenths : {0, 3, 10, 15, 27, 40})
    {
        Random random(static_cast<std::uint64_t>(delay_in_tenths));
        SentForces sut(0.1 * delay_in_tenths);
        std::deque<double> at_device(static_cast<std::size_t>(delay_in_tenths), 0.0);
        for (int i = 0; i < 100; ++i)
        {
            const double force = random.between(-5.0, 5.0);
            const std::uint32_t periods = random.one_in(5) ? 1 + random.below(4U) : 1;
            sut.send(Vec3(force, 0, 0));
            double sum = 0.0;
            for (std::uint32_t tenth = 0; tenth < 10 * periods; ++tenth)
            {
                at_device.push_back(force);
                sum += at_device.front();
                at_device.pop_front();
            }
            EXPECT_NEAR(sut.mean_since(periods).x(), sum / (10.0 * periods), 1e-12)
                << "delay " << delay_in_tenths << ", step " << i;
        }
    }
}

TEST(SentForces, know_a_delay_of_all_periods_but_the_newest_and_no_longer_one)
{
    constexpr double kLongest = kForcesUnderWay - 1;
    SentForces sut(kLongest);
    SentForces late(kLongest + 1.0);
    EXPECT_TRUE(sut.knows_delay());
    EXPECT_FALSE(late.knows_delay());
    for (std::uint32_t i = 0; i < 3 * kForcesUnderWay; ++i)
    {
        sut.send(Vec3(i, 0, 0));
        late.send(Vec3(i, 0, 0));
        const double at_device = std::max(0.0, i - kLongest);
        EXPECT_EQ(sut.mean_since(1).x(), at_device) << i;
        EXPECT_EQ(late.mean_since(1).x(), at_device) << "the oldest that is kept, " << i;
    }
}

TEST(PassivityObserver, sees_no_surplus_in_a_spring_that_gives_back_what_it_got)
{
    PassivityObserver sut(lossless(), kPeriod_s);
    // The motion goes in and out by steps whose mean force is the ideal spring's: 1,000 N/m to 1
    // mm.
    double depth = 0.0;
    for (int i = 0; i < 20; ++i)
    {
        const double next = depth + (i < 10 ? 1e-4 : -1e-4);
        sut.observe(Vec3(500.0 * (depth + next), 0, 0), Vec3(depth - next, 0, 0), kPeriod_s);
        sut.hold(500.0 * next * next);
        depth = next;
        EXPECT_NEAR(sut.observed_energy_j(), 0.0, 1e-15);
    }
    EXPECT_NEAR(sut.work_j(), 0.0, 1e-15);
}

TEST(PassivityObserver, sees_what_a_sampled_spring_makes_of_each_step)
{
    PassivityObserver sut(lossless(), kPeriod_s);
    double depth = 0.0;
    double expected = 0.0;
    for (int i = 0; i < 20; ++i)
    {
        const double next = std::max(0.0, depth + (i < 10 ? 1e-4 : -1e-4));
        sut.observe(Vec3(1'000.0 * depth, 0, 0), Vec3(depth - next, 0, 0), kPeriod_s);
        sut.hold(500.0 * next * next);
        expected += 500.0 * (next - depth) * (next - depth); // K dx^2 / 2.
        depth = next;
        EXPECT_NEAR(sut.observed_energy_j(), expected, 1e-12);
    }
    EXPECT_NEAR(sut.work_j(), expected, 1e-12);
}

TEST(PassivityObserver, takes_off_what_damping_and_friction_lose_and_keeps_no_credit)
{
    DeviceLimits device = lossless();
    device.damping_n_s_per_m = 2.0;
    device.friction_n = 0.1;
    PassivityObserver sut(device, kPeriod_s);
    sut.observe(Vec3(3, 0, 0), Vec3(1e-3, 0, 0), 2e-3);
    sut.hold(0.0);
    EXPECT_NEAR(sut.observed_energy_j(), 3e-3 - 2.0 * 1e-6 / 2e-3 - 0.1e-3, 1e-15);
    sut.observe(Vec3(-3, 0, 0), Vec3(1.0, 0, 0), 1e-3);
    sut.hold(0.0);
    EXPECT_EQ(sut.observed_energy_j(), 0.0);
    sut.observe(Vec3(3, 0, 0), Vec3(1e-4, 0, 0), 1e-3);
    sut.hold(0.0);
    EXPECT_NEAR(sut.observed_energy_j(), 3e-4 - 2.0 * 1e-8 / 1e-3 - 1e-5, 1e-15);
    EXPECT_NEAR(sut.work_j(), 3e-3 - 3.0 + 3e-4, 1e-12);
    sut.hold_nothing();
    EXPECT_EQ(sut.observed_energy_j(), 0.0);
}

TEST(PassivityObserver, asks_for_the_damping_that_loses_the_surplus_in_a_period)
{
    PassivityObserver sut(lossless(), kPeriod_s);
    EXPECT_EQ(sut.damping_for(0.1), 0.0);
    sut.hold(1e-5);
    EXPECT_NEAR(sut.damping_for(0.1), 1e-5 / (1e-3 * 0.01), 1e-12); // 1 N s/m.
    EXPECT_EQ(sut.damping_for(0.01), 5.0);
    EXPECT_EQ(sut.damping_for(0.0), 0.0);
    EXPECT_NEAR(sut.damping_for(1e200), 0.0, 1e-300);
}

TEST(VelocityWindow, needs_two_positions)
{
    VelocityWindow sut(1e-5);
    EXPECT_EQ(sut.velocity_m_per_s(), Vec3(0, 0, 0));
    sut.add(Vec3(1, 1, 1), kPeriod_s);
    EXPECT_EQ(sut.velocity_m_per_s(), Vec3(0, 0, 0));
    sut.add(Vec3(1.001, 1, 1), 0.5);
    EXPECT_NEAR(sut.velocity_m_per_s().x(), 0.002, 1e-12);
    sut.clear();
    EXPECT_EQ(sut.velocity_m_per_s(), Vec3(0, 0, 0));
}

TEST(VelocityWindow, finds_a_steady_speed_to_a_quantum_in_the_whole_window)
{
    constexpr double kQuantum_m = 1e-5;
    Random random(1);
    for (int trial = 0; trial < 50; ++trial)
    {
        const Vec3 speed = random.in_cube(0.05);
        VelocityWindow sut(kQuantum_m);
        for (int i = 0; i < 40; ++i)
        {
            const Vec3 place = speed * (kPeriod_s * i);
            sut.add(Vec3(quantised(place.x(), kQuantum_m), quantised(place.y(), kQuantum_m),
                         quantised(place.z(), kQuantum_m)),
                    kPeriod_s);
        }
        const double resolution = kQuantum_m / ((kVelocitySamples - 1) * kPeriod_s);
        const Vec3 error = sut.velocity_m_per_s() - speed;
        EXPECT_LE(error.cwiseAbs().maxCoeff(), 1.001 * resolution) << "trial " << trial;
    }
}

TEST(VelocityWindow, follows_a_turn_within_two_periods)
{
    VelocityWindow sut(1e-5);
    double x = 0.0;
    for (int i = 0; i < 30; ++i)
    {
        sut.add(Vec3(x += 1e-4, 0, 0), kPeriod_s);
    }
    EXPECT_NEAR(sut.velocity_m_per_s().x(), 0.1, 1e-9);
    sut.add(Vec3(x -= 1e-4, 0, 0), kPeriod_s);
    sut.add(Vec3(x -= 1e-4, 0, 0), kPeriod_s);
    EXPECT_NEAR(sut.velocity_m_per_s().x(), -0.1, 1e-9);
}

TEST(VelocityWindow, tells_a_stall_by_its_time)
{
    VelocityWindow sut(1e-5);
    sut.add(Vec3(0, 0, 0), kPeriod_s);
    sut.add(Vec3(1e-4, 0, 0), kPeriod_s);
    sut.add(Vec3(6e-4, 0, 0), 5.0 * kPeriod_s);
    EXPECT_NEAR(sut.velocity_m_per_s().x(), 0.1, 1e-9);
}

} // namespace tactus::test
