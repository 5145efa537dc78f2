// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/random.hpp"
#include "tests/stability/rigid_trial.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{

namespace
{

TEST(RigidTrial, pegs_plates_gears_and_needles_never_go_through)
{
    RigidFigures all;
    std::uint64_t seed = seed_of(1);
    for (RigidTrial& trial : rigid_trials())
    {
        trial.seed = seed++;
        trial.frames = 400;
        const RigidFigures figures = run_rigid_trial(trial);
        EXPECT_TRUE(figures.crossings.holds()) << figures.crossings.summary();
        all.add(figures);
    }
    EXPECT_GT(all.contacts, 500U);
    EXPECT_LT(all.frozen, all.contacts);
}

} // namespace

} // namespace tactus::test
