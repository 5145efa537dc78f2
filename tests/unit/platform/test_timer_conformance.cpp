// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/simulated_periodic_timer.hpp"
#include "platform/machine/posix/posix_clock.hpp"
#include "platform/machine/posix/posix_periodic_timer.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

/// Promises of every backend of Clock and PeriodicTimer. A shared machine may delay any step, so
/// lateness has no limit here: only earliness, the grid, and the cycle's values about times read
/// around it are checked.
namespace tactus::test
{
namespace
{

/// Backends of the clock and the timer, with a way to let time pass.
struct Machine
{
    virtual ~Machine() = default;
    [[nodiscard]] virtual PeriodicTimer& timer() = 0;
    [[nodiscard]] virtual const Clock& clock() = 0;
    /// Lets at least this time pass: a frame's work, or a stall.
    virtual void pass(Duration duration) = 0;
};

struct PosixMachine final : Machine
{
    PeriodicTimer& timer() override { return timer_; }
    const Clock& clock() override { return clock_; }
    void pass(Duration duration) override
    {
        std::this_thread::sleep_for(std::chrono::nanoseconds(duration.ns));
    }

private:
    PosixClock clock_;
    PosixPeriodicTimer timer_;
};

struct SimulatedMachine final : Machine
{
    PeriodicTimer& timer() override { return timer_; }
    const Clock& clock() override { return clock_; }
    void pass(Duration duration) override { clock_.advance(duration); }

private:
    SimulatedClock clock_{MonotonicTime{12'345}};
    SimulatedPeriodicTimer timer_{clock_};
};

using Machines = testing::Types<PosixMachine, SimulatedMachine>;

struct NameOfMachine
{
    template <typename T>
    static std::string GetName(int /*number*/)
    {
        return std::is_same_v<T, PosixMachine> ? "posix" : "simulated";
    }
};

template <typename T>
struct ClockConformance : testing::Test
{
    T machine;
    const Clock& sut = machine.clock();
};

TYPED_TEST_SUITE(ClockConformance, Machines, NameOfMachine);

TYPED_TEST(ClockConformance, never_goes_back)
{
    MonotonicTime last = this->sut.now();
    for (int i = 0; i < 10'000; ++i)
    {
        const MonotonicTime time = this->sut.now();
        ASSERT_GE(time, last);
        last = time;
    }
}

TYPED_TEST(ClockConformance, sees_all_the_time_that_passes)
{
    for (const Duration duration : {microseconds(1), microseconds(300), milliseconds(3)})
    {
        const MonotonicTime before = this->sut.now();
        this->machine.pass(duration);
        EXPECT_GE(this->sut.now() - before, duration);
    }
}

TYPED_TEST(ClockConformance, knows_the_century)
{
    EXPECT_GE(this->sut.wall_now().ns, 946'684'800'000'000'000);   // 2000-01-01.
    EXPECT_LT(this->sut.wall_now().ns, 4'102'444'800'000'000'000); // 2100-01-01.
}

/// Cycle with clock readings around it.
struct WatchedCycle
{
    MonotonicTime before;
    MonotonicTime woken;
    MonotonicTime running;
    Cycle cycle;
};

template <typename T>
struct PeriodicTimerConformance : testing::Test
{
    static constexpr Duration kPeriod = milliseconds(2);
    static constexpr Duration kMargin = microseconds(200);

    WatchedCycle next()
    {
        WatchedCycle seen;
        seen.before = now();
        sut.sleep_until_margin();
        seen.woken = now();
        seen.cycle = sut.spin_until_deadline();
        seen.running = now();
        return seen;
    }

    [[nodiscard]] MonotonicTime now() { return machine.clock().now(); }

    /// Runs cycles with frames of zero time, a part of a period and stalls between them.
    std::vector<WatchedCycle> run_with_hardship(int cycles)
    {
        std::mt19937 random(20'240'613); // NOLINT(cert-msc51-cpp): the same hardship each time.
        std::vector<WatchedCycle> seen;
        for (int i = 0; i < cycles; ++i)
        {
            seen.push_back(next());
            const auto share = static_cast<std::int64_t>(random() % 100);
            const std::int64_t periods = random() % 5 == 0 ? random() % 4 : 0;
            machine.pass(kPeriod * periods + nanoseconds(kPeriod.ns * share / 100));
        }
        return seen;
    }

    T machine;
    PeriodicTimer& sut = machine.timer();
};

TYPED_TEST_SUITE(PeriodicTimerConformance, Machines, NameOfMachine);

TYPED_TEST(PeriodicTimerConformance, refuses_a_period_out_of_range_and_names_the_range)
{
    for (const Duration period :
         {PeriodicTimer::kPeriodMin - nanoseconds(1), PeriodicTimer::kPeriodMax + nanoseconds(1),
          Duration{}, Duration{-1}, Duration{-1'000'000}})
    {
        const auto refused = this->sut.start(period, Duration{});
        ASSERT_FALSE(refused);
        EXPECT_NE(refused.error().text.find("period " + std::to_string(period.ns) + " ns"),
                  std::string::npos);
        EXPECT_NE(refused.error().text.find("50000..1000000000 ns"), std::string::npos);
    }
}

TYPED_TEST(PeriodicTimerConformance, refuses_a_margin_that_does_not_fit_the_period)
{
    for (const Duration margin : {milliseconds(1), milliseconds(5), Duration{-1}})
    {
        const auto refused = this->sut.start(milliseconds(1), margin);
        ASSERT_FALSE(refused);
        EXPECT_NE(refused.error().text.find("0..999999 ns"), std::string::npos);
    }
}

TYPED_TEST(PeriodicTimerConformance, accepts_both_ends_of_both_ranges)
{
    for (const Duration period : {PeriodicTimer::kPeriodMin, PeriodicTimer::kPeriodMax})
    {
        EXPECT_TRUE(this->sut.start(period, Duration{}));
        EXPECT_TRUE(this->sut.start(period, period - nanoseconds(1)));
        EXPECT_EQ(this->sut.period(), period);
    }
}

TYPED_TEST(PeriodicTimerConformance, goes_on_as_before_when_a_start_was_refused)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    const Cycle before = this->next().cycle;
    ASSERT_FALSE(this->sut.start(Duration{}, Duration{}));
    ASSERT_FALSE(this->sut.start(milliseconds(3), milliseconds(3)));
    EXPECT_EQ(this->sut.period(), this->kPeriod);
    const Cycle after = this->next().cycle;
    EXPECT_EQ(after.deadline - before.deadline, this->kPeriod * after.periods);
    EXPECT_EQ(this->sut.counts().cycles, 2U);
}

TYPED_TEST(PeriodicTimerConformance, has_its_first_deadline_a_period_after_the_start)
{
    const MonotonicTime before = this->now();
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    const MonotonicTime after = this->now();
    const Cycle cycle = this->next().cycle;
    const MonotonicTime first = cycle.deadline - this->kPeriod * (std::int64_t{cycle.periods} - 1);
    EXPECT_GE(first, before + this->kPeriod);
    EXPECT_LE(first, after + this->kPeriod);
}

TYPED_TEST(PeriodicTimerConformance, never_starts_a_frame_before_its_deadline)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    for (const WatchedCycle& seen : this->run_with_hardship(30))
    {
        EXPECT_GE(seen.running, seen.cycle.deadline);
        EXPECT_GE(seen.cycle.start_lateness, Duration{});
        EXPECT_LT(seen.cycle.start_lateness, this->kPeriod);
    }
}

TYPED_TEST(PeriodicTimerConformance, tells_the_time_at_which_a_frame_starts)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    for (const WatchedCycle& seen : this->run_with_hardship(30))
    {
        const MonotonicTime started = seen.cycle.deadline + seen.cycle.start_lateness;
        EXPECT_GE(started, seen.woken);
        EXPECT_LE(started, seen.running);
    }
}

TYPED_TEST(PeriodicTimerConformance, never_wakes_before_the_margin)
{
    for (const Duration margin : {Duration{}, this->kMargin, this->kPeriod - nanoseconds(1)})
    {
        ASSERT_TRUE(this->sut.start(this->kPeriod, margin));
        for (const WatchedCycle& seen : this->run_with_hardship(15))
        {
            if (seen.cycle.periods == 1) // Otherwise the deadline has moved since.
            {
                EXPECT_GE(seen.woken, seen.cycle.deadline - margin);
            }
        }
    }
}

TYPED_TEST(PeriodicTimerConformance, tells_by_how_much_a_sleep_or_the_wait_was_too_long)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    for (const WatchedCycle& seen : this->run_with_hardship(40))
    {
        if (seen.cycle.periods > 1)
        {
            continue; // The loop may have slept to deadlines that it then lost.
        }
        const MonotonicTime wake = seen.cycle.deadline - this->kMargin;
        const Duration lateness = seen.cycle.wake_lateness;
        const bool is_of_the_sleep = seen.woken >= wake + lateness;
        const bool is_of_the_wait = seen.cycle.start_lateness == lateness;
        EXPECT_TRUE(is_of_the_sleep || is_of_the_wait);
    }
}

TYPED_TEST(PeriodicTimerConformance, does_not_blame_the_machine_for_a_long_frame)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    for (int i = 0; i < 10; ++i)
    {
        static_cast<void>(this->next());
        this->machine.pass(this->kPeriod + microseconds(100)); // Past the deadline.
        const Cycle cycle = this->next().cycle;
        if (cycle.periods == 1)
        {
            EXPECT_EQ(cycle.wake_lateness, Duration{});
        }
        EXPECT_GE(cycle.wake_lateness, Duration{});
    }
}

TYPED_TEST(PeriodicTimerConformance, keeps_all_deadlines_on_one_grid_so_that_lateness_never_adds_up)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    const MonotonicTime origin = this->next().cycle.deadline;
    std::int64_t periods = 0;
    for (const WatchedCycle& seen : this->run_with_hardship(40))
    {
        periods += seen.cycle.periods;
        EXPECT_EQ(seen.cycle.deadline, origin + this->kPeriod * periods);
    }
    EXPECT_GT(periods, 40); // Some were lost, so the grid was tested.
}

