// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/trial_rows.hpp"

#include <gtest/gtest.h>

namespace tactus::bench
{

namespace
{

test::TrialFigures figures_of(const char* name, double worst, std::uint64_t violations)
{
    return {name, 10, worst, 1.0, "of the law", violations, {}};
}

TEST(TrialRows, a_claim_that_holds_meets_its_goals)
{
    Rows rows;
    add_trial_rows(figures_of("kernel", 0.5, 0), "kernels", rows);

    EXPECT_EQ(count_goals(rows).met, count_goals(rows).goals);
    EXPECT_EQ(to_trial_table(rows), "| case | trials | worst error | bound | violations |\n"
                                    "| --- | --- | --- | --- | --- |\n"
                                    "| kernel | 10 | 0.5 | 1 of the law | 0 |\n");
}

TEST(TrialRows, a_violation_or_an_error_above_its_bound_misses_a_goal_and_is_bold)
{
    Rows violated;
    add_trial_rows(figures_of("bracket", 0.5, 2), "brackets", violated);
    Rows too_far;
    add_trial_rows(figures_of("bracket", 1.25, 0), "brackets", too_far);

    EXPECT_EQ(count_goals(violated).met + 1, count_goals(violated).goals);
    EXPECT_EQ(count_goals(too_far).met + 1, count_goals(too_far).goals);
    EXPECT_NE(to_trial_table(violated).find("| **2** |"), std::string::npos);
    EXPECT_NE(to_trial_table(too_far).find("| **1.25** |"), std::string::npos);
}

} // namespace

} // namespace tactus::bench
