// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/spsc_queue.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <thread>

namespace tactus::test
{

TEST(SpscQueue, refuses_one_too_many_and_keeps_the_order_round_the_end)
{
    std::array<int, 5> slots{};
    SpscQueue<int> sut(slots);
    int pushed = 0;
    int popped = 0;
    int value = 0;
    for (int round = 0; round < 20; ++round)
    {
        while (sut.try_push(pushed))
        {
            ++pushed;
        }
        ASSERT_EQ(sut.size(), 5U);
        for (int i = 0; i < 1 + round % 5; ++i)
        {
            ASSERT_TRUE(sut.try_pop(value));
            ASSERT_EQ(value, popped++);
        }
        ASSERT_EQ(sut.size(), static_cast<std::size_t>(pushed - popped));
    }
}

TEST(SpscQueue, two_threads_hand_over_every_value_whole_and_in_order)
{
    struct Record
    {
        std::uint64_t number{0};
        std::array<std::uint64_t, 7> copies{};
    };
    constexpr std::uint64_t kCount = 20'000;
    std::array<Record, 61> slots{};
    SpscQueue<Record> sut(slots);
    std::thread producer(
        [&sut]
        {
            for (std::uint64_t i = 0; i < kCount; ++i)
            {
                Record record{i, {}};
                record.copies.fill(i * i);
                while (!sut.try_push(record))
                {
                    std::this_thread::yield();
                }
            }
        });
    std::uint64_t wrong = 0;
    Record record;
    for (std::uint64_t i = 0; i < kCount; ++i)
    {
        while (!sut.try_pop(record))
        {
            std::this_thread::yield();
        }
        wrong += record.number != i ? 1 : 0;
        for (const std::uint64_t copy : record.copies)
        {
            wrong += copy != i * i ? 1 : 0;
        }
    }
    producer.join();

    EXPECT_EQ(wrong, 0U);
    EXPECT_EQ(sut.size(), 0U);
}

TEST(SpscQueueDeathTest, a_queue_without_slots_is_a_bug)
{
    EXPECT_DEATH(SpscQueue<int>(std::span<int>{}), "");
}

} // namespace tactus::test
