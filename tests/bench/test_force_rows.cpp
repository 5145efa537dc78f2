// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/cases.hpp"
#include "tests/bench/force_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace tactus::bench
{

namespace
{

constexpr Touch kTouch{0.5e-3, 1e-3, 1'000.0};

/// Ten frames on a plane, the sphere always at its rest position.
struct PlaneTouch
{
    PlaneTouch()
    {
        trace.force_us = LeastTimes(10);
        for (std::size_t i = 0; i < 10; ++i)
        {
            goals_m.emplace_back(0.1e-3 * static_cast<double>(i), 0.0, -0.5e-3);
            rests_m.emplace_back(0.1e-3 * static_cast<double>(i), 0.0, 0.5e-3);
            ToolOutput output;
            output.proxy_m = rests_m.back();
            output.force_n = Vec3(0.0, 0.0, 1.0);
            output.in_contact = true;
            trace.outputs.push_back(output);
            trace.force_us.keep(i, static_cast<double>(i));
        }
        trace.frame_us = trace.force_us;
        trace.allocations = 0;
    }
    [[nodiscard]] ForceFigures measure() const
    {
        return measure_forces(trace, goals_m, rests_m, kTouch, 0.2e-3);
    }

    ForceTrace trace;
    std::vector<Vec3> goals_m;
    std::vector<Vec3> rests_m;
};

TEST(ForceRows, a_sphere_is_stuck_when_it_is_frozen_lost_behind_or_nowhere)
{
    PlaneTouch sut;
    sut.trace.outputs[1].halted = true;
    sut.trace.outputs[3].in_contact = false;
    sut.trace.outputs[5].proxy_m = sut.rests_m[5] - Vec3(0.19e-3, 0.0, 0.0);
    EXPECT_EQ(sut.measure().stuck, 2U);
    sut.trace.outputs[5].proxy_m = sut.rests_m[5] - Vec3(0.21e-3, 0.0, 0.0);
    EXPECT_EQ(sut.measure().stuck, 3U);
    sut.trace.outputs[7].proxy_m.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(sut.measure().stuck, 4U);
}

Rows rows_of(const PlaneTouch& touch, const ForceGoals& goals, std::optional<double> coarser_n)
{
    Rows rows;
    Row common;
    common.test_case = "5k";
    common.by = "Tactus";
    CaseRows lines(rows, common);
    add_force_rows(lines, touch.trace, touch.measure(), goals, coarser_n);
    return rows;
}

TEST(ForceRows, each_law_that_is_broken_misses_its_goal)
{
    const ForceGoals goals{9.0, 0.1, 0.1, 0.1};
    const auto missed = [&](const PlaneTouch& touch)
    {
        const GoalCount count = count_goals(rows_of(touch, goals, 1.0));
        return count.goals - count.met;
    };
    PlaneTouch sut;
    EXPECT_EQ(count_goals(rows_of(sut, goals, 1.0)).goals, 7U);
    EXPECT_EQ(missed(sut), 0U);
    sut.trace.allocations = 1;
    EXPECT_EQ(missed(sut), 1U);
    sut.trace.outputs[2].halted = true;
    EXPECT_EQ(missed(sut), 2U);
    sut.trace.outputs[9].force_n.x() = 0.2;
    EXPECT_EQ(missed(sut), 5U); // Missed: p99 and maximum of ten, and the step.
    sut.trace.outputs[9].force_n.x() = 1.1;
    EXPECT_EQ(missed(sut), 6U); // Missed too: the error exceeds that on the coarser mesh.
    sut.trace.outputs[9].force_n.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(missed(sut), 6U);
}

TEST(ForceRows, tell_how_far_behind_a_fast_hand_a_sphere_was_and_when_it_is_on_it_again)
{
    PlaneTouch sut;
    sut.trace.planes = {1, 2, 3, 4, 5, 6, 7, 8, 9, 99};
    for (std::size_t i = 2; i < 7; ++i)
    {
        sut.trace.outputs[i].under_way = true;
        sut.trace.outputs[i].cut_short = i < 5;
        sut.trace.outputs[i].lag_m = 1e-3 * static_cast<double>(8 - i);
    }
    const auto value_of = [&](const char* metric)
    {
        Rows rows;
        CaseRows lines(rows, Row{});
        add_lag_rows(lines, sut.trace, 4);
        const auto found = std::ranges::find(rows, metric, &Row::metric);
        return found == rows.end() ? -1.0 : found->value;
    };
    EXPECT_EQ(value_of("frames cut short"), 3.0);
    EXPECT_EQ(value_of("planes.max"), 99.0);
    EXPECT_NEAR(value_of("largest lag"), 6.0, 1e-12);
    EXPECT_NEAR(value_of("on the hand again after"), 3.0, 1e-12);
    for (ToolOutput& output : sut.trace.outputs)
    {
        output.under_way = true;
    }
    EXPECT_FALSE(value_of("on the hand again after") <= kReturn_ms);
}

} // namespace

} // namespace tactus::bench
