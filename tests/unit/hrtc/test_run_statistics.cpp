// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/run_statistics.hpp"
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

/// Consecutive frames of two models under one tool.
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
    /// Adds a frame of a tool with or without contact, with this force.
    void touch(bool in_contact, double force_n, ForceOff causes = ForceOff::none)
    {
        tools_[0].in_contact = in_contact;
        forces_[0].push.force_n = Vec3(force_n, 0.0, 0.0);
        forces_[0].causes = causes;
        frame([](FrameOutput&, CycleMeasures&) {});
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

/// Budgets belong to the frame, independent of the models, and count several walks.
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
    EXPECT_EQ(run.sut.deadlines.overruns, 3U);
    EXPECT_EQ(run.sut.frames, 5U);
}

/// A long frame is an overrun if its work is more than a quick frame showed to fit: four times that
/// frame's work.
TEST(RunStatistics, compares_long_frames_with_quick_ones_by_their_work)
{
    for (const std::uint32_t done : {12'000U, 12'001U})
    {
        StatisticsRig run;
        run.frame([](FrameOutput& output, CycleMeasures&) { output.work.budget.spend(3'000); });
        run.frame(
            [done](FrameOutput& output, CycleMeasures& measures)
            {
                output.work.budget.spend(done);
                measures.cpu = kPeriod;
            });
        EXPECT_EQ(run.sut.deadlines.overruns, done == 12'000 ? 0U : 1U);
    }
}

TEST(RunStatistics, takes_no_damping_in_free_air_for_a_force_of_what_is_touched)
{
    StatisticsRig run;
    run.touch(false, 2.0, ForceOff::stall);
    run.touch(false, 0.0);
    run.touch(true, 0.5);
    run.touch(false, 2.0, ForceOff::velocity);
    run.touch(true, 0.25);
    EXPECT_EQ(run.sut.tools[0].max_n, 0.5);
    EXPECT_EQ(run.sut.tools[0].max_step_n, 0.5);
}

TEST(RunStatistics, tells_contact_from_force_and_leaves_out_the_end_of_the_run)
{
    StatisticsRig run;
    run.touch(false, 0.25, ForceOff::stall); // Damping in the air is a force without contact.
    run.touch(true, 0.0, ForceOff::stall);
    run.touch(true, 0.5);
    run.touch(true, 1.0);
    run.touch(true, 3.0, ForceOff::software);
    run.touch(false, 9.0, ForceOff::software | ForceOff::stall);
    EXPECT_EQ(run.sut.contact_frames, 4U);
    EXPECT_EQ(run.sut.force_frames, 3U);
    const ForceCounts& tool = run.sut.tools[0];
    EXPECT_EQ(tool.contact_frames, 4U);
    EXPECT_EQ(tool.force_frames, 3U);
    EXPECT_EQ(tool.max_n, 1.0);
    EXPECT_EQ(tool.max_step_n, 0.5);
}

} // namespace

} // namespace tactus::hrtc::test
