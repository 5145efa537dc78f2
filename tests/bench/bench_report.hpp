// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/plot/page.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/bench/stage_series.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tactus::bench
{

/// How the rows came about, beside the machine.
struct RunFacts
{
    int core{-1}; ///< The one that everything was measured on; -1: not held to one.
    bool quick{false};
    std::vector<std::string> options; ///< Those that make it another than a full run, as given.
};

enum class Figures : std::uint8_t
{
    all,
    with_goals,
};
/// A line for each case and figure, its p50, p99 and maximum beside the goals and the peer of the
/// same run.
[[nodiscard]] plot::Table figure_table(const Rows& rows, Figures which);
/// Whether that form suits the rows: one of their figures has several quantiles.
[[nodiscard]] bool has_quantiles(const Rows& rows);

/// For each part a table with a line for each case and whoever did it, a column for each metric,
/// and goals in brackets behind the figure.
[[nodiscard]] std::vector<plot::TitledTable> column_tables(const Rows& rows);

/// figure_table() of the goals as text.
[[nodiscard]] std::string to_goal_table(const Rows& rows);
/// column_tables() as Markdown; a figure that misses its goal is bold.
[[nodiscard]] std::string to_columns(const Rows& rows);
/// Every row, a line for each scene, case and metric.
[[nodiscard]] std::string to_table(const Rows& rows);
/// {"schema":2,"commit","machine","core","quick","options","compiler","rows":[...]}, and "failures"
/// when there are any.
[[nodiscard]] std::string to_json(const Results& results, const RunFacts& facts);
/// Every row, by RFC 4180 with a head.
[[nodiscard]] std::string to_csv(const Rows& rows);
/// An HTML page: pictures where the rows make some, and every row in a table.
[[nodiscard]] std::string to_page(const Results& results, const RunFacts& facts);

/// Rows of the same key together, in the order in which the keys first came.
struct RowGroup
{
    std::string key;
    Rows rows;
};
[[nodiscard]] std::vector<RowGroup> grouped_by(const Rows& rows, std::string Row::*key);

} // namespace tactus::bench
