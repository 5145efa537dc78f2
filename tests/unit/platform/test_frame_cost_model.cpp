// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/frame_cost_model.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace tactus
{

namespace
{

double true_time_ns(double edits, double steps)
{
    return 9'000.0 + 320.0 * edits + 18.0 * steps;
}

TEST(FrameCostModel, expects_nothing_before_the_first_frame_and_the_first_frame_after_it)
{
    FrameCostModel sut;
    EXPECT_EQ(sut.per_edit_ns(), FrameCostModel::kFirstPerEdit_ns);
    EXPECT_EQ(sut.per_step_ns(), FrameCostModel::kFirstPerStep_ns);
    sut.observe(30'000.0, 20.0, 200.0);
    EXPECT_DOUBLE_EQ(sut.predict_ns(20.0, 200.0), 30'000.0);
}

TEST(FrameCostModel, finds_both_slopes_of_work_that_varies)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(0.0, 1.0);
    FrameCostModel sut;
    for (int i = 0; i < 2'000; ++i)
    {
        const double edits = 100.0 * any(random);
        const double steps = 800.0 * any(random);
        sut.observe(true_time_ns(edits, steps) + 4'000.0 * (any(random) - 0.5), edits, steps);
    }
    EXPECT_NEAR(sut.per_edit_ns(), 320.0, 32.0);
    EXPECT_NEAR(sut.per_step_ns(), 18.0, 1.8);
    EXPECT_NEAR(sut.predict_ns(0.0, 0.0), 9'000.0, 1'500.0);
    EXPECT_NEAR(sut.predict_ns(100.0, 800.0), true_time_ns(100.0, 800.0), 3'000.0);
}

TEST(FrameCostModel, keeps_its_slopes_while_the_work_does_not_vary)
{
    FrameCostModel sut;
    for (int i = 0; i < 1'000; ++i)
    {
        sut.observe(true_time_ns(64.0, 300.0), 64.0, 300.0);
    }
    EXPECT_DOUBLE_EQ(sut.per_edit_ns(), FrameCostModel::kFirstPerEdit_ns);
    EXPECT_DOUBLE_EQ(sut.per_step_ns(), FrameCostModel::kFirstPerStep_ns);
    EXPECT_NEAR(sut.predict_ns(64.0, 300.0), true_time_ns(64.0, 300.0), 1e-6);
}

TEST(FrameCostModel, follows_costs_that_change)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<double> any(0.0, 1.0);
    FrameCostModel sut;
    for (int i = 0; i < 3'000; ++i)
    {
        const double factor = i < 1'500 ? 1.0 : 5.0;
        const double edits = 60.0 * any(random);
        const double steps = 500.0 * any(random);
        sut.observe(factor * true_time_ns(edits, steps), edits, steps);
    }
    EXPECT_NEAR(sut.per_edit_ns(), 5.0 * 320.0, 160.0);
    EXPECT_NEAR(sut.predict_ns(30.0, 250.0), 5.0 * true_time_ns(30.0, 250.0), 8'000.0);
}

/// Edits that come with as many steps each say nothing about one without the other.
TEST(FrameCostModel, predicts_work_of_the_kind_that_it_saw)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(0.0, 1.0);
    FrameCostModel sut;
    for (int i = 0; i < 2'000; ++i)
    {
        const double edits = 80.0 * any(random);
        sut.observe(true_time_ns(edits, 4.0 * edits), edits, 4.0 * edits);
    }
    EXPECT_NEAR(sut.predict_ns(70.0, 280.0), true_time_ns(70.0, 280.0), 500.0);
}

RC_GTEST_PROP(FrameCostModel, keeps_its_slopes_in_range_whatever_it_sees, ())
{
    FrameCostModel sut;
    for (int i = 0; i < 100; ++i)
    {
        sut.observe(*rc::gen::inRange(0, 100'000'000), *rc::gen::inRange(0, 513),
                    *rc::gen::inRange(0, 100'000));
        RC_ASSERT(sut.per_edit_ns() >=
                  FrameCostModel::kFirstPerEdit_ns / FrameCostModel::kSlopeRange);
        RC_ASSERT(sut.per_edit_ns() <=
                  FrameCostModel::kFirstPerEdit_ns * FrameCostModel::kSlopeRange);
        RC_ASSERT(sut.per_step_ns() >=
                  FrameCostModel::kFirstPerStep_ns / FrameCostModel::kSlopeRange);
        RC_ASSERT(sut.per_step_ns() <=
                  FrameCostModel::kFirstPerStep_ns * FrameCostModel::kSlopeRange);
        RC_ASSERT(std::isfinite(sut.predict_ns(64.0, 400.0)));
    }
}

TEST(UpperLevel, rests_near_the_upper_end_of_values_that_scatter)
{
    std::mt19937 random(4);
    std::uniform_real_distribution<double> any(0.0, 1.0);
    UpperLevel sut(0.0);
    for (int i = 0; i < 4'000; ++i)
    {
        sut.observe(any(random));
    }
    EXPECT_GT(sut.level(), 0.75);
    EXPECT_LE(sut.level(), 1.0);
}

TEST(UpperLevel, rises_within_frames_and_sinks_over_hundreds)
{
    UpperLevel sut(0.0);
    for (int i = 0; i < 20; ++i)
    {
        sut.observe(1.0);
    }
    EXPECT_GT(sut.level(), 0.9);
    for (int i = 0; i < 20; ++i)
    {
        sut.observe(0.0);
    }
    EXPECT_GT(sut.level(), 0.8);
    for (int i = 0; i < 2'000; ++i)
    {
        sut.observe(0.0);
    }
    EXPECT_LT(sut.level(), 0.01);
}

} // namespace

} // namespace tactus
