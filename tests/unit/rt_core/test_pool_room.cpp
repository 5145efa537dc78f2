// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/pool_room.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <array>

namespace tactus::test
{

TEST(PoolRoom, an_owner_that_is_alone_has_all_of_it_whatever_is_promised)
{
    for (const std::uint32_t promised : {0U, 1U, 2U, 3U})
    {
        PoolRoom sut(2);
        PoolShare share = sut.promise(promised);
        for (std::uint32_t left = 2; left > 0; --left)
        {
            EXPECT_EQ(sut.left_for(share), left) << promised;
            sut.take(share);
        }
        EXPECT_EQ(sut.left_for(share), 0U);
        EXPECT_EQ(sut.used(), 2U);
        EXPECT_DEATH(sut.take(share), "");
        sut.give_back(share);
        EXPECT_EQ(sut.left_for(share), 1U);
    }
}

TEST(PoolRoom, what_cant_be_refused_is_missing_for_everybody_until_as_much_has_come_back)
{
    PoolRoom sut(2);
    PoolShare one = sut.promise(0);
    PoolShare other = sut.promise(1);
    sut.take(one);
    sut.take_unasked(one); // The place was reserved for the other.
    sut.take_unasked(one); // The place was not available.

    EXPECT_EQ(sut.left_for(one), 0U);
    EXPECT_EQ(sut.left_for(other), 0U);
    sut.give_back(one);
    EXPECT_EQ(sut.left_for(other), 0U);
    sut.give_back(one);
    EXPECT_EQ(sut.left_for(one), 0U);
    EXPECT_EQ(sut.left_for(other), 1U);
}

TEST(PoolRoom, no_more_is_promised_than_is_left)
{
    PoolRoom sut(10);
    PoolShare first = sut.promise(4);
    for (int i = 0; i < 6; ++i)
    {
        sut.take(first);
    }

    EXPECT_EQ(sut.promise(3).promised, 3U);
    EXPECT_EQ(sut.promise(3).promised, 1U);
    EXPECT_EQ(sut.promise(3).promised, 0U);
    EXPECT_EQ(sut.left_for(first), 0U);
}

TEST(PoolRoom, random_owners_always_get_what_was_promised_and_never_more_than_there_is)
{
    constexpr std::uint32_t kSlots = 50;
    Random random(1);
    PoolRoom sut(kSlots);
    std::array<PoolShare, 4> shares{sut.promise(0), sut.promise(5), sut.promise(10),
                                    sut.promise(20)};
    for (int step = 0; step < 5'000; ++step)
    {
        SCOPED_TRACE(step);
        PoolShare& share = shares[random.below(4)];
        if (random.one_in(2) && share.used > 0)
        {
            sut.give_back(share);
        }
        else if (sut.left_for(share) > 0)
        {
            sut.take(share);
        }
        std::uint32_t used = 0;
        std::uint32_t kept = 0;
        for (const PoolShare& each : shares)
        {
            used += each.used;
            kept += each.promised - std::min(each.promised, each.used);
        }
        ASSERT_EQ(sut.used(), used);
        ASSERT_LE(used + kept, kSlots);
        for (const PoolShare& each : shares)
        {
            const std::uint32_t own = each.promised - std::min(each.promised, each.used);
            ASSERT_EQ(sut.left_for(each), kSlots - used - kept + own);
        }
    }
}

} // namespace tactus::test
