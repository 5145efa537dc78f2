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

} // namespace tactus::bench
