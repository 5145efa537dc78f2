// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/cache/request_list.hpp"
#include "rt_core/cache/slot_queues.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <set>

namespace tactus::test
{

namespace
{

class RequestListTest : public ::testing::Test
{
protected:
    RequestList make(std::uint32_t slots)
    {
        Arena arena(memory_.bytes());
        pool_.emplace(arena, slots);
        return RequestList(*pool_, 0, 0);
    }
    /// Expires until each request was checked once.
    void expire_all(std::uint32_t slots, std::uint32_t frame)
    {
        for (std::uint32_t i = 0; i < slots; ++i)
        {
            pool_->expire(frame);
        }
    }

    ArenaMemory memory_{1U << 18U};
    std::optional<RequestPool> pool_;
};

} // namespace

TEST_F(RequestListTest, looks_at_every_request_in_time_however_many_slots_there_are)
{
    constexpr std::uint32_t kSlots = 20 * kRequestTimeoutFrames + 7;
    RequestList sut = make(kSlots);
    for (std::uint32_t number = 0; number < kSlots; ++number)
    {
        sut.ask(number, 0);
    }
    EXPECT_EQ(sut.under_way(), kSlots);
    for (std::uint32_t frame = kRequestTimeoutFrames + 1; frame <= 2 * kRequestTimeoutFrames;
         ++frame)
    {
        pool_->expire(frame);
    }
    EXPECT_EQ(sut.under_way(), 0U);
}

TEST_F(RequestListTest, a_request_waits_as_long_as_it_is_told)
{
    for (const std::uint32_t timeout : {1U, 25U, 2'500U})
    {
        RequestList sut = make(1);
        sut.ask(7, 100);
        pool_->expire(100 + timeout, timeout);
        EXPECT_TRUE(sut.is_under_way(7));
        pool_->expire(101 + timeout, timeout);
        EXPECT_FALSE(sut.is_under_way(7));
    }
    EXPECT_EQ(kRequestTimeout_ns / 1'000'000, kRequestTimeoutFrames) << "at 1 kHz";
}

TEST_F(RequestListTest, the_frame_counter_may_wrap)
{
    RequestList sut = make(1);
    sut.ask(7, 0xFFFF'FFF0U);

    expire_all(1, 5);
    EXPECT_TRUE(sut.is_under_way(7));
    expire_all(1, kRequestTimeoutFrames);
    EXPECT_FALSE(sut.is_under_way(7));
}

TEST_F(RequestListTest, tells_how_long_pieces_took)
{
    RequestList sut = make(40);
    EXPECT_FALSE(sut.latency().is_measured());
    for (std::uint32_t i = 0; i < 30; ++i)
    {
        sut.ask(i, 100 + i);
        sut.arrive(i, 120 + i);
    }
    EXPECT_DOUBLE_EQ(sut.latency().mean_frames(), 20.0);
    EXPECT_NEAR(sut.latency().most_frames(), 20.0, 0.1) << "the deviation wears off";

    sut.ask(30, 200);
    sut.arrive(30, 300);
    EXPECT_GT(sut.latency().mean_frames(), 25.0);
    EXPECT_GT(sut.latency().most_frames(), 60.0);
}

TEST_F(RequestListTest, what_expired_does_not_count_as_latency)
{
    RequestList sut = make(2);
    sut.ask(7, 0);
    expire_all(2, kRequestTimeoutFrames + 1);

    sut.arrive(7, 10'000);

    EXPECT_FALSE(sut.latency().is_measured());
}

TEST_F(RequestListTest, one_model_asks_for_what_is_not_kept_for_another_and_not_for_more)
{
    Arena arena(memory_.bytes());
    RequestPool pool(arena, 5);
    RequestList greedy(pool, 3, 0);
    RequestList modest(pool, 4, 2);
    std::uint32_t number = 0;
    for (; greedy.has_credit(); ++number)
    {
        greedy.ask(number, 0);
    }
    EXPECT_EQ(number, 3U);
    EXPECT_DEATH(greedy.ask(number, 0), "");
    modest.ask(0, 0);
    modest.ask(1, 0);
    EXPECT_FALSE(modest.has_credit());
    EXPECT_FALSE(modest.has_more_than_its_own());
    EXPECT_TRUE(greedy.has_more_than_its_own());
    EXPECT_TRUE(greedy.is_under_way(2)); // Numbers belong to each model.
    EXPECT_FALSE(modest.is_under_way(2));

    greedy.arrive(0, 1); // A slot stays the model's until it is returned.
    EXPECT_FALSE(modest.has_credit());
    EXPECT_EQ(greedy.slots_had(), 1U);
    greedy.give_back_slot();
    EXPECT_TRUE(modest.has_credit());
    EXPECT_TRUE(greedy.has_credit());
    modest.ask(2, 1);
    EXPECT_TRUE(modest.has_more_than_its_own());
    EXPECT_FALSE(greedy.has_credit());
}

TEST_F(RequestListTest, a_late_answer_takes_a_slot_though_another_model_has_asked_for_it)
{
    RequestList late = make(1);
    RequestList other(*pool_, 1, 0);
    late.ask(3, 0);
    expire_all(1, kRequestTimeoutFrames + 1);
    other.ask(4, 0);

    late.arrive(3, 1);

    EXPECT_FALSE(late.has_credit());
    EXPECT_FALSE(other.has_credit());
    late.give_back_slot();
    EXPECT_FALSE(late.has_credit()) << "the other's request waits for the slot";
    other.arrive(4, 2);
    other.give_back_slot();
    EXPECT_TRUE(late.has_credit());
}

TEST_F(RequestListTest, more_arrivals_than_slots_are_a_bug)
{
    RequestList sut = make(1);
    sut.arrive(3, 0);

    EXPECT_DEATH(sut.arrive(4, 0), "");
}

TEST_F(RequestListTest, random_use_never_asks_for_more_than_the_slots)
{
    Random random(19);
    constexpr std::uint32_t kSlots = 6;
    RequestList sut = make(kSlots);
    std::set<std::uint32_t> under_way;
    std::uint32_t free_slots = kSlots;
    for (std::uint32_t frame = 0; frame < 20'000; ++frame)
    {
        const std::uint32_t number = random.below(30);
        ASSERT_EQ(sut.is_under_way(number), under_way.count(number) != 0);
        ASSERT_EQ(sut.has_credit(), under_way.size() < free_slots);
        if (sut.has_credit() && !sut.is_under_way(number))
        {
            sut.ask(number, frame);
            under_way.insert(number);
        }
        if (!under_way.empty() && random.one_in(3))
        {
            sut.arrive(*under_way.begin(), frame);
            under_way.erase(under_way.begin());
            --free_slots;
        }
        if (free_slots < kSlots && random.one_in(3))
        {
            sut.give_back_slot();
            ++free_slots;
        }
    }
}

TEST(SlotQueues, has_room_for_every_slot_the_requests_it_was_made_for_and_link_updates)
{
    ArenaMemory memory(1U << 14U);
    Arena arena(memory.bytes());
    SlotQueues sut(arena, 5, 4);

    // The greatest number of updates still leaves space for every slot.
    for (std::uint32_t i = 0; i < kMaxLinkUpdatesPerFrame; ++i)
    {
        ASSERT_TRUE(sut.has_room_for_update());
        ASSERT_TRUE(
            sut.arrived.try_push({{ContentKind::chunk, 0}, 0, 0, i, QueueEventKind::link_update}));
    }
    EXPECT_FALSE(sut.has_room_for_update());
    for (std::uint32_t slot = 0; slot < 5; ++slot)
    {
        EXPECT_TRUE(sut.arrived.try_push({{ContentKind::chunk, slot}, slot}));
        EXPECT_TRUE(sut.freed.try_push({ContentKind::chunk, slot}));
    }
    for (std::uint32_t request = 0; request < 4; ++request)
    {
        EXPECT_TRUE(sut.wanted.try_push({{ContentKind::chunk, request}, 0}));
    }
    EXPECT_FALSE(sut.arrived.try_push({}));
    EXPECT_FALSE(sut.freed.try_push({}));
    EXPECT_FALSE(sut.wanted.try_push({}));
}

} // namespace tactus::test
