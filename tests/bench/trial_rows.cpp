// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/trial_rows.hpp"

namespace tactus::bench
{

void add_trial_rows(const test::TrialFigures& figures, const std::string& part, Rows& rows)
{
    Row common;
    common.suite = "stability";
    common.part = part;
    common.test_case = figures.name;
    common.scene = figures.name;
    CaseRows claim(rows, common);
    claim.add("trials", static_cast<double>(figures.trials), "");
    claim.add("worst error", figures.worst, figures.unit, figures.bound);
    claim.add("violations", static_cast<double>(figures.violations), "", 0.0);
}

} // namespace tactus::bench