TYPED_TEST(PeriodicTimerConformance, tells_how_many_periods_a_stall_took_and_counts_one_episode)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    const Cycle before = this->next().cycle;
    const TimerCounts counts = this->sut.counts();
    this->machine.pass(this->kPeriod * 5 + microseconds(700));
    const WatchedCycle after = this->next();
    EXPECT_GT(after.cycle.deadline, after.before); // No grid point within the stall is left.
    EXPECT_GE(after.cycle.periods, 6U);
    EXPECT_EQ(after.cycle.deadline - before.deadline, this->kPeriod * after.cycle.periods);
    EXPECT_EQ(this->sut.counts().missed_periods - counts.missed_periods, after.cycle.periods - 1);
    EXPECT_EQ(this->sut.counts().episodes,
              counts.episodes + (before.periods > 1 ? 0 : 1)); // Otherwise it is the same episode.
    EXPECT_EQ(this->sut.counts().cycles, 2U);
}

TYPED_TEST(PeriodicTimerConformance, never_runs_lost_frames_in_a_burst)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    static_cast<void>(this->next());
    this->machine.pass(this->kPeriod * 6);
    WatchedCycle last = this->next();
    for (int i = 0; i < 6; ++i)
    {
        const WatchedCycle seen = this->next();
        EXPECT_GE(seen.cycle.deadline - last.cycle.deadline, this->kPeriod);
        EXPECT_GE(seen.running, last.cycle.deadline + this->kPeriod);
        last = seen;
    }
}

