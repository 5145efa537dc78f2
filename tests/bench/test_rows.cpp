// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/bench_report.hpp"
#include "tests/bench/suites.hpp"
#include "tests/bench/trial_rows.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>

namespace tactus::bench
{

namespace
{

Row timed_row()
{
    Row row;
    row.metric = "p99";
    row.value = 0.1;
    row.unit = "us";
    row.frames = 1'500;
    row.hash = 0xABC;
    return row;
}

TEST(Rows, no_number_meets_a_goal_only_when_it_is_one)
{
    Row row = timed_row();
    EXPECT_TRUE(row.is_met());
    row.goal = 0.05;
    EXPECT_FALSE(row.is_met());
    row.is_least = true;
    EXPECT_TRUE(row.is_met());
    row.value = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(row.is_met());
}

TEST(Rows, of_a_trial_miss_a_goal_by_a_violation_or_an_error_above_its_bound)
{
    const auto missed = [](double worst, std::uint64_t violations)
    {
        Rows rows;
        add_trial_rows({"bracket", 10, worst, 1.0, "of the law", violations, {}}, "brackets", rows);
        const GoalCount count = count_goals(rows);
        return count.goals - count.met;
    };
    EXPECT_EQ(missed(0.5, 0), 0U);
    EXPECT_EQ(missed(0.5, 2), 1U);
    EXPECT_EQ(missed(1.25, 0), 1U);
}

TEST(Rows, are_in_the_json_with_what_failed)
{
    Row row = timed_row();
    row.goal = 0.05;
    const auto json = nlohmann::json::parse(to_json({{row}, {"frame x: broken"}}, {}));
    EXPECT_EQ(json["rows"][0]["value"], 0.1);
    EXPECT_EQ(json["rows"][0]["met"], false);
    EXPECT_EQ(json["rows"][0]["hash"], "0000000000000abc");
    EXPECT_EQ(json["failures"], nlohmann::json::array({"frame x: broken"}));
}

TEST(CheckHashes, refuses_times_of_frames_that_nothing_looks_at)
{
    Row row = timed_row();
    EXPECT_EQ(check_hashes(std::vector{row}), std::nullopt);
    row.hash = 0;
    for (const char* unit : {"s", "ms", "us", "ns"})
    {
        row.unit = unit;
        EXPECT_EQ(check_hashes(std::vector{timed_row(), row}),
                  "p99: its result goes unused, no hash is over its 1500 frames");
    }
    row.unit = "B";
    EXPECT_EQ(check_hashes(std::vector{row}), std::nullopt);
}

} // namespace

} // namespace tactus::bench
