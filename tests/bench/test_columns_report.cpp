// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/bench_report.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace tactus::bench
{

namespace
{

Row row_of(const std::string& part, const std::string& test_case, const std::string& by)
{
    Row row;
    row.part = part;
    row.test_case = test_case;
    row.scene = test_case;
    row.by = by;
    return row;
}

TEST(ToColumns, one_part_without_authors_is_one_table)
{
    Rows rows;
    Row cow = row_of("", "cow", "");
    cow.scene = "bumpy-sphere-5804";
    CaseRows(rows, cow).add("faces", 5'804.0, "");
    CaseRows(rows, row_of("", "igea", "")).add("faces", 268'686.0, "");

    EXPECT_EQ(to_columns(rows), "| model | faces |\n"
                                "| --- | --- |\n"
                                "| cow (bumpy-sphere-5804) | 5804 |\n"
                                "| igea | 268686 |\n");
}

TEST(ToColumns, lines_of_different_columns_leave_cells_empty)
{
    Rows rows;
    CaseRows ours(rows, row_of("", "cow", "us"));
    ours.add("time", 1.23456, "s");
    CaseRows theirs(rows, row_of("", "cow", "them"));
    theirs.add("error", std::numeric_limits<double>::infinity(), "diag");

    EXPECT_EQ(to_columns(rows), "| model | by | time, s | error, diag |\n"
                                "| --- | --- | --- | --- |\n"
                                "| cow | us | 1.23 |  |\n"
                                "| cow | them |  | none |\n");
}

TEST(ToColumns, goals_stand_in_brackets_and_missed_figures_are_bold)
{
    Rows rows;
    CaseRows file(rows, row_of("Files", "cow", ""));
    file.add("peak", 400.4, "B", 350.0);
    file.add("base faces", 499.0, "", 500.0);

    EXPECT_EQ(to_columns(rows), "Files:\n\n"
                                "| model | peak, B | base faces |\n"
                                "| --- | --- | --- |\n"
                                "| cow | **400** (350) | 499 (500) |\n"
                                "\n1 of 2 goals met\n");
}

TEST(ToColumns, rows_of_a_part_stand_together_wherever_they_came)
{
    Rows rows;
    CaseRows(rows, row_of("A", "cow", "")).add("x", 1.0, "");
    CaseRows(rows, row_of("B", "cow", "")).add("y", 2.0, "");
    CaseRows(rows, row_of("A", "igea", "")).add("x", 3.0, "");

    EXPECT_EQ(to_columns(rows), "A:\n\n| model | x |\n| --- | --- |\n| cow | 1 |\n| igea | 3 |\n"
                                "\nB:\n\n| model | y |\n| --- | --- |\n| cow | 2 |\n");
}

} // namespace

} // namespace tactus::bench
