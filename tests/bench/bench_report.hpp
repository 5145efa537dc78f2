// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/bench_row.hpp"

#include <string>

namespace tactus::bench
{

/// How the rows came about, beside the machine.
struct RunFacts
{
    int core{-1}; ///< The one that everything was measured on; -1: not held to one.
    bool quick{false};
};

/// The goals: a line for each case and figure that has one, its p50, p99 and maximum beside the
/// goals and the peer of the same run.
[[nodiscard]] std::string to_goal_table(const Rows& rows);
/// Markdown: for each part a table with a line for each case and whoever did it, a column for each
/// metric. Goals in brackets behind the figure, which is bold when it isn't met.
[[nodiscard]] std::string to_columns(const Rows& rows);
/// Every row, a line for each scene, case and metric.
[[nodiscard]] std::string to_table(const Rows& rows);
/// {"schema":2,"commit","machine","core","quick","compiler","rows":[...]}.
[[nodiscard]] std::string to_json(const Rows& rows, const RunFacts& facts);

} // namespace tactus::bench
