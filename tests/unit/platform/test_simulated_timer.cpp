// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/simulated_periodic_timer.hpp"

#include <gtest/gtest.h>

#include <array>

namespace tactus
{
namespace
{

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
