// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/spsc_queue.hpp"
#include "tests/interleave/checked.hpp"
#include "tests/interleave/expect_sound.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

/// The product's SpscQueue in every order that the memory model permits, and with each of its
/// orders weakened, which must be detected.
namespace tactus::interleave
{
namespace
{

template <typename T>
using CheckedQueue = SpscQueue<T, CheckedAtomic, CheckedSlot<T>>;

/// Locations of a queue that is built first.
constexpr std::size_t kHead = 0;
constexpr std::size_t kTail = 1;
constexpr std::size_t kProducer = 0;
constexpr std::size_t kConsumer = 1;

/// Queue with the history of its two threads; each list is written by one of them.
template <std::size_t capacity>
struct Bench
{
    /// Pushes ascending numbers from 1. A refusal must be consistent with the producer's knowledge:
    /// every slot is full except for pops that happened before.
    void push()
    {
        const Moment began = Execution::current().now();
        const std::size_t known_pops = count_seen(pops);
        const auto number = static_cast<std::uint32_t>(pushes.size() + 1);
        if (queue.try_push(number))
        {
            require(pushes.size() - count_seen(pops) < capacity, "pushed into a full queue");
            pushes.push_back(began);
            return;
        }
        require(pushes.size() - known_pops == capacity, "refused a push with a slot free");
    }
    void pop()
    {
        const Moment began = Execution::current().now();
        const std::size_t known_pushes = count_seen(pushes);
        std::uint32_t number = 0;
        if (queue.try_pop(number))
        {
            require(number == pops.size() + 1, "lost, repeated or out of order");
            require(pops.size() < count_seen(pushes), "popped from an empty queue");
            pops.push_back(began);
            return;
        }
        require(number == 0, "a refused pop wrote the value");
        require(pops.size() == known_pushes, "refused a pop with a value there");
    }
    void end()
    {
        require(queue.size() == pushes.size() - pops.size(), "a wrong size at the end");
        while (pops.size() < pushes.size())
        {
            pop();
        }
        pop();
        require(pops.size() == pushes.size(), "more was popped than pushed");
    }
    [[nodiscard]] static std::size_t count_seen(const std::vector<Moment>& moments)
    {
        std::size_t count = 0;
        while (count < moments.size() && Execution::current().has_seen(moments[count]))
        {
            ++count;
        }
        return count;
    }

    std::array<CheckedSlot<std::uint32_t>, capacity> slots{};
    CheckedQueue<std::uint32_t> queue{slots};
    std::vector<Moment> pushes; ///< Start times of successful pushes.
    std::vector<Moment> pops;
};

template <std::size_t capacity>
Exploration push_and_pop(int pushes, int pops, std::span<const Fault> faults = {})
{
    const auto produce = [pushes](Bench<capacity>& bench)
    {
        for (int i = 0; i < pushes; ++i)
        {
            bench.push();
        }
    };
    const auto consume = [pops](Bench<capacity>& bench)
    {
        for (int i = 0; i < pops; ++i)
        {
            bench.pop();
        }
    };
    return explore_small<Bench<capacity>>(
        {produce, consume}, [](Bench<capacity>& bench) { bench.end(); }, faults);
}

TEST(QueueOrders, of_any_capacity_hand_over_everything_once_in_order_without_a_race)
{
    expect_sound("capacity 1, 5 pushes, 5 pops", push_and_pop<1>(5, 5), 1'000);
    expect_sound("capacity 2, 5 pushes, 5 pops", push_and_pop<2>(5, 5), 1'000);
    expect_sound("capacity 3, 5 pushes, 4 pops", push_and_pop<3>(5, 4), 1'000);
}

struct Mutation
{
    const char* what;
    Fault fault;
    const char* found_as;
};

/// Weakens every operation of try_push() and try_pop() on the other thread's counter, and every
/// store.
TEST(QueueOrders, each_weaker_order_is_found)
{
    const std::array<Mutation, 4> mutations{{
        {"the push's look at head", {.location = kHead, .thread = kProducer}, "race"},
        {"the push's store of tail", {.location = kTail, .is_store = true}, "race"},
        {"the pop's look at tail", {.location = kTail, .thread = kConsumer}, "race"},
        {"the pop's store of head", {.location = kHead, .is_store = true}, "race"},
    }};
    for (const Mutation& mutation : mutations)
    {
        const std::array faults{mutation.fault};
        for (const Exploration& result :
             {push_and_pop<1>(2, 2, faults), push_and_pop<2>(3, 2, faults)})
        {
            EXPECT_EQ(result.failure.substr(0, 4), mutation.found_as) << mutation.what;
        }
    }
}

TEST(QueueOrders, counts_that_are_off_by_one_are_found)
{
    const std::array<Mutation, 4> mutations{{
        {"full one too late", {kHead, false, 1, kProducer}, "race"},
        {"full one too early", {kHead, false, -1, kProducer}, "refused a push with a slot free"},
        {"empty one too late", {kTail, false, 1, kConsumer}, "race"},
        {"empty one too early", {kTail, false, -1, kConsumer}, "refused a pop with a value there"},
    }};
    for (const Mutation& mutation : mutations)
    {
        const std::array faults{mutation.fault};
        EXPECT_NE(push_and_pop<1>(3, 3, faults).failure, "") << mutation.what;
        EXPECT_NE(push_and_pop<2>(4, 3, faults).failure, "") << mutation.what;
    }
}

/// Each refusal is true at some moment, but two need not be true at the same one: here the queue of
/// two holds one value, is full for the producer and empty for the consumer.
TEST(QueueOrders, a_refusal_may_be_late_on_both_sides_at_once)
{
    struct Both
    {
        Bench<2> bench;
        bool was_full{false};
        bool was_empty{false};
    };
    std::size_t both = 0;
    const Exploration result =
        explore_small<Both>({[](Both& s)
                             {
                                 s.bench.push();
                                 s.bench.push();
                                 std::uint32_t third = 3;
                                 s.was_full = !s.bench.queue.try_push(third);
                             },
                             [](Both& s)
                             {
                                 std::uint32_t number = 0;
                                 if (s.bench.queue.try_pop(number))
                                 {
                                     s.was_empty = !s.bench.queue.try_pop(number);
                                 }
                             }},
                            [&](Both& s) { both += s.was_full && s.was_empty ? 1U : 0U; });
    EXPECT_EQ(result.failure, "");
    EXPECT_GT(both, 0U);
}

TEST(QueueOrders, size_is_never_more_than_the_capacity_on_either_side)
{
    const auto look = [](Bench<2>& bench)
    { require(bench.queue.size() <= 2, "a size beyond the capacity"); };
    const Exploration result = explore_small<Bench<2>>({[&](Bench<2>& bench)
                                                        {
                                                            bench.push();
                                                            look(bench);
                                                            bench.push();
                                                            bench.push();
                                                            look(bench);
                                                        },
                                                        [&](Bench<2>& bench)
                                                        {
                                                            bench.pop();
                                                            look(bench);
                                                            bench.pop();
                                                            look(bench);
                                                        }});
    expect_sound("capacity 2, sizes in between", result, 1'000);
}

} // namespace
} // namespace tactus::interleave
