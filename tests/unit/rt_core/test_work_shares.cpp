// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Division of a frame's work between its stages.

#include "rt_core/frame/work_shares.hpp"

#include <gtest/gtest.h>

namespace tactus
{

namespace
{

constexpr std::uint32_t kMost = 1'000'000;

std::uint32_t limit_of(const WorkBudget& work)
{
    return work.used() + work.left();
}

TEST(WorkShares, keep_of_a_frame_what_its_answers_took_in_the_last_one)
{
    WorkShares sut;
    struct Frame
    {
        std::uint32_t answers;
        std::uint32_t refining; ///< Limit by the previous frame.
    };
    for (const Frame& frame : {Frame{500'000, 600'000}, Frame{700'000, 450'000},
                               Frame{900'000, 250'000}, Frame{100'000, 250'000}, Frame{0, 600'000}})
    {
        WorkBudget work;
        sut.begin(kMost, work);
        sut.begin_loading();
        EXPECT_EQ(limit_of(work), 300'000U);
        work.spend(1'000);
        sut.begin_refining();
        EXPECT_NEAR(limit_of(work), frame.refining, 1);
        sut.begin_queries();
        sut.begin_query(0);
        EXPECT_EQ(limit_of(work), 900'000U);
        work.spend(frame.answers / 2);
        sut.begin_forces();
        EXPECT_EQ(limit_of(work), kMost);
        work.spend(frame.answers / 2);
        sut.end();
    }
    EXPECT_EQ(sut.for_warming().left(), 250'000U);
}

TEST(WorkShares, keep_something_for_each_query_that_follows)
{
    WorkShares sut;
    WorkBudget work;
    sut.begin(kMost, work);
    sut.begin_queries();
    sut.begin_query(2);
    EXPECT_EQ(work.left(), 860'000U);
    work.spend(work.left());
    sut.begin_query(1);
    EXPECT_EQ(work.left(), 20'000U);
    work.spend(30'000); // More than allowed.
    sut.begin_query(0);
    EXPECT_EQ(work.left(), 10'000U);
    work.spend(20'000);
    sut.begin_query(0);
    EXPECT_EQ(work.left(), 0U);

    WorkBudget little;
    sut.begin(kMost, little);
    little.spend(870'000);
    sut.begin_queries();
    sut.begin_query(2); // 30,000 are left of 90 %, for three.
    EXPECT_EQ(little.left(), 10'000U);
}

TEST(WorkShares, let_a_proxy_look_at_what_fits_and_at_some_planes_in_any_case)
{
    WorkShares sut;
    WorkBudget work;
    sut.begin(kMost, work);
    sut.begin_forces();
    EXPECT_EQ(sut.planes(), kMost / WorkCost::plane);
    work.spend(kMost);
    EXPECT_EQ(sut.planes(), 16U);
}

TEST(WorkShares, are_of_the_least_work_where_less_is_given_and_no_limit_where_there_is_none)
{
    WorkShares sut;
    WorkBudget work;
    sut.begin(0, work);
    sut.begin_forces();
    EXPECT_EQ(work.left(), WorkBudget::kLeast);

    sut.begin(WorkBudget::kUnlimited, work);
    for (const auto begin :
         {&WorkShares::begin_loading, &WorkShares::begin_refining, &WorkShares::begin_forces})
    {
        (sut.*begin)();
        EXPECT_EQ(limit_of(work), WorkBudget::kUnlimited);
    }
    sut.begin_queries();
    sut.begin_query(0);
    EXPECT_EQ(limit_of(work), WorkBudget::kUnlimited);
    EXPECT_EQ(limit_of(sut.for_warming()), WorkBudget::kUnlimited);
}

} // namespace

} // namespace tactus
