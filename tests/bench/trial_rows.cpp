// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/trial_rows.hpp"

#include <fmt/format.h>

namespace tactus::bench
{

namespace
{

constexpr const char* kTrials = "trials";
constexpr const char* kWorst = "worst error";
constexpr const char* kViolations = "violations";

std::string marked(const Row& row, const std::string& text)
{
    return row.is_met() ? text : "**" + text + "**";
}

} // namespace

void add_trial_rows(const test::TrialFigures& figures, const std::string& part, Rows& rows)
{
    Row common;
    common.suite = "stability";
    common.part = part;
    common.test_case = figures.name;
    common.scene = figures.name;
    CaseRows claim(rows, common);
    claim.add(kTrials, static_cast<double>(figures.trials), "");
    claim.add(kWorst, figures.worst, figures.unit, figures.bound);
    claim.add(kViolations, static_cast<double>(figures.violations), "", 0.0);
}

std::string to_trial_table(const Rows& rows)
{
    std::string text = "| case | trials | worst error | bound | violations |\n"
                       "| --- | --- | --- | --- | --- |\n";
    for (const Row& row : rows)
    {
        if (row.metric == kTrials)
        {
            text += fmt::format("| {} | {:.0f} ", row.test_case, row.value);
        }
        else if (row.metric == kWorst)
        {
            text += fmt::format("| {} | {:.3g} {} ", marked(row, fmt::format("{:.3g}", row.value)),
                                row.goal.value_or(0.0), row.unit);
        }
        else
        {
            text += fmt::format("| {} |\n", marked(row, fmt::format("{:.0f}", row.value)));
        }
    }
    return text;
}

} // namespace tactus::bench
