// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/static_vector.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace tactus::test
{

TEST(StaticVector, takes_its_capacity_and_refuses_one_more)
{
    StaticVector<int, 3> sut;
    for (int i = 1; i <= 3; ++i)
    {
        EXPECT_TRUE(sut.try_push_back(i));
    }

    EXPECT_FALSE(sut.try_push_back(4));

    EXPECT_TRUE(sut.full());
    EXPECT_EQ(sut.size(), 3U);
    EXPECT_EQ(std::accumulate(sut.begin(), sut.end(), 0), 6);
    EXPECT_EQ(sut.view()[2], 3);
}

TEST(StaticVector, is_reusable_after_pop_and_clear)
{
    StaticVector<int, 2> sut;
    sut.push_back(1);
    sut.push_back(2);

    EXPECT_EQ(sut.pop_back(), 2);
    sut.push_back(3);
    EXPECT_EQ(sut[1], 3);
    sut[0] = 9;
    EXPECT_EQ(sut.view()[0], 9);
    sut.clear();
    EXPECT_TRUE(sut.empty());
    sut.push_back(4);
    EXPECT_EQ(sut[0], 4);
}

TEST(StaticVectorDeathTest, misuse_is_a_bug)
{
    StaticVector<int, 1> sut;

    EXPECT_DEATH(sut.pop_back(), "");
    EXPECT_DEATH(static_cast<void>(sut[0]), "");
    sut.push_back(1);
    EXPECT_DEATH(sut.push_back(2), "");
    EXPECT_DEATH(static_cast<void>(sut[1]), "");
}

} // namespace tactus::test