TYPED_TEST(PeriodicTimerConformance, counts_what_the_cycles_tell)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    std::uint64_t missed = 0;
    std::uint64_t episodes = 0;
    bool was_late = false;
    for (const WatchedCycle& seen : this->run_with_hardship(40))
    {
        const bool is_late = seen.cycle.periods > 1;
        missed += seen.cycle.periods - 1;
        episodes += is_late && !was_late ? 1 : 0;
        was_late = is_late;
    }
    EXPECT_GT(episodes, 0U);
    EXPECT_EQ(this->sut.counts().cycles, 40U);
    EXPECT_EQ(this->sut.counts().missed_periods, missed);
    EXPECT_EQ(this->sut.counts().episodes, episodes);
}

TYPED_TEST(PeriodicTimerConformance, counts_stalls_in_a_row_as_one_episode)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    for (int i = 0; i < 4; ++i)
    {
        this->machine.pass(this->kPeriod * 3);
        static_cast<void>(this->next());
    }
    EXPECT_EQ(this->sut.counts().episodes, 1U);
    EXPECT_GE(this->sut.counts().missed_periods, 8U);
}

TYPED_TEST(PeriodicTimerConformance, forgets_counts_and_lateness_when_started_again)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    this->machine.pass(this->kPeriod * 4);
    static_cast<void>(this->next());
    EXPECT_GE(this->sut.counts().missed_periods, 4U);
    this->machine.pass(this->kPeriod * 4);
    this->sut.sleep_until_margin(); // The cycle is not completed.
    const MonotonicTime before = this->now();
    ASSERT_TRUE(this->sut.start(milliseconds(3), Duration{}));
    EXPECT_EQ(this->sut.period(), milliseconds(3));
    EXPECT_EQ(this->sut.counts().cycles, 0U);
    EXPECT_EQ(this->sut.counts().missed_periods, 0U);
    EXPECT_EQ(this->sut.counts().episodes, 0U);
    const WatchedCycle seen = this->next();
    EXPECT_GE(seen.cycle.deadline, before + milliseconds(3));
    EXPECT_LE(seen.cycle.deadline, seen.running);
    EXPECT_EQ(this->sut.counts().cycles, 1U);
    EXPECT_EQ(this->sut.counts().missed_periods, seen.cycle.periods - 1);
}

TYPED_TEST(PeriodicTimerConformance, works_when_the_sleep_is_left_out)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    for (int i = 0; i < 5; ++i)
    {
        const Cycle cycle = this->sut.spin_until_deadline();
        EXPECT_GE(this->now(), cycle.deadline);
    }
}

} // namespace
} // namespace tactus::test
