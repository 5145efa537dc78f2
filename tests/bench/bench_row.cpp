// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/bench_row.hpp"

namespace tactus::bench
{

Row& CaseRows::add(const std::string& metric, double value, const std::string& unit,
                   std::optional<double> goal)
{
    Row& row = rows_.emplace_back(common_);
    row.metric = metric;
    row.value = value;
    row.unit = unit;
    row.goal = goal;
    return row;
}

GoalCount count_goals(const Rows& rows)
{
    GoalCount count;
    for (const Row& row : rows)
    {
        count.goals += row.goal ? 1U : 0U;
        count.met += row.goal && row.is_met() ? 1U : 0U;
    }
    return count;
}

} // namespace tactus::bench
