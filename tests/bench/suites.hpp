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

/// The cases of the suite `frame`, in the order of its table; those that only run when named
/// included.
[[nodiscard]] std::vector<std::string> frame_case_names();

/// Runs the chosen cases, each measured on one core, and adds their rows. Returns a line when a
/// case could not be run or gave wrong answers.
[[nodiscard]] std::optional<std::string> run_frame_suite(const BenchOptions& options, Rows& rows);

} // namespace tactus::bench
