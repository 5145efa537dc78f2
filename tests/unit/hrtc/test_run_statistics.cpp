// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/run_statistics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <functional>

namespace tactus::hrtc::test
{

namespace
{

constexpr std::uint32_t kModels = 2;
constexpr std::uint32_t kTools = 1;
constexpr std::uint32_t kPairs = kTools * kModels;
constexpr Duration kPeriod = milliseconds(1);

/// Frames of two models under one tool, one after the other.
class StatisticsRig
{
public:
    StatisticsRig()
    {
        output_.tools = tools_;
        output_.pairs = pairs_;
        output_.models = models_;
        measures_.cycle.periods = 1;
    }

    void frame(const std::function<void(FrameOutput&, CycleMeasures&)>& change)
    {
        FrameOutput output = output_;
        CycleMeasures measures = measures_;
        change(output, measures);
        sut.add(output, sent_n_, conditioned_, measures);
    }

    RunStatistics sut{kTools, kPairs, kModels, kPeriod};

private:
    std::array<ToolOutput, kTools> tools_{};
    std::array<PairOutput, kPairs> pairs_{};
    std::array<ModelOutput, kModels> models_{};
    std::array<Vec3, kTools> sent_n_{Vec3(0.0, 0.0, 0.0)};
    std::array<ConditionedForce, kTools> conditioned_{};
    FrameOutput output_;
    CycleMeasures measures_;
};

/// Each model has the budget of splits to itself, and each pair is walked twice.
TEST(RunStatistics, counts_a_frame_as_over_budget_from_one_beyond_what_all_models_may_do)
{
    StatisticsRig run;
    const auto with = [&run](auto change)
    {
        run.frame([change](FrameOutput& output, CycleMeasures& measures)
                  { change(output.work, measures.budgets); });
        return run.sut.over_budget;
    };
    EXPECT_EQ(with([](WorkCounters& work, const Budgets& budgets)
                   { work.splits = kModels * budgets.splits; }),
              0U);
    EXPECT_EQ(with([](WorkCounters& work, const Budgets& budgets)
                   { work.splits = kModels * budgets.splits + 1; }),
              1U);
    EXPECT_EQ(with([](WorkCounters& work, const Budgets& budgets)
                   { work.nodes_visited = 2 * kPairs * budgets.nodes; }),
              1U);
    EXPECT_EQ(with([](WorkCounters& work, const Budgets& budgets)
                   { work.nodes_visited = 2 * kPairs * budgets.nodes + 1; }),
              2U);
    EXPECT_EQ(with([](WorkCounters& work, const Budgets& budgets)
                   { work.requests = kModels * (budgets.requests + budgets.regions) + 1; }),
              3U);
    EXPECT_EQ(run.sut.own_faults, 3U);
    EXPECT_EQ(run.sut.frames, 5U);
}

TEST(RunStatistics, a_missed_deadline_is_the_machines_unless_the_frame_did_what_it_must_not)
{
    StatisticsRig run;
    const auto late = [](FrameOutput&, CycleMeasures& measures)
    { measures.lateness_of_end = kPeriod + nanoseconds(1); };
    run.frame(late);
    EXPECT_EQ(run.sut.deadlines_missed, 1U);
    EXPECT_EQ(run.sut.machine_late, 1U);
    EXPECT_EQ(run.sut.own_faults, 0U);
    run.frame(
        [&](FrameOutput& output, CycleMeasures& measures)
        {
            late(output, measures);
            measures.allocations = 1;
        });
    EXPECT_EQ(run.sut.deadlines_missed, 2U);
    EXPECT_EQ(run.sut.machine_late, 1U);
    EXPECT_EQ(run.sut.own_faults, 1U);
    run.frame([](FrameOutput&, CycleMeasures& measures) { measures.usage.minor_faults = 1; });
    EXPECT_EQ(run.sut.deadlines_missed, 2U);
    EXPECT_EQ(run.sut.own_faults, 2U);
}

} // namespace

} // namespace tactus::hrtc::test
