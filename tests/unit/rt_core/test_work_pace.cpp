// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/limits.hpp"
#include "rt_core/refine/work_pace.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{
namespace
{

WorkPace after(std::uint32_t frames, std::uint32_t splits)
{
    WorkPace sut;
    for (std::uint32_t i = 0; i < frames; ++i)
    {
        sut.count(splits);
    }
    return sut;
}

TEST(WorkPace, begins_with_an_eighth_of_the_budget)
{
    const WorkPace sut;
    EXPECT_EQ(sut.splits_of(64), 8U);
    EXPECT_EQ(sut.splits_of(128), 16U);
    EXPECT_EQ(sut.splits_of(1), 1U);
    EXPECT_EQ(sut.splits_of(0), 0U);
}

TEST(WorkPace, is_half_as_much_again_as_was_split_lately_and_two_more)
{
    EXPECT_EQ(after(400, 6).splits_of(64), 11U);
    EXPECT_EQ(after(400, 12).splits_of(64), 20U);
    EXPECT_EQ(after(400, 30).splits_of(128), 47U);
}

TEST(WorkPace, leaves_three_fifths_of_the_budget_to_what_can_not_wait)
{
    EXPECT_EQ(after(400, 64).splits_of(64), 25U);
    EXPECT_EQ(after(400, kMaxSplitsPerFrame).splits_of(kMaxSplitsPerFrame), 102U);
}

TEST(WorkPace, is_little_changed_by_one_frame_and_follows_some_thirty)
{
    WorkPace sut = after(400, 6);
    sut.count(64);
    EXPECT_EQ(sut.splits_of(128), 16U) << "an eighth";
    EXPECT_EQ(sut.splits_of(64), 13U);
    for (int i = 0; i < 64; ++i)
    {
        sut.count(14);
    }
    EXPECT_GE(sut.splits_of(64), 20U);
}

TEST(WorkPace, merges_what_is_split_and_less_after_a_frame_that_split_many)
{
    WorkPace sut = after(400, 8);
    EXPECT_EQ(sut.merges_of(64), 12U);
    sut.count(12);
    EXPECT_EQ(sut.merges_of(64), 8U);
    sut.count(64);
    EXPECT_EQ(sut.merges_of(64), 4U) << "a sixteenth";
    sut.count(0);
    EXPECT_EQ(sut.merges_of(64), 16U) << "no more than splits that may wait";
    EXPECT_EQ(sut.merges_of(1), 1U);
    EXPECT_EQ(sut.merges_of(0), 0U);
}

} // namespace
} // namespace tactus::test
