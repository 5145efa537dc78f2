// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/bench_report.hpp"
#include "tests/bench/suites.hpp"
#include "tests/shared/markup_reader.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <string>
#include <vector>

namespace tactus::bench
{

namespace
{

Row full_row()
{
    Row row;
    row.suite = "frame";
    row.part = "a, part";
    row.test_case = "the \"case\"";
    row.by = "us";
    row.setting = "K 64\nK 32";
    row.metric = "p99";
    row.value = 0.1;
    row.unit = "us";
    row.scene = "sphere";
    row.seed = 7;
    row.frames = 1'500;
    row.hash = 0xABC;
    row.goal = 0.05;
    row.peer = "Embree";
    row.peer_value = 1e-7;
    return row;
}

/// The fields of each record, by RFC 4180; nothing when it is broken.
std::vector<std::vector<std::string>> read_csv(const std::string& text)
{
    std::vector<std::vector<std::string>> records{{""}};
    bool is_quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i)
    {
        const bool is_end = !is_quoted && text.compare(i, 2, "\r\n") == 0;
        if (text[i] == '"' && is_quoted && text.compare(i, 2, "\"\"") == 0)
        {
            records.back().back() += text[i++];
        }
        else if (text[i] == '"')
        {
            is_quoted = !is_quoted;
        }
        else if (text[i] == ',' && !is_quoted)
        {
            records.back().emplace_back();
        }
        else if (is_end)
        {
            records.push_back({""});
            ++i;
        }
        else if (!is_quoted && (text[i] == '\r' || text[i] == '\n'))
        {
            return {};
        }
        else
        {
            records.back().back() += text[i];
        }
    }
    records.pop_back(); // Behind the last end of a line.
    return is_quoted ? std::vector<std::vector<std::string>>{} : records;
}

TEST(ToCsv, a_row_is_a_record_whatever_is_in_it)
{
    Row bare;
    bare.value = std::numeric_limits<double>::infinity();
    const auto records = read_csv(to_csv({full_row(), bare}));
    ASSERT_EQ(records.size(), 3U);
    for (const std::vector<std::string>& record : records)
    {
        ASSERT_EQ(record.size(), 19U);
    }
    const std::vector<std::string> expected{
        "frame",      "a, part", "the \"case\"", "us",
        "K 64\nK 32", "p99",     "0.1",          "us",
        "0.05",       "false",   "Embree",       "1e-07",
        "sphere",     "7",       "1500",         "0000000000000abc"};
    EXPECT_EQ(std::vector(records[1].begin(), records[1].begin() + 16), expected);
    EXPECT_EQ(records[0][9], "met");
    EXPECT_EQ(records[2][6], "inf");
    EXPECT_EQ(records[2][8] + records[2][9] + records[2][10] + records[2][11], "");
    EXPECT_EQ(records[1][16], records[2][16]);
    EXPECT_FALSE(records[1][18].empty());
}

TEST(ToCsv, without_rows_there_is_the_head)
{
    EXPECT_EQ(read_csv(to_csv({})).size(), 1U);
}

TEST(ToJson, has_settings_and_what_failed)
{
    const auto json = nlohmann::json::parse(to_json({{full_row()}, {}, {"frame x: broken"}}, {}));
    EXPECT_EQ(json["rows"][0]["setting"], "K 64\nK 32");
    EXPECT_EQ(json["failures"], nlohmann::json::array({"frame x: broken"}));
    EXPECT_FALSE(nlohmann::json::parse(to_json({{full_row()}, {}, {}}, {})).contains("failures"));
}

TEST(ToPage, has_every_row_and_the_verdict)
{
    Results results;
    results.rows.push_back(full_row());
    Row other;
    other.suite = "encoder";
    other.test_case = "cow";
    other.scene = "cow";
    CaseRows(results.rows, other).add("base faces", 704.0, "");
    CaseRows(results.rows, other).add("time.p50", 1.0, "s");
    other.part = "second";
    CaseRows(results.rows, other).add("time.p50", 2.0, "s", 3.0);
    CaseRows(results.rows, other).add("time.p99", 9.0, "s", 3.0);
    results.series.push_back({"frame", "tiny", {0.0, 1.0}, {}});
    results.failures = {"frame x: <broken>"};

    const std::string page = to_page(results, {});

    const auto read = test::read_markup(page);
    ASSERT_TRUE(read.has_value());
    for (const char* text :
         {"frame x: <broken>", "1 of 3 goals met", "frame", "encoder", "second",
          "the \"case\" (sphere)", "0.1 (0.05)", "704", "2.00 / 9.00", "NOT MET: p99"})
    {
        EXPECT_TRUE(read->has_text(text)) << text;
    }
    EXPECT_EQ(read->count("svg"), 1U);
    EXPECT_EQ(read->count("h2"), 2U);
    EXPECT_EQ(to_page(results, {}).size(), page.size());
}

TEST(ToPage, without_rows_is_a_page)
{
    EXPECT_TRUE(test::read_markup(to_page({}, {})).has_value());
}

TEST(ToGoalTable, leaves_out_what_has_no_goal)
{
    Rows rows;
    Row common;
    common.test_case = "bunny";
    CaseRows lines(rows, common);
    lines.add("frame.p50", 1.0, "us", 2.0).peer = "Embree";
    lines.add("frame.p99", 5.0, "us", 4.0);
    lines.add("frame.max", 6.0, "us");
    lines.add("splits", 3.0, "");
    EXPECT_EQ(to_goal_table(rows),
              "case            figure                p50 / p99 / max         unit    goal          "
              "                              peer, same run\n"
              "bunny           frame                 1.00 / 5.00 / 6.00      us      2.00 / 4.00 / "
              "-       NOT MET: p99          Embree 0.00 / - / -\n"
              "1 of 2 goals met\n");
    EXPECT_EQ(figure_table(rows, Figures::all).lines.size(), 2U);
}

TEST(CheckHashes, refuses_times_of_frames_that_nothing_looks_at)
{
    Row row = full_row();
    EXPECT_EQ(check_hashes(std::vector{row}), std::nullopt);
    row.hash = 0;
    for (const char* unit : {"s", "ms", "us", "ns"})
    {
        row.unit = unit;
        const CaseFailure refused = check_hashes(std::vector{full_row(), row});
        ASSERT_TRUE(refused.has_value());
        EXPECT_EQ(*refused, "p99: its result goes unused, no hash is over its 1500 frames");
    }
    row.unit = "B";
    EXPECT_EQ(check_hashes(std::vector{row}), std::nullopt);
    row.unit = "us";
    row.frames = 0;
    EXPECT_EQ(check_hashes(std::vector{row}), std::nullopt);
    EXPECT_EQ(check_hashes({}), std::nullopt);
}

} // namespace

} // namespace tactus::bench
