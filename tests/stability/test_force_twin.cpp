// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// The level of detail adds no step to the force: while faces are split and merged and pages come
/// in under resting, sliding and tapping tools, the force changes as on the full mesh.

#include "tests/shared/random.hpp"
#include "tests/stability/force_twin_trial.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace tactus::test
{

namespace
{

constexpr std::uint32_t kFrames = 2'500;

void print(const ForceTwinFigures& figures)
{
    std::printf("%s; %.2g N apart, %llu frames of splits, %llu of merges, %llu of pages, "
                "%llu fading\n",
                figures.steps.summary().c_str(), figures.apart_n,
                static_cast<unsigned long long>(figures.refining),
                static_cast<unsigned long long>(figures.coarsening),
                static_cast<unsigned long long>(figures.adopting),
                static_cast<unsigned long long>(figures.fading));
}

class ForceTwin : public testing::TestWithParam<std::size_t>
{
};

TEST_P(ForceTwin, the_force_changes_as_on_the_full_mesh)
{
    const TestModel& model = small_model(GetParam());
    const FaceTree tree(model.faces);
    for (const Hardship& hardship : force_hardships(model))
    {
        const ForceTwinFigures sut = run_force_twin_trial(
            {model, tree, hardship, seed_of(20'261'800 + GetParam()), kFrames});
        print(sut);
        EXPECT_GT(sut.steps.trials, kFrames / 4);
        EXPECT_TRUE(sut.steps.holds());
    }
}

// Smooth, round, open, sharp; needles never fit the pools as a whole.
INSTANTIATE_TEST_SUITE_P(small_models, ForceTwin, testing::Range<std::size_t>(0, 4));

TEST(ForceTwins, hold_for_two_tools_that_share_the_budgets)
{
    const TestModel& model = small_model(0);
    const FaceTree tree(model.faces);
    const ForceTwinFigures sut = run_force_twin_trial(
        {model, tree, force_hardships(model)[5], seed_of(20'261'810), kFrames, 2});
    print(sut);
    EXPECT_GT(sut.steps.trials, kFrames / 2);
    EXPECT_TRUE(sut.steps.holds());
}

ToolOutput pressed_with(double force_n)
{
    ToolOutput output;
    output.force_n = Vec3(0.0, 0.0, force_n);
    output.in_contact = true;
    return output;
}

TEST(ForceStepJudge, sees_a_step_that_the_twin_does_not_make_and_no_other)
{
    ForceStepJudge sut;
    EXPECT_FALSE(sut.judge(pressed_with(1.0), pressed_with(1.0)));
    EXPECT_EQ(sut.judge(pressed_with(3.0), pressed_with(3.0)), 0.0);
    EXPECT_EQ(sut.judge(pressed_with(3.25), pressed_with(3.0)), 0.25); // A surface that pops up,
    EXPECT_EQ(sut.judge(pressed_with(3.25), pressed_with(3.0)), 0.0);  // that stays,
    EXPECT_EQ(sut.judge(pressed_with(4.0), pressed_with(4.0)), 0.25);  // and is right again.
    EXPECT_EQ(sut.judge(pressed_with(-4.0), pressed_with(4.0)), 8.0);  // A vector's difference.
}

TEST(ForceStepJudge, waits_for_two_frames_of_certified_contact)
{
    ToolOutput frozen = pressed_with(0.5);
    frozen.frozen = true;
    ToolOutput squeezed = pressed_with(0.5);
    squeezed.squeezed = true;
    for (const ToolOutput& open : {ToolOutput{}, frozen, squeezed})
    {
        ForceStepJudge sut;
        EXPECT_FALSE(sut.judge(pressed_with(2.0), pressed_with(1.0)));
        EXPECT_TRUE(sut.judge(pressed_with(2.0), pressed_with(1.0)));
        EXPECT_FALSE(sut.judge(open, pressed_with(1.0)));
        EXPECT_FALSE(sut.judge(pressed_with(2.0), pressed_with(1.0)));
        EXPECT_TRUE(sut.judge(pressed_with(2.0), pressed_with(1.0)));
        EXPECT_FALSE(sut.judge(pressed_with(2.0), open));
    }
}

} // namespace

} // namespace tactus::test
