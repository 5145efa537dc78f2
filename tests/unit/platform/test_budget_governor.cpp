// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/budget_governor.hpp"
#include "rt_core/limits.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace tactus
{

namespace
{

constexpr std::uint32_t kWalks = 2;
constexpr std::uint32_t kProxies = 1;
constexpr Duration kBudget = microseconds(60);

/// A machine on which a frame takes what its work costs, with some scatter.
struct Machine
{
    double rest_us{8.0};      ///< Load, and the force but for its planes.
    double idle_us{6.0};      ///< Refine, refit and query with nothing to do.
    double per_edit_us{0.30}; ///< Split or merge.
    double per_step_us{0.02}; ///< Node, or four triangles.
    double per_plane_us{0.08};
    double scatter_us{4.0};
};

/// How much of its budgets a frame would like to use.
enum class Demand
{
    hungry, ///< All splits and merges, as after a jump.
    sliding ///< A few, and all in one frame of ten.
};

Budgets most_budgets()
{
    Budgets most;
    most.splits = kMaxSplitsPerFrame;
    most.merges = kMaxMergesPerFrame;
    return most;
}

class Simulation
{
public:
    Simulation(Duration frame_budget, const Machine& start, Demand wanted)
        : machine(start), demand(wanted), sut(frame_budget, most_budgets(), kWalks, kProxies)
    {
    }

    /// One frame; returns its time in microseconds.
    double step(double stall_us = 0.0)
    {
        const Budgets& budgets = sut.budgets();
        const bool all = demand == Demand::hungry || any(random) < 0.1;
        const double few = 10.0 * any(random);
        FrameCost cost;
        cost.work.splits = used(budgets.splits, all ? 1e9 : few);
        cost.work.merges = used(budgets.merges, all ? 1e9 : few);
        cost.work.nodes_visited = used(kWalks * budgets.nodes, 60.0 + 60.0 * any(random));
        cost.work.triangles_tested = used(kWalks * budgets.triangles, 200.0 + 300.0 * any(random));
        cost.work.planes_looked_at =
            used(budgets.planes, is_fast ? 1e9 : 30.0 + 40.0 * any(random));
        const double edits = cost.work.splits + cost.work.merges;
        const double steps = cost.work.nodes_visited + cost.work.triangles_tested / 4.0;
        const double walked_us = machine.idle_us + machine.per_edit_us * edits +
                                 machine.per_step_us * steps + machine.scatter_us * any(random);
        const double force_us = machine.per_plane_us * cost.work.planes_looked_at;
        const double frame_us =
            walked_us + force_us + machine.rest_us + machine.scatter_us * any(random) + stall_us;
        cost.walked = nanoseconds(static_cast<std::int64_t>(walked_us * 1e3));
        cost.force = nanoseconds(static_cast<std::int64_t>(force_us * 1e3));
        cost.frame = nanoseconds(static_cast<std::int64_t>(frame_us * 1e3));
        sut.observe(cost);
        return frame_us;
    }

    /// Many frames; returns the time that all but one in a hundred stay below.
    double run(int frames)
    {
        std::vector<double> times_us;
        splits_min = kMaxSplitsPerFrame;
        splits_max = 0;
        for (int i = 0; i < frames; ++i)
        {
            splits_min = std::min(splits_min, sut.budgets().splits);
            splits_max = std::max(splits_max, sut.budgets().splits);
            times_us.push_back(step());
        }
        std::sort(times_us.begin(), times_us.end());
        return times_us[times_us.size() * 99 / 100];
    }

    Machine machine;
    Demand demand;
    BudgetGovernor sut;
    bool is_fast{false};         ///< Its proxy would use all planes.
    std::uint32_t splits_min{0}; ///< Budgets of the last run().
    std::uint32_t splits_max{0};

private:
    static std::uint32_t used(std::uint32_t budget, double wanted)
    {
        return static_cast<std::uint32_t>(std::min(static_cast<double>(budget), wanted));
    }

    std::mt19937 random{1};
    std::uniform_real_distribution<double> any{0.0, 1.0};
};

void expect_within_limits(const Budgets& budgets, const Budgets& most)
{
    EXPECT_GE(budgets.splits, BudgetGovernor::kSplitsLeast);
    EXPECT_LE(budgets.splits, most.splits);
    EXPECT_GE(budgets.merges, BudgetGovernor::kSplitsLeast);
    EXPECT_LE(budgets.merges, most.merges);
    EXPECT_GE(budgets.scanned, BudgetGovernor::kScannedLeast);
    EXPECT_LE(budgets.scanned, most.scanned);
    EXPECT_GE(budgets.nodes, BudgetGovernor::kNodesLeast);
    EXPECT_LE(budgets.nodes, most.nodes);
    EXPECT_GE(budgets.triangles, 4 * BudgetGovernor::kNodesLeast);
    EXPECT_LE(budgets.triangles, most.triangles);
    EXPECT_GE(budgets.planes, BudgetGovernor::kPlanesLeast);
    EXPECT_LE(budgets.planes, most.planes);
}

/// Splits that would fill the set time to the last: both edits of each, after all else.
double splits_that_fill(const Machine& machine, double budget_us)
{
    const double steps = 90.0 + 350.0 / 4.0;
    const double planes = 70.0; // At most.
    const double fixed_us = machine.rest_us + machine.idle_us + machine.scatter_us +
                            steps * machine.per_step_us + // Half the scatter, twice.
                            planes * machine.per_plane_us;
    return (budget_us - fixed_us) / (2.0 * machine.per_edit_us);
}

TEST(BudgetGovernor, starts_with_budgets_that_usual_costs_would_keep)
{
    const BudgetGovernor sut(kBudget, most_budgets(), kWalks, kProxies);
    expect_within_limits(sut.budgets(), most_budgets());
    EXPECT_GE(sut.budgets().splits, 8U);
    EXPECT_LE(sut.budgets().splits, 64U);
    EXPECT_FALSE(sut.is_at_floor());
}

TEST(BudgetGovernor, leaves_alone_what_it_does_not_govern)
{
    Budgets most = most_budgets();
    most.pages = 3;
    most.requests = 17;
    most.regions = 5;
    const BudgetGovernor sut(kBudget, most, kWalks, kProxies);
    EXPECT_EQ(sut.budgets().pages, 3U);
    EXPECT_EQ(sut.budgets().requests, 17U);
    EXPECT_EQ(sut.budgets().regions, 5U);
}

TEST(BudgetGovernor, converges_to_the_splits_that_fill_the_time)
{
    for (const double per_edit_us : {0.15, 0.3, 0.6, 1.2})
    {
        for (const double per_step_us : {0.008, 0.02, 0.04})
        {
            SCOPED_TRACE(testing::Message() << per_edit_us << " us an edit, " << per_step_us);
            Machine machine;
            machine.per_edit_us = per_edit_us;
            machine.per_step_us = per_step_us;
            Simulation simulation(kBudget, machine, Demand::hungry);
            simulation.run(600);
            const double p99_us = simulation.run(2'000);
            const double full = splits_that_fill(machine, 60.0);
            EXPECT_LT(p99_us, 1.06 * 60.0);
            EXPECT_GT(simulation.sut.budgets().splits, 0.7 * full - 2.0);
            EXPECT_LE(simulation.sut.budgets().splits, 1.05 * full);
        }
    }
}

TEST(BudgetGovernor, rests_where_it_has_converged)
{
    for (const Demand demand : {Demand::hungry, Demand::sliding})
    {
        Simulation simulation(kBudget, {}, demand);
        simulation.run(1'000);
        simulation.run(4'000);
        const double middle = (simulation.splits_min + simulation.splits_max) / 2.0;
        EXPECT_GT(simulation.splits_min, 0.75 * middle);
        EXPECT_LT(simulation.splits_max, 1.25 * middle);
        EXPECT_FALSE(simulation.sut.is_at_floor());
    }
}

TEST(BudgetGovernor, is_within_its_time_again_few_frames_after_costs_have_tripled)
{
    Simulation simulation(kBudget, {}, Demand::hungry);
    simulation.run(1'000);
    simulation.machine.per_edit_us *= 3.0;
    simulation.machine.per_step_us *= 3.0;
    simulation.machine.idle_us *= 3.0;
    EXPECT_GT(simulation.step(), 80.0) << "the first frame can't know";
    int frames = 1;
    while (simulation.step() > 60.0 && frames < 1'000)
    {
        ++frames;
    }
    EXPECT_LE(frames, 10);
    simulation.run(300);
    EXPECT_LT(simulation.run(1'000), 1.1 * 60.0);
    EXPECT_GT(simulation.sut.budgets().splits, 0.5 * splits_that_fill(simulation.machine, 60.0));
}

TEST(BudgetGovernor, rises_slowly_to_what_cheaper_frames_allow)
{
    Machine machine;
    machine.per_edit_us = 0.9;
    Simulation simulation(kBudget, machine, Demand::hungry);
    simulation.run(1'000);
    simulation.machine.per_edit_us = 0.15;
    const double full = splits_that_fill(simulation.machine, 60.0);
    for (int i = 0; i < 2'000; ++i)
    {
        const Budgets before = simulation.sut.budgets();
        simulation.step();
        const Budgets& after = simulation.sut.budgets();
        ASSERT_LE(after.splits, before.splits + (kMaxSplitsPerFrame - before.splits + 15) / 16);
        ASSERT_LE(after.nodes, before.nodes + (most_budgets().nodes - before.nodes + 15) / 16);
    }
    EXPECT_GT(simulation.sut.budgets().splits, 0.7 * full);
}

TEST(BudgetGovernor, says_when_even_the_least_is_too_much_and_still_makes_progress)
{
    Machine machine;
    machine.rest_us = 70.0;
    Simulation simulation(kBudget, machine, Demand::hungry);
    simulation.run(300);
    EXPECT_TRUE(simulation.sut.is_at_floor());
    EXPECT_EQ(simulation.sut.budgets().splits, BudgetGovernor::kSplitsLeast);
    EXPECT_EQ(simulation.sut.budgets().merges, BudgetGovernor::kSplitsLeast);
    expect_within_limits(simulation.sut.budgets(), most_budgets());
    simulation.machine.rest_us = 10.0;
    simulation.run(2'000);
    EXPECT_FALSE(simulation.sut.is_at_floor());
    EXPECT_GT(simulation.sut.budgets().splits, 20U);
}

TEST(BudgetGovernor, gives_all_there_is_where_time_is_plenty)
{
    Machine machine;
    machine.per_edit_us = 0.05;
    Simulation simulation(microseconds(900), machine, Demand::sliding);
    simulation.run(1'000);
    const Budgets most = most_budgets();
    EXPECT_EQ(simulation.sut.budgets().splits, most.splits);
    EXPECT_EQ(simulation.sut.budgets().merges, most.merges);
    EXPECT_EQ(simulation.sut.budgets().nodes, most.nodes);
    EXPECT_EQ(simulation.sut.budgets().triangles, most.triangles);
    EXPECT_EQ(simulation.sut.budgets().scanned, most.scanned);
    EXPECT_EQ(simulation.sut.budgets().planes, most.planes);
}

TEST(BudgetGovernor, learns_nothing_from_one_stall_of_the_machine)
{
    Simulation simulation(kBudget, {}, Demand::hungry);
    simulation.run(1'000);
    const Budgets before = simulation.sut.budgets();
    simulation.step(5'000.0);
    EXPECT_EQ(simulation.sut.budgets().splits, before.splits);
    EXPECT_EQ(simulation.sut.budgets().nodes, before.nodes);
    simulation.step();
    EXPECT_GT(simulation.sut.budgets().splits, before.splits / 2);
}

TEST(BudgetGovernor, falls_when_long_frames_go_on)
{
    Simulation simulation(kBudget, {}, Demand::hungry);
    simulation.run(1'000);
    const std::uint32_t before = simulation.sut.budgets().splits;
    for (int i = 0; i < 5; ++i)
    {
        simulation.step(5'000.0);
    }
    EXPECT_LT(simulation.sut.budgets().splits, before / 2);
}

TEST(BudgetGovernor, lets_a_traversal_grow_that_its_budget_cut)
{
    Simulation simulation(microseconds(400), {}, Demand::sliding);
    simulation.run(500);
    FrameCost cost;
    for (int i = 0; i < 200; ++i)
    {
        cost.work.nodes_visited = kWalks * simulation.sut.budgets().nodes;
        cost.work.triangles_tested = kWalks * simulation.sut.budgets().triangles;
        const double steps = cost.work.nodes_visited + cost.work.triangles_tested / 4.0;
        cost.walked = nanoseconds(static_cast<std::int64_t>(6'000.0 + 20.0 * steps));
        cost.frame = cost.walked + microseconds(12);
        simulation.sut.observe(cost);
    }
    EXPECT_GT(simulation.sut.budgets().nodes, most_budgets().nodes / 2);
}

TEST(BudgetGovernor, a_fast_hand_s_proxy_gets_the_planes_that_fit)
{
    for (const double per_plane_us : {0.04, 0.08, 0.2})
    {
        Machine machine;
        machine.per_plane_us = per_plane_us;
        Simulation simulation(kBudget, machine, Demand::sliding);
        simulation.is_fast = true;
        simulation.run(1'000);
        EXPECT_LT(simulation.run(2'000), 1.1 * 60.0) << per_plane_us;
        expect_within_limits(simulation.sut.budgets(), most_budgets());
        const std::uint32_t fast = simulation.sut.budgets().planes;
        EXPECT_LT(fast, most_budgets().planes) << per_plane_us;
        simulation.is_fast = false;
        simulation.run(2'000);
        EXPECT_FALSE(simulation.sut.is_at_floor());
        EXPECT_GT(simulation.sut.budgets().splits, 10U) << per_plane_us;
    }
}

RC_GTEST_PROP(BudgetGovernor, never_leaves_its_limits_and_gives_the_same_for_the_same, ())
{
    const Duration budget = microseconds(*rc::gen::inRange(10, 2'000));
    const Budgets most = most_budgets();
    BudgetGovernor sut(budget, most, kWalks, kProxies);
    BudgetGovernor twin(budget, most, kWalks, kProxies);
    for (int i = 0; i < 100; ++i)
    {
        FrameCost cost;
        cost.walked = nanoseconds(*rc::gen::inRange(0, 4'000'000));
        cost.force = nanoseconds(*rc::gen::inRange(0, 1'000'000));
        cost.frame = cost.walked + cost.force + nanoseconds(*rc::gen::inRange(0, 400'000));
        cost.work.splits = *rc::gen::inRange(0U, sut.budgets().splits + 1);
        cost.work.merges = *rc::gen::inRange(0U, sut.budgets().merges + 1);
        cost.work.nodes_visited = *rc::gen::inRange(0U, kWalks * sut.budgets().nodes + 1);
        cost.work.triangles_tested = *rc::gen::inRange(0U, kWalks * sut.budgets().triangles + 1);
        cost.work.planes_looked_at = *rc::gen::inRange(0U, kProxies * sut.budgets().planes + 1);
        sut.observe(cost);
        twin.observe(cost);
        const Budgets& b = sut.budgets();
        const Budgets& t = twin.budgets();
        RC_ASSERT(b.splits >= BudgetGovernor::kSplitsLeast && b.splits <= most.splits);
        RC_ASSERT(b.merges >= BudgetGovernor::kSplitsLeast && b.merges <= most.merges);
        RC_ASSERT(b.scanned >= BudgetGovernor::kScannedLeast && b.scanned <= most.scanned);
        RC_ASSERT(b.nodes >= BudgetGovernor::kNodesLeast && b.nodes <= most.nodes);
        RC_ASSERT(b.triangles >= 4 * BudgetGovernor::kNodesLeast && b.triangles <= most.triangles);
        RC_ASSERT(b.splits == t.splits && b.merges == t.merges && b.scanned == t.scanned);
        RC_ASSERT(b.planes >= BudgetGovernor::kPlanesLeast && b.planes <= most.planes);
        RC_ASSERT(b.nodes == t.nodes && b.triangles == t.triangles && b.planes == t.planes);
    }
}

} // namespace

} // namespace tactus
