// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/posix/posix_clock.hpp"
#include "platform/posix/posix_periodic_timer.hpp"
#include "platform/simulated/simulated_periodic_timer.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace tactus
{

namespace
{

/// A timer, the clock it runs by, and a way to let time pass on it.
class Machine
{
public:
    virtual ~Machine() = default;
    virtual PeriodicTimer& timer() = 0;
    virtual const Clock& clock() = 0;
    virtual void work(Duration duration) = 0;
};

class PosixMachine final : public Machine
{
public:
    PeriodicTimer& timer() override { return timer_; }
    const Clock& clock() override { return clock_; }
    void work(Duration duration) override
    {
        const MonotonicTime end = clock_.now() + duration;
        while (clock_.now() < end)
        {
        }
    }

private:
    PosixClock clock_;
    PosixPeriodicTimer timer_;
};

class SimulatedMachine final : public Machine
{
public:
    PeriodicTimer& timer() override { return timer_; }
    const Clock& clock() override { return clock_; }
    void work(Duration duration) override { clock_.advance(duration); }

private:
    SimulatedClock clock_{MonotonicTime{12'345}};
    SimulatedPeriodicTimer timer_{clock_};
};

/// What every backend promises. A shared machine may delay any cycle, so nothing here sets a limit
/// to lateness: only to earliness, to the grid, and to what the counts say about each other.
template <typename T>
class PeriodicTimerConformance : public testing::Test
{
protected:
    Cycle next()
    {
        sut.sleep_until_margin();
        return sut.spin_until_deadline();
    }

    T machine;
    PeriodicTimer& sut = machine.timer();
    static constexpr Duration kPeriod = milliseconds(2);
    static constexpr Duration kMargin = microseconds(200);
};

using Machines = testing::Types<PosixMachine, SimulatedMachine>;
TYPED_TEST_SUITE(PeriodicTimerConformance, Machines);

TYPED_TEST(PeriodicTimerConformance, refuses_a_period_out_of_range_and_names_the_range)
{
    for (const Duration period : {microseconds(49), milliseconds(1'001), Duration{}, Duration{-1}})
    {
        const auto refused = this->sut.start(period, Duration{});
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().kind, PlatformErrorKind::bad_option);
        EXPECT_NE(refused.error().message.find("50000..1000000000 ns"), std::string::npos);
    }
}

TYPED_TEST(PeriodicTimerConformance, refuses_a_margin_that_does_not_fit_the_period)
{
    EXPECT_FALSE(this->sut.start(milliseconds(1), milliseconds(1)));
    EXPECT_FALSE(this->sut.start(milliseconds(1), Duration{-1}));
    EXPECT_TRUE(this->sut.start(milliseconds(1), Duration{}));
    EXPECT_TRUE(this->sut.start(milliseconds(1), Duration{999'999}));
}

TYPED_TEST(PeriodicTimerConformance, accepts_both_ends_of_the_range)
{
    EXPECT_TRUE(this->sut.start(microseconds(50), Duration{}));
    EXPECT_TRUE(this->sut.start(milliseconds(1'000), Duration{}));
}

TYPED_TEST(PeriodicTimerConformance, never_starts_a_frame_before_its_deadline)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    for (int i = 0; i < 20; ++i)
    {
        const Cycle cycle = this->next();
        EXPECT_GE(this->machine.clock().now(), cycle.deadline);
        EXPECT_GE(cycle.start_lateness, Duration{});
        EXPECT_LT(cycle.start_lateness, this->kPeriod);
        EXPECT_GE(cycle.wake_lateness, Duration{});
    }
}

TYPED_TEST(PeriodicTimerConformance, never_wakes_before_the_margin)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    for (int i = 0; i < 20; ++i)
    {
        this->sut.sleep_until_margin();
        const MonotonicTime woken = this->machine.clock().now();
        const Cycle cycle = this->sut.spin_until_deadline();
        if (cycle.periods == 1) // Otherwise the deadline has moved since.
        {
            EXPECT_GE(woken, cycle.deadline - this->kMargin);
        }
    }
}

TYPED_TEST(PeriodicTimerConformance, keeps_all_deadlines_on_one_grid)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    Cycle last = this->next();
    for (int i = 0; i < 20; ++i)
    {
        const Cycle cycle = this->next();
        EXPECT_EQ(cycle.deadline - last.deadline, this->kPeriod * cycle.periods);
        last = cycle;
    }
}

TYPED_TEST(PeriodicTimerConformance, tells_how_many_periods_a_stall_took_and_counts_one_episode)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    const Cycle before = this->next();
    const TimerCounts counts = this->sut.counts();
    this->machine.work(this->kPeriod * 5 + microseconds(700));
    const Cycle after = this->next();
    EXPECT_GE(after.periods, 6U);
    EXPECT_EQ(after.deadline - before.deadline, this->kPeriod * after.periods);
    EXPECT_LT(after.start_lateness, this->kPeriod);
    EXPECT_EQ(this->sut.counts().missed_periods - counts.missed_periods, after.periods - 1);
    EXPECT_LE(this->sut.counts().episodes, counts.episodes + 1);
    EXPECT_GE(this->sut.counts().episodes, 1U);
    EXPECT_EQ(this->sut.counts().cycles, 2U);
}

TYPED_TEST(PeriodicTimerConformance, counts_missed_periods_as_the_cycles_tell_them)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    std::uint64_t missed = 0;
    for (int i = 0; i < 20; ++i)
    {
        missed += this->next().periods - 1;
        this->machine.work(i % 7 == 3 ? this->kPeriod * 3 : microseconds(10));
    }
    EXPECT_EQ(this->sut.counts().missed_periods, missed);
    EXPECT_GE(missed, 4U);
    EXPECT_EQ(this->sut.counts().cycles, 20U);
}

TYPED_TEST(PeriodicTimerConformance, forgets_its_counts_when_started_again)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    this->machine.work(this->kPeriod * 4);
    static_cast<void>(this->next());
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    EXPECT_EQ(this->sut.counts().cycles, 0U);
    EXPECT_EQ(this->sut.counts().missed_periods, 0U);
    EXPECT_EQ(this->sut.counts().episodes, 0U);
}

TYPED_TEST(PeriodicTimerConformance, works_when_the_sleep_is_left_out)
{
    ASSERT_TRUE(this->sut.start(this->kPeriod, this->kMargin));
    const Cycle cycle = this->sut.spin_until_deadline();
    EXPECT_GE(this->machine.clock().now(), cycle.deadline);
}

TEST(PosixClock, goes_on_and_knows_the_century)
{
    const PosixClock sut;
    const MonotonicTime before = sut.now();
    EXPECT_GE(sut.now(), before);
    EXPECT_GT(sut.wall_now().ns, 1'577'836'800'000'000'000); // 2020-01-01.
}

} // namespace

} // namespace tactus
