// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/bench_row.hpp"
#include "tests/shared/trial_figures.hpp"

#include <string>

namespace tactus::bench
{

/// Adds the figures of one claim: trials, worst error and violations; the goals of the latter two
/// are met if the claim holds.
void add_trial_rows(const test::TrialFigures& figures, const std::string& part, Rows& rows);

/// Facts about a run, besides the machine.
struct RunFacts
{
    int core{-1}; ///< Core of all measurements; -1: not pinned.
    bool quick{false};
    std::vector<std::string> options; ///< Options that make this less than a full run, as given.
};

/// One line for each row, below one for its case, and the number of goals met.
[[nodiscard]] std::string to_text(const Rows& rows);

/// Report: {"schema":2,"commit","machine","core","quick","options","compiler","rows":[...]}, and
/// "failures" if there are any.
[[nodiscard]] std::string to_json(const Results& results, const RunFacts& facts);

} // namespace tactus::bench
