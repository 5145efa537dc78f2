// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/pair_trial.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace tactus::bench
{

namespace
{

/// Three faces a side, the last of each a twin of the first; at two places.
PairTruth small_truth()
{
    return {{{{0, 0}, {1, 1}}, {}}, {0.0, 0.5}, {0, 1, 0}, {0, 1, 0}};
}

TEST(JudgePairs, counts_what_is_planted)
{
    const PairTruth truth = small_truth();
    PairAnswers answers;
    answers.do_meet = {false, true};
    answers.meeting = {{{1, 1}, {1, 0}, {2, 2}, {0, 0}}, {{0, 1}}};
    answers.distances_m = {0.125, 0.25};

    const PairErrors any = judge_pairs(answers, truth, PairQuestion::any);
    const PairErrors all = judge_pairs(answers, truth, PairQuestion::all_pairs);
    const PairErrors distance = judge_pairs(answers, truth, PairQuestion::distance);

    EXPECT_EQ(any.missed, 1U);
    EXPECT_EQ(any.invented, 1U);
    EXPECT_EQ(all.missed, 0U); // The twins stand for the first faces.
    EXPECT_EQ(all.invented, 2U);
    EXPECT_EQ(judge_pairs(answers, truth, PairQuestion::contacts).invented, 2U);
    EXPECT_EQ(distance.largest_m, 0.25);
    answers.meeting[0].clear();
    EXPECT_EQ(judge_pairs(answers, truth, PairQuestion::all_pairs).missed, 2U);
}

TEST(JudgePairs, a_distance_that_is_no_number_is_infinitely_wrong)
{
    PairAnswers answers;
    answers.distances_m = {std::numeric_limits<double>::quiet_NaN(), 0.5};
    EXPECT_EQ(judge_pairs(answers, small_truth(), PairQuestion::distance).largest_m,
              std::numeric_limits<double>::infinity());
}

} // namespace

} // namespace tactus::bench
