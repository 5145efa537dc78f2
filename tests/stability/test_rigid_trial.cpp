// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/random.hpp"
#include "tests/shared/trial_length.hpp"
#include "tests/stability/rigid_trial.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{

namespace
{

RigidFigures try_all(std::vector<RigidTrial> trials, std::uint32_t frames, std::uint64_t first_seed)
{
    RigidFigures all;
    const std::size_t stride = has_full_trials() ? 1 : 2;
    for (std::size_t i = 0; i < trials.size(); i += stride)
    {
        RigidTrial& trial = trials[i];
        trial.seed = seed_of(first_seed) + i;
        trial.frames = frames;
        const RigidFigures figures = run_rigid_trial(trial);
        EXPECT_TRUE(figures.crossings.holds()) << figures.crossings.summary();
        EXPECT_TRUE(figures.steps.holds()) << figures.steps.summary();
        all.add(figures);
    }
    return all;
}

TEST(RigidTrial, pegs_plates_gears_and_needles_never_go_through)
{
    const RigidFigures all = try_all(rigid_trials(RigidStage::still), 400, 1);
    EXPECT_GT(all.contacts, trial_length(500));
    EXPECT_LT(all.halted, all.contacts);
}

TEST(RigidTrial, boxes_capsules_hulls_and_meshes_never_go_through_any_shape)
{
    const RigidFigures all = try_all(rigid_trials_on_small_models(), 400, 401);
    EXPECT_GT(all.contacts, trial_length(1'500));
    EXPECT_EQ(all.over_constrained, 0U);
}

TEST(RigidTrial, nor_through_objects_that_turn)
{
    const RigidFigures all = try_all(rigid_trials(RigidStage::turning), 200, 101);
    EXPECT_GT(all.contacts, trial_length(200));
    EXPECT_EQ(all.run_over, 0U);
    EXPECT_EQ(all.over_constrained, 0U);
}

TEST(RigidTrial, nor_through_what_stands_far_away_turned_and_of_another_size)
{
    const RigidFigures all = try_all(rigid_trials(RigidStage::far), 200, 201);
    EXPECT_GT(all.contacts, trial_length(200));
    EXPECT_EQ(all.over_constrained, 0U);
}

TEST(RigidTrial, between_objects_that_close_in_are_run_over_only_where_they_say_so)
{
    const RigidFigures all = try_all(rigid_trials(RigidStage::closing), 600, 301);
    EXPECT_GT(all.contacts, trial_length(2'000));
    EXPECT_GT(all.run_over, trial_length(100)); // Shows that cases occurred.
    EXPECT_GT(all.over_constrained, trial_length(100));
    EXPECT_GT(all.steps.trials, trial_length(50));
}

} // namespace

} // namespace tactus::test
