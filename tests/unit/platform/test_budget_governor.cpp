// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/budget_governor.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace tactus
{
namespace
{

constexpr Duration kBudget = microseconds(60);
constexpr std::uint32_t kLeast = 40'000;
constexpr std::uint32_t kMost = 500'000;

/// Machine on which a frame takes the time of its work, with some scatter.
struct Machine
{
    double rest_us{14.0}; ///< Time of a frame without work.
    double pace_ns{0.3};  ///< Time of a unit of work.
    double scatter_us{4.0};
};

/// Demand of a frame for work.
enum class Demand
{
    hungry, ///< All work, as after a jump.
    sliding ///< Little work, and all in one frame of ten.
};

struct Simulation
{
    Simulation(Duration frame_budget, const Machine& start, Demand wanted)
        : machine(start), demand(wanted), sut(frame_budget, kLeast, kMost)
    {
    }

    /// One frame; returns its time in microseconds.
    double step(double stall_us = 0.0)
    {
        const bool all = demand == Demand::hungry || any(random) < 0.1;
        const double wanted = all ? 1e9 : 10'000.0 + 20'000.0 * any(random);
        const double work = std::min(static_cast<double>(sut.work()), wanted);
        const double frame_us = machine.rest_us + 1e-3 * machine.pace_ns * work +
                                machine.scatter_us * any(random) + stall_us;
        sut.observe({nanoseconds(static_cast<std::int64_t>(frame_us * 1e3)),
                     static_cast<std::uint32_t>(work)});
        return frame_us;
    }

    /// Many frames; returns the 99 % quantile of their times.
    double run(int frames)
    {
        std::vector<double> times_us;
        least = kMost;
        most = 0;
        for (int i = 0; i < frames; ++i)
        {
            least = std::min(least, sut.work());
            most = std::max(most, sut.work());
            times_us.push_back(step());
        }
        std::ranges::sort(times_us);
        return times_us[times_us.size() * 99 / 100];
    }

    /// Work that exactly fills the set time.
    [[nodiscard]] double work_that_fills(double budget_us) const
    {
        return (budget_us - machine.rest_us - machine.scatter_us) / (1e-3 * machine.pace_ns);
    }

    Machine machine;
    Demand demand;
    BudgetGovernor sut;
    std::uint32_t least{0}; ///< Least budget of the last run().
    std::uint32_t most{0};

private:
    std::mt19937 random{1};
    std::uniform_real_distribution<double> any{0.0, 1.0};
};

TEST(BudgetGovernor, begins_with_an_instruction_a_nanosecond)
{
    EXPECT_EQ(BudgetGovernor(kBudget, kLeast, kMost).work(), 60'000U);
    EXPECT_EQ(BudgetGovernor(microseconds(500), kLeast, kMost).work(), kMost);
    EXPECT_EQ(BudgetGovernor(microseconds(900), kLeast, kMost).work(), kMost);
    EXPECT_FALSE(BudgetGovernor(kBudget, kLeast, kMost).is_at_floor());
}

/// Frames in free air, with delays of a busy machine.
TEST(BudgetGovernor, takes_no_noise_for_the_pace_while_work_hardly_varies)
{
    for (const double pace_ns : {0.3, 1.0})
    {
        std::mt19937_64 random(1);
        std::uniform_real_distribution<double> any(0.0, 1.0);
        BudgetGovernor sut(microseconds(500), 80'000, kMost);
        for (int frame = 0; frame < 3'000; ++frame)
        {
            const double work = 3'000.0 + 2'600.0 * any(random);
            const double delay_ns = any(random) < 0.02 ? 600'000.0 * any(random) : 0.0;
            const double frame_ns = 12'000.0 + pace_ns * work + 6'000.0 * any(random) + delay_ns;
            sut.observe({nanoseconds(static_cast<std::int64_t>(frame_ns)),
                         static_cast<std::uint32_t>(work)});
            ASSERT_FALSE(sut.is_at_floor()) << frame;
        }
    }
}

TEST(BudgetGovernor, converges_to_the_work_that_fills_the_time)
{
    for (const double pace_ns : {0.15, 0.3, 0.6})
    {
        for (const double rest_us : {3.0, 14.0, 25.0})
        {
            SCOPED_TRACE(testing::Message() << pace_ns << " ns a unit, " << rest_us << " us");
            Simulation simulation(kBudget, {rest_us, pace_ns, 4.0}, Demand::sliding);
            simulation.run(2'000);
            const double p99_us = simulation.run(2'000);
            const double full = simulation.work_that_fills(60.0);
            EXPECT_LT(p99_us, 1.06 * 60.0);
            EXPECT_GT(simulation.sut.work(), 0.7 * full);
            EXPECT_LE(simulation.sut.work(), 1.05 * full);
        }
    }
}

TEST(BudgetGovernor, keeps_the_time_also_where_all_frames_do_all_that_they_may)
{
    for (const double pace_ns : {0.15, 0.5, 2.0, 8.0})
    {
        Simulation simulation(microseconds(500), {20.0, pace_ns, 10.0}, Demand::hungry);
        simulation.run(2'000);
        EXPECT_LT(simulation.run(2'000), 1.06 * 500.0) << pace_ns;
        const double full = std::min<double>(kMost, simulation.work_that_fills(500.0));
        EXPECT_GT(simulation.sut.work(), 0.5 * full) << pace_ns;
    }
}

TEST(BudgetGovernor, rests_where_it_has_converged)
{
    for (const Demand demand : {Demand::hungry, Demand::sliding})
    {
        Simulation simulation(kBudget, {}, demand);
        simulation.run(2'000);
        simulation.run(4'000);
        const double middle = (simulation.least + simulation.most) / 2.0;
        EXPECT_GT(simulation.least, 0.75 * middle);
        EXPECT_LT(simulation.most, 1.25 * middle);
        EXPECT_FALSE(simulation.sut.is_at_floor());
    }
}

TEST(BudgetGovernor, is_within_its_time_again_few_frames_after_costs_have_tripled)
{
    Simulation simulation(kBudget, {}, Demand::hungry);
    simulation.run(1'000);
    simulation.machine.pace_ns *= 3.0;
    EXPECT_GT(simulation.step(), 80.0) << "the first frame can't know";
    int frames = 1;
    while (simulation.step() > 60.0 && frames < 1'000)
    {
        ++frames;
    }
    EXPECT_LE(frames, 30);
    simulation.run(300);
    EXPECT_LT(simulation.run(1'000), 1.1 * 60.0);
}

TEST(BudgetGovernor, rises_slowly_to_what_cheaper_frames_allow)
{
    Simulation simulation(kBudget, {14.0, 0.9, 4.0}, Demand::sliding);
    simulation.run(1'000);
    simulation.machine.pace_ns = 0.15;
    const double full = simulation.work_that_fills(60.0);
    for (int i = 0; i < 4'000; ++i)
    {
        const std::uint32_t before = simulation.sut.work();
        simulation.step();
        ASSERT_LE(simulation.sut.work(), before + (kMost - before + 15) / 16);
    }
    EXPECT_GT(simulation.sut.work(), 0.7 * full);
}

TEST(BudgetGovernor, says_when_even_the_least_is_too_much_and_still_makes_progress)
{
    Simulation simulation(kBudget, {70.0, 0.3, 4.0}, Demand::hungry);
    simulation.run(300);
    EXPECT_TRUE(simulation.sut.is_at_floor());
    EXPECT_EQ(simulation.sut.work(), kLeast);
    simulation.machine.rest_us = 10.0;
    simulation.run(2'000);
    EXPECT_FALSE(simulation.sut.is_at_floor());
    EXPECT_GT(simulation.sut.work(), 2 * kLeast);
}

TEST(BudgetGovernor, gives_all_there_is_where_time_is_plenty)
{
    Simulation simulation(microseconds(900), {}, Demand::sliding);
    simulation.run(1'000);
    EXPECT_EQ(simulation.least, kMost);
}

TEST(BudgetGovernor, learns_nothing_from_one_stall_of_the_machine)
{
    Simulation simulation(kBudget, {}, Demand::hungry);
    simulation.run(1'000);
    const std::uint32_t before = simulation.sut.work();
    simulation.step(5'000.0);
    EXPECT_EQ(simulation.sut.work(), before);
    simulation.step();
    EXPECT_GT(simulation.sut.work(), before / 2);
}

TEST(BudgetGovernor, falls_when_long_frames_go_on)
{
    Simulation simulation(kBudget, {}, Demand::hungry);
    simulation.run(1'000);
    const std::uint32_t before = simulation.sut.work();
    for (int i = 0; i < 5; ++i)
    {
        simulation.step(5'000.0);
    }
    EXPECT_LT(simulation.sut.work(), before / 2);
}

RC_GTEST_PROP(BudgetGovernor, never_leaves_its_limits_and_gives_the_same_for_the_same, ())
{
    const Duration budget = microseconds(*rc::gen::inRange(10, 2'000));
    const auto least = *rc::gen::inRange(1U, 1'000'000U);
    const auto most = *rc::gen::inRange(least, 2'000'000U);
    BudgetGovernor sut(budget, least, most);
    BudgetGovernor twin(budget, least, most);
    for (int i = 0; i < 100; ++i)
    {
        const FrameCost cost{nanoseconds(*rc::gen::inRange(0, 4'000'000)),
                             *rc::gen::inRange(0U, WorkBudget::most_of(sut.work()) + 1)};
        sut.observe(cost);
        twin.observe(cost);
        RC_ASSERT(sut.work() >= least && sut.work() <= most);
        RC_ASSERT(sut.work() == twin.work() && sut.is_at_floor() == twin.is_at_floor());
    }
}

} // namespace
} // namespace tactus
