// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/bench_options.hpp"
#include "tests/bench/bench_row.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::bench
{

/// A set of cases that make one table.
struct Suite
{
    const char* name;
    /// In the order of the table; those that only run when named included.
    std::vector<std::string> (*case_names)();
    /// Runs the chosen cases, each on one core, and adds their rows. Returns a line when a case
    /// could not be run or gave wrong answers.
    std::optional<std::string> (*run)(const BenchOptions& options, Rows& rows);
    /// What is printed unless every row is asked for.
    std::string (*to_table)(const Rows& rows);
    /// Its goals are laws: the program leaves with code 1 when one isn't met, asked or not.
    bool always_checks{false};
};

[[nodiscard]] Suite encoder_suite();
[[nodiscard]] Suite force_suite();
[[nodiscard]] Suite frame_suite();
[[nodiscard]] Suite stability_suite();
[[nodiscard]] Suite stream_suite();
[[nodiscard]] Suite table1_suite();

} // namespace tactus::bench
