// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I2: nothing drifts; splits and merges, touches and rests return to the same state.

#include "tests/shared/random.hpp"
#include "tests/stability/day_trial.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace tactus::test
{

namespace
{

TEST(LongRun, random_splits_and_merges_return_to_the_same_state)
{
    const TrialFigures sut = run_split_merge_trial(small_model(0), 200'000, seed_of(20'261'400));
    std::printf("%s\n", sut.summary().c_str());
    EXPECT_GE(sut.trials, 200'000U);
    EXPECT_TRUE(sut.holds());
}

TEST(LongRun, touches_return_to_the_same_rest_and_a_pressed_proxy_does_not_creep)
{
    const DayFigures sut = run_day_trial(small_model(0), 24, seed_of(20'261'410));
    std::printf("%s\n%s\n%.0f s simulated\n", sut.returns.summary().c_str(),
                sut.creep.summary().c_str(), sut.simulated_s);
    EXPECT_TRUE(sut.returns.holds());
    EXPECT_TRUE(sut.creep.holds());
}

} // namespace

} // namespace tactus::test
