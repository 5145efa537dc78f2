// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/run_statistics.hpp"
#include "tests/unit/hrtc/period.hpp"

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
        sut.add(output, forces_, measures);
    }

    RunStatistics sut{kTools, kPairs, kModels, kPeriod};

private:
    std::array<ToolOutput, kTools> tools_{};
    std::array<PairOutput, kPairs> pairs_{};
    std::array<ModelOutput, kModels> models_{};
    std::array<ToolForce, kTools> forces_{};
    FrameOutput output_;
    CycleMeasures measures_;
};

/// Budgets are the frame's, whatever models there are, and so many walks.
TEST(RunStatistics, counts_a_frame_as_over_budget_from_one_beyond_what_it_may_do)
{
    StatisticsRig run;
    const auto with = [&run](auto change)
    {
        run.frame([change](FrameOutput& output, CycleMeasures& measures)
                  { change(output.work, measures.budgets); });
        return run.sut.deadlines.cycles_with(CycleFlag::over_work);
    };
    EXPECT_EQ(
        with([](WorkCounters& work, const Budgets& budgets) { work.splits = budgets.splits; }), 0U);
    EXPECT_EQ(
        with([](WorkCounters& work, const Budgets& budgets) { work.splits = budgets.splits + 1; }),
        1U);
    EXPECT_EQ(with([](WorkCounters& work, const Budgets& budgets)
                   { work.nodes_visited = 2 * kFrameWalks * budgets.nodes; }),
              1U);
    EXPECT_EQ(with([](WorkCounters& work, const Budgets& budgets)
                   { work.nodes_visited = 2 * kFrameWalks * budgets.nodes + 1; }),
              2U);
    EXPECT_EQ(with([](WorkCounters& work, const Budgets& budgets)
                   { work.requests = budgets.requests + budgets.regions + 1; }),
              3U);
    EXPECT_EQ(run.sut.deadlines.own_faults, 3U);
    EXPECT_EQ(run.sut.frames, 5U);
}

} // namespace

} // namespace tactus::hrtc::test
