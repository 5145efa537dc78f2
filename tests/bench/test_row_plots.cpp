// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/row_plots.hpp"
#include "tests/shared/count_of.hpp"
#include "tests/shared/markup_reader.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace tactus::bench
{

namespace
{

using test::count_of;

Row row_of(const char* suite, const std::string& test_case, const std::string& by,
           const std::string& setting)
{
    Row row;
    row.suite = suite;
    row.test_case = test_case;
    row.by = by;
    row.setting = setting;
    return row;
}

void add_point(Rows& rows, const std::string& by, const std::string& setting, double error,
               double time_us)
{
    CaseRows line(rows, row_of("error_time", "bunny", by, setting));
    line.add("error p99", error, "diag");
    line.add("p50", time_us / 2.0, "us");
    line.add("p99", time_us, "us");
}

void expect_sound(const plot::Drawing& drawing)
{
    EXPECT_TRUE(test::read_markup("<svg>" + drawing.body + "</svg>").has_value());
}

TEST(ErrorTimePlots, one_a_case_and_a_marker_for_each_setting)
{
    Rows rows;
    add_point(rows, "", "K 64", 1e-4, 40.0);
    add_point(rows, "", "K 128", 1e-5, 80.0);
    add_point(rows, "", "K 32", 0.0, 160.0);
    add_point(rows, "Embree", "whole", 0.0, 10.0);
    CaseRows(rows, row_of("error_time", "cow", "", "K 1")).add("p99", 3.0, "us"); // No error.

    const auto drawings = error_time_plots(rows);

    ASSERT_EQ(drawings.size(), 1U);
    const std::string& body = drawings[0].body;
    expect_sound(drawings[0]);
    EXPECT_EQ(drawings[0].title, "bunny: time");
    EXPECT_EQ(count_of(body, "class=\"marker\""), 4U + 2U); // And two in the legend.
    EXPECT_EQ(count_of(body, "error p99, shares of the diagonal"), 1U);
    EXPECT_EQ(count_of(body, "<title>Tactus, K 128: 10\u207B\u2075, 80</title>"), 1U);
    EXPECT_EQ(count_of(body, "<title>Embree, whole: 0, 10</title>"), 1U);
    EXPECT_EQ(count_of(body, "class=\"mark\""), 1U); // The border of the column for zero.
    EXPECT_LT(body.find("Tactus, K 32:"), body.find("Tactus, K 128:")); // By their errors.
    EXPECT_LT(body.find("Tactus, K 128:"), body.find("Tactus, K 64:"));
}

TEST(ErrorTimePlots, what_another_setting_beats_in_both_is_left_out)
{
    Rows rows;
    add_point(rows, "", "good", 1e-5, 10.0);
    add_point(rows, "", "slower", 1e-5, 11.0);
    add_point(rows, "", "worse", 1e-4, 10.0);
    add_point(rows, "", "fast", 1e-3, 1.0);

    const auto drawings = error_time_plots(rows);

    ASSERT_EQ(drawings.size(), 1U);
    const std::string& body = drawings[0].body;
    EXPECT_EQ(count_of(body, "<title>Tactus, good:"), 1U);
    EXPECT_EQ(count_of(body, "<title>Tactus, fast:"), 1U);
    EXPECT_EQ(count_of(body, "<title>Tactus, slower:"), 0U);
    EXPECT_EQ(count_of(body, "<title>Tactus, worse:"), 0U);
}

TEST(ErrorTimePlots, other_motions_have_no_place_among_those_of_one)
{
    Rows rows;
    add_point(rows, "", "usual", 1e-5, 10.0);
    add_point(rows, "", "slow motion", 1e-6, 1.0);
    for (Row& row : rows)
    {
        row.part = row.setting == "usual" ? "" : "Other motions";
    }
    const auto drawings = error_time_plots(rows);
    ASSERT_EQ(drawings.size(), 1U);
    EXPECT_EQ(count_of(drawings[0].body, "<title>Tactus, usual:"), 1U);
    EXPECT_EQ(count_of(drawings[0].body, "slow motion"), 0U);
}

TEST(ErrorTimePlots, the_largest_error_stands_in_for_quantiles)
{
    Rows rows;
    CaseRows line(rows, row_of("error_time", "cow", "", "K 1"));
    line.add("error max", 1e-3, "diag");
    line.add("p99", 3.0, "us");
    line.add("p99", std::numeric_limits<double>::quiet_NaN(), "us");

    const auto drawings = error_time_plots(rows);

    ASSERT_EQ(drawings.size(), 1U);
    EXPECT_EQ(count_of(drawings[0].body, "error max, shares of the diagonal"), 1U);
    expect_sound(drawings[0]);
}

TEST(GrowthPlots, one_a_part_and_unit_with_the_law_as_a_guide)
{
    Rows rows;
    for (const double faces : {1e3, 1e4, 1e5})
    {
        const std::string name = std::to_string(faces);
        Row ours = row_of("growth", name, "", "");
        ours.part = "near";
        CaseRows line(rows, ours);
        line.add("faces", faces, "");
        line.add("p50", faces / 1e3, "us");
        line.add("p99", faces / 1e2, "us");
        line.add("law", faces / 2e3, "us");
        line.add("nodes", 10.0, "");
        line.add("pools", 10.0, "MiB");
        Row theirs = row_of("growth", name, "Embree", "");
        theirs.part = "near";
        CaseRows(rows, theirs).add("p50", faces / 5e2, "us"); // Of the case's faces.
    }

    const auto drawings = growth_plots(rows);

    ASSERT_EQ(drawings.size(), 3U); // Counts, times, memory.
    for (const plot::Drawing& drawing : drawings)
    {
        EXPECT_EQ(drawing.title, "near");
        expect_sound(drawing);
    }
    const std::string& counts = drawings[0].body;
    const std::string& times = drawings[1].body;
    EXPECT_EQ(count_of(counts, "class=\"marker\""), 3U + 1U);
    EXPECT_EQ(count_of(times, "class=\"marker\""), 9U + 3U);
    EXPECT_EQ(count_of(times, ">p50, Embree</text>"), 1U);
    EXPECT_EQ(count_of(times, ">p99, Tactus</text>"), 1U);
    EXPECT_EQ(count_of(times, ">law</text>"), 1U);
    EXPECT_EQ(count_of(times, "stroke-dasharray=\"1.5 4\""), 2U);
    EXPECT_EQ(count_of(counts, ">law</text>"), 0U);
}

TEST(SkipPlots, bars_of_p99_in_a_group_for_each_setting)
{
    Rows rows;
    for (const char* setting : {"off", "on"})
    {
        for (const char* by : {"", "Embree"})
        {
            CaseRows line(rows, row_of("skip", "scene", by, setting));
            line.add("p50", 1.0, "us");
            line.add("p99", 3.25, "us");
        }
    }
    const auto drawings = skip_plots(rows);
    ASSERT_EQ(drawings.size(), 1U);
    expect_sound(drawings[0]);
    EXPECT_EQ(count_of(drawings[0].body, "<rect "), 4U);
    EXPECT_EQ(count_of(drawings[0].body, ">3.25</text>"), 4U);
    EXPECT_EQ(count_of(drawings[0].body, ">off</text>"), 1U);
    EXPECT_EQ(count_of(drawings[0].body, ">p99, us</text>"), 1U);
}

TEST(RowPlots, rows_that_make_no_picture_make_none)
{
    Rows rows;
    CaseRows line(rows, row_of("any", "cow", "", ""));
    line.add("faces", 1.0, "");
    line.add("error p99", 1.0, "diag");
    line.add("size", 1.0, "B");
    EXPECT_TRUE(error_time_plots(rows).empty());
    EXPECT_TRUE(growth_plots(rows).empty());
    EXPECT_TRUE(skip_plots(rows).empty());
    EXPECT_TRUE(series_plots({}).empty());
}

TEST(SeriesPlots, have_a_layer_for_each_stage)
{
    const StageSeries series{"frame", "tiny", {0, 1}, {{{1, 2}, {1, 2}, {1, 2}, {1, 2}}}};
    const auto drawings = series_plots({series});
    ASSERT_EQ(drawings.size(), 1U);
    expect_sound(drawings[0]);
    EXPECT_EQ(count_of(drawings[0].body, "class=\"area\""), 4U + 4U);
    EXPECT_EQ(count_of(drawings[0].body, ">T_B refit</text>"), 1U);
}

} // namespace

} // namespace tactus::bench
