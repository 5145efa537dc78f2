// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/tree_walk.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/work_budget.hpp"

#include <gtest/gtest.h>

namespace tactus
{

namespace
{

TEST(WorkBudget, refuses_what_begins_after_its_limit_and_ends_what_began_before)
{
    WorkBudget sut(1'000);
    EXPECT_TRUE(sut.try_take(999));
    EXPECT_EQ(sut.left(), 1U);
    EXPECT_TRUE(sut.try_take(500));
    EXPECT_FALSE(sut.try_take(1));
    EXPECT_EQ(sut.used(), 1'499U);
    EXPECT_EQ(sut.left(), 0U);
    sut.limit(2'000);
    EXPECT_TRUE(sut.try_take(1));
    EXPECT_EQ(sut.left(), 500U);
}

TEST(WorkBudget, never_wraps_round)
{
    WorkBudget sut;
    sut.spend(WorkBudget::kUnlimited - 1);
    EXPECT_FALSE(sut.is_spent());
    sut.spend(WorkBudget::kUnlimited);
    EXPECT_EQ(sut.used(), WorkBudget::kUnlimited);
    EXPECT_TRUE(sut.is_spent());
}

TEST(WorkBudget, is_an_instruction_a_nanosecond_and_with_hulls_and_meshes_some_times_that)
{
    for (const std::uint32_t times : {1U, Budgets::kHullWork, Budgets::kMeshWork})
    {
        EXPECT_EQ(Budgets::work_of(500'000, times), 500'000U * times);
        EXPECT_EQ(Budgets::work_of(1'000, times), Budgets::least_work(times));
        EXPECT_GE(Budgets::least_work(times), WorkBudget::kLeast * times);
    }
}

TEST(WorkBudget, is_drawn_on_by_all_walks_of_a_frame)
{
    WorkBudget frame(2 * WorkCost::node + 1);
    WalkBudget first{100, 100};
    WalkBudget second{100, 100};
    first.frame = &frame;
    second.frame = &frame;
    EXPECT_TRUE(first.take_node());
    EXPECT_TRUE(second.take_node());
    EXPECT_TRUE(first.take_triangles(1));
    EXPECT_FALSE(second.take_triangles(1));
    EXPECT_TRUE(second.is_spent);
    EXPECT_EQ(second.triangles_tested, 0U);
    EXPECT_FALSE(first.take_node());
    EXPECT_EQ(first.take_nodes(3), 0U);
    EXPECT_EQ(first.nodes_visited, 1U);
}

} // namespace

} // namespace tactus
