// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I4: within the certified radius everything equals the full mesh bit for bit. Most frames are
/// certified, so that the claim is not empty.
/// The level of detail adds no step to the force: while faces are split and merged and pages arrive
/// under resting, sliding and tapping tools, the force changes as on the full mesh.

#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/random.hpp"
#include "tests/stability/twin_trial.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace tactus::test
{
namespace
{

class Twin : public testing::TestWithParam<std::size_t>
{
};

TEST_P(Twin, certified_answers_are_those_of_the_full_mesh_to_the_last_bit)
{
    constexpr std::uint32_t kFrames = 1'500;
    const TestModel& model = small_model(GetParam());
    const FaceTree tree(model.faces);
    const TwinFigures sut =
        run_twin_trial({model, tree, seed_of(20'261'300 + GetParam()), kFrames});
    std::printf("%s\n%s\n%s\n", sut.identity.summary().c_str(), sut.cores.summary().c_str(),
                sut.uncertified.summary().c_str());
    EXPECT_GT(sut.identity.trials, kFrames / 2);
    EXPECT_TRUE(sut.identity.holds());
    EXPECT_GT(sut.cores.trials, kFrames / 4);
    EXPECT_TRUE(sut.cores.holds());
    EXPECT_TRUE(sut.uncertified.holds());
}

// Smooth, round, open and sharp models; needles never fit the pools as a whole.
INSTANTIATE_TEST_SUITE_P(small_models, Twin, testing::Range<std::size_t>(0, 4));

TEST(TwinOfALiar, is_told_apart_from_the_full_mesh)
{
    const TestModel& model =
        lying_model("liar", make_shape(Shape::bumpy_sphere, 4'000).value(), 0.0);
    const FaceTree tree(model.faces);
    const TwinFigures sut = run_twin_trial({model, tree, seed_of(20'261'310), 1'500});
    EXPECT_GT(sut.identity.violations, 10U);
    EXPECT_GT(sut.cores.violations, 10U);
}

} // namespace

namespace
{

constexpr std::uint32_t kForceFrames = 2'500;

void print(const ForceTwinFigures& figures)
{
    std::printf("%s; %.2g N apart, %llu frames of splits, %llu of merges, %llu of pages, "
                "%llu fading, %llu data-limited with steps to %.2g N\n",
                figures.steps.summary().c_str(), figures.apart_n,
                static_cast<unsigned long long>(figures.refining),
                static_cast<unsigned long long>(figures.coarsening),
                static_cast<unsigned long long>(figures.adopting),
                static_cast<unsigned long long>(figures.fading),
                static_cast<unsigned long long>(figures.data_limited), figures.data_limited_n);
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
            {model, tree, hardship, seed_of(20'261'800 + GetParam()), kForceFrames});
        print(sut);
        EXPECT_GT(sut.steps.trials, kForceFrames / 8);
        EXPECT_TRUE(sut.hold()) << sut.after_waits.summary();
    }
}

// Smooth, round, open and sharp models; needles never fit the pools as a whole.
INSTANTIATE_TEST_SUITE_P(small_models, ForceTwin, testing::Range<std::size_t>(0, 4));

TEST(ForceTwins, hold_for_two_tools_that_share_the_budgets)
{
    const TestModel& model = small_model(0);
    const FaceTree tree(model.faces);
    const ForceTwinFigures sut = run_force_twin_trial(
        {model, tree, force_hardships(model)[5], seed_of(20'261'810), kForceFrames, 2});
    print(sut);
    EXPECT_GT(sut.steps.trials, kForceFrames / 2);
    EXPECT_TRUE(sut.hold()) << sut.after_waits.summary();
}

ToolOutput pressed_with(double force_n)
{
    ToolOutput output;
    output.force_n = Vec3(0.0, 0.0, force_n);
    output.in_contact = true;
    return output;
}

double certified_step(ForceStepJudge& sut, double ours_n, double twins_n)
{
    const auto step = sut.judge(pressed_with(ours_n), pressed_with(twins_n), true);
    return step && step->is_certified ? step->newtons : -1.0;
}

TEST(ForceStepJudge, sees_a_step_that_the_twin_does_not_make_and_no_other)
{
    ForceStepJudge sut;
    EXPECT_EQ(certified_step(sut, 1.0, 1.0), -1.0);
    EXPECT_EQ(certified_step(sut, 3.0, 3.0), 0.0);
    EXPECT_EQ(certified_step(sut, 3.25, 3.0), 0.25); // A surface that appears.
    EXPECT_EQ(certified_step(sut, 3.25, 3.0), 0.0);  // A surface that stays.
    EXPECT_EQ(certified_step(sut, 4.0, 4.0), 0.25);  // A correct surface again.
    EXPECT_EQ(certified_step(sut, -4.0, 4.0), 8.0);  // Difference of vectors.
}

TEST(ForceStepJudge, waits_for_two_frames_in_contact)
{
    ToolOutput halted = pressed_with(0.5);
    halted.halted = true;
    ToolOutput over_constrained = pressed_with(0.5);
    over_constrained.over_constrained = true;
    for (const ToolOutput& open : {ToolOutput{}, halted, over_constrained})
    {
        ForceStepJudge sut;
        EXPECT_EQ(certified_step(sut, 2.0, 2.0), -1.0);
        EXPECT_EQ(certified_step(sut, 2.0, 2.0), 0.0);
        EXPECT_FALSE(sut.judge(open, pressed_with(2.0), true));
        EXPECT_EQ(certified_step(sut, 2.0, 2.0), -1.0);
        EXPECT_EQ(certified_step(sut, 2.0, 2.0), 0.0);
        EXPECT_FALSE(sut.judge(pressed_with(2.0), open, true));
    }
}

TEST(ForceStepJudge, tells_steps_apart_that_come_of_late_data)
{
    ForceStepJudge sut;
    ToolOutput ours = pressed_with(1.0);
    const ToolOutput twin = pressed_with(1.0);
    const auto is_certified = [&](bool is_answered)
    { return sut.judge(ours, twin, is_answered).value().is_certified; };
    EXPECT_FALSE(sut.judge(ours, twin, true));
    EXPECT_TRUE(is_certified(true));
    ours.proxy_m = Vec3(0.001, 0.0, 0.0); // The data were always resident.
    EXPECT_TRUE(is_certified(true));
    EXPECT_TRUE(is_certified(true));
    EXPECT_FALSE(is_certified(false));
    EXPECT_FALSE(is_certified(true));
    EXPECT_FALSE(is_certified(true)); // The places still differ, since one proxy had to wait.
    ours.proxy_m = twin.proxy_m;
    EXPECT_FALSE(is_certified(true)); // The proxies must coincide in both frames.
    EXPECT_TRUE(is_certified(true));
}

} // namespace

} // namespace tactus::test
