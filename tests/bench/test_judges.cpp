// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Shows that the judges can find errors: one that finds none would show rows without a fault.

#include "rt_core/math/infinity.hpp"
#include "tests/bench/bench_report.hpp"
#include "tests/bench/cases.hpp"
#include "tests/bench/force_rows.hpp"
#include "tests/bench/judged_queries.hpp"
#include "tests/bench/mesh_touch.hpp"
#include "tests/bench/suites.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace tactus::bench
{
namespace
{

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

TEST(Judges, of_touch_count_what_is_missed_and_invented_but_for_what_is_near_the_radius)
{
    const std::vector<double> truth{0.5, 0.5, 0.5, 0.5, 0.995, 1.005, 1.5, 1.5, 1.5, 1.5};
    const std::vector<double> told{0.9, 1.1, kInfinity, kNotANumber, 1.5,
                                   0.5, 1.1, 0.9,       kNotANumber, 0.99};

    const TouchErrors errors = judge_touch(told, truth, 1.0, 0.01);

    EXPECT_EQ(errors.missed, 3U);
    EXPECT_EQ(errors.invented, 2U);
}

TEST(Judges, of_distances_see_errors_within_the_band_and_what_is_no_number)
{
    const std::vector<double> truth{1.0, 1.9, 5.0, 5.0};
    const std::vector<double> told{1.25, kInfinity, kInfinity, 3.0};

    EXPECT_DOUBLE_EQ(largest_error_m(told, truth, std::vector(4, 2.0)), 0.25);
    EXPECT_DOUBLE_EQ(largest_error_m(told, truth, std::vector{2.0, 2.0, 2.0, kInfinity}), 2.0);
    EXPECT_EQ(largest_error_m(std::vector{kNotANumber}, std::vector{1.0}, std::vector{2.0}),
              kInfinity);
}

TEST(Judges, of_nearest_points_see_those_beside_the_surface_and_those_too_far_away)
{
    const std::vector<test::Face> faces{
        {Vec3f{-9.0F, -9.0F, 0.0F}, Vec3f{9.0F, -9.0F, 0.0F}, Vec3f{0.0F, 9.0F, 0.0F}}};
    const test::FaceTree tree(faces);
    const auto error_of = [&](const Vec3& told_m, double distance_m)
    {
        return largest_point_error_m({LeastTimes(1), {distance_m}, {told_m}, 0, std::nullopt},
                                     {{Vec3(0, 0, 1)}, {1.0}}, tree);
    };
    EXPECT_EQ(error_of(Vec3(0, 0, 0), 1.0), 0.0);
    EXPECT_DOUBLE_EQ(error_of(Vec3(0, 0, 2), 1.0), 2.0); // Equally near, but not on the surface.
    EXPECT_DOUBLE_EQ(error_of(Vec3(0, 0.75, 0), 1.0), 0.25);
    EXPECT_EQ(error_of(Vec3(5, 5, 5), kInfinity), 0.0); // No answer.
}

/// Three faces a side, the last of each equal to the first; at two places.
TEST(Judges, of_pairs_count_what_is_planted)
{
    const PairTruth truth{{{{0, 0}, {1, 1}}, {}}, {0.0, 0.5}, {0, 1, 0}, {0, 1, 0}};
    PairAnswers answers;
    answers.do_meet = {false, true};
    answers.meeting = {{{1, 1}, {1, 0}, {2, 2}, {0, 0}}, {{0, 1}}};
    answers.distances_m = {0.125, 0.25};
    const auto errors = [&](PairQuestion question)
    { return judge_pairs(answers, truth, question); };

    EXPECT_EQ(errors(PairQuestion::any).missed, 1U);
    EXPECT_EQ(errors(PairQuestion::any).invented, 1U);
    // The duplicates stand for the first faces.
    EXPECT_EQ(errors(PairQuestion::all_pairs).missed, 0U);
    EXPECT_EQ(errors(PairQuestion::contacts).invented, 2U);
    EXPECT_EQ(errors(PairQuestion::distance).largest_m, 0.25);
    answers.meeting[0].clear();
    EXPECT_EQ(errors(PairQuestion::all_pairs).missed, 2U);
    answers.distances_m[0] = kNotANumber;
    EXPECT_EQ(errors(PairQuestion::distance).largest_m, kInfinity);
}

TEST(Judges, of_a_trial_miss_a_goal_by_a_violation_and_by_an_error_above_its_bound_or_no_number)
{
    const auto missed = [](double worst, std::uint64_t violations)
    {
        Rows rows;
        add_trial_rows({"bounded", 10, worst, 1.0, "of the law", violations, {}}, "brackets", rows);
        const GoalCount count = count_goals(rows);
        return count.goals - count.met;
    };
    EXPECT_EQ(missed(0.5, 0), 0U);
    EXPECT_EQ(missed(0.5, 2), 1U);
    EXPECT_EQ(missed(1.25, 0), 1U);
    EXPECT_EQ(missed(kNotANumber, 0), 1U);
}

TEST(Judges, of_a_case_refuse_times_of_frames_that_nothing_looks_at)
{
    Row row;
    row.unit = "us";
    row.frames = 1'500;
    EXPECT_THROW(check_hashes(std::vector{row}), Failure);
    row.hash = 1;
    EXPECT_NO_THROW(check_hashes(std::vector{row}));
}

} // namespace

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
