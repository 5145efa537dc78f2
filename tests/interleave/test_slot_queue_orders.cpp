// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/spsc_queue.hpp"
#include "tests/interleave/checked.hpp"
#include "tests/interleave/expect_sound.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

/// Assumptions of the two threads at the queues besides each queue alone: a page circulates without
/// a race; a thread that sees a request sees the earlier freeing; a notified linked record is read
/// completely. Uses the product's queues, with verbs as in ChunkLoader, Linker and ChunkCache,
/// reduced to shared accesses. Thread 0 is the transport's.
namespace tactus::interleave
{
namespace
{

template <typename T>
using CheckedQueue = SpscQueue<T, CheckedAtomic, CheckedSlot<T>>;

/// Locations in the order in which a Queues builds them.
constexpr std::size_t kToHapticTail = 1;
constexpr std::size_t kToTransportTail = 3;
constexpr std::size_t kWantedTail = 5;
constexpr std::uint32_t kPending = 99;

struct Queues
{
    std::array<CheckedSlot<std::uint32_t>, 2> arrived_slots{};
    std::array<CheckedSlot<std::uint32_t>, 2> freed_slots{};
    std::array<CheckedSlot<std::uint32_t>, 2> wanted_slots{};
    CheckedQueue<std::uint32_t> arrived{arrived_slots};
    CheckedQueue<std::uint32_t> freed{freed_slots};
    CheckedQueue<std::uint32_t> wanted{wanted_slots};
    CheckedAtomic<std::uint32_t> next{kPending};
    std::array<CheckedSlot<std::uint32_t>, 2> pages{};
};
using QueueBody = std::function<void(Queues&)>;

Exploration two_threads(const QueueBody& transport, const QueueBody& haptic,
                        std::span<const Fault> faults = {})
{
    return explore_small<Queues>({transport, haptic}, {}, faults);
}

/// Fills free pages with ascending numbers and hands them over, `turns` times.
void lend_and_fill(Queues& queues, std::uint32_t pages, int turns)
{
    std::uint32_t free = pages; // Number of pages on `stack`, as in the loader.
    std::array<std::uint32_t, 2> stack{0, 1};
    std::uint32_t number = 0;
    for (int turn = 0; turn < turns; ++turn)
    {
        std::uint32_t slot = 0;
        if (queues.freed.try_pop(slot))
        {
            require(free < pages, "a page was freed twice");
            stack.at(free++) = slot;
        }
        if (free > 0)
        {
            slot = stack.at(--free);
            queues.pages.at(slot) = ++number;
            require(queues.arrived.try_push(slot), "no room for an arrival");
        }
    }
}

void adopt_and_free(Queues& queues, int turns)
{
    std::uint32_t last = 0;
    for (int turn = 0; turn < turns; ++turn)
    {
        std::uint32_t slot = 0;
        if (queues.arrived.try_pop(slot))
        {
            const std::uint32_t number = queues.pages.at(slot);
            require(number == ++last, "a page with another one's content");
            require(queues.freed.try_push(slot), "no room for a freed page");
        }
    }
}

Exploration page_goes_round(std::uint32_t pages, std::span<const Fault> faults = {})
{
    return two_threads([pages](Queues& queues) { lend_and_fill(queues, pages, 3); },
                       [](Queues& queues) { adopt_and_free(queues, 3); }, faults);
}

TEST(SlotQueueOrders, a_page_goes_round_without_a_race)
{
    expect_sound("one page, three turns", page_goes_round(1), 11);
    expect_sound("two pages, three turns", page_goes_round(2), 11);
}

TEST(SlotQueueOrders, a_page_handed_over_or_back_by_a_weaker_order_is_found)
{
    for (const std::size_t tail : {kToHapticTail, kToTransportTail})
    {
        for (const bool is_store : {false, true})
        {
            const std::array faults{Fault{.location = tail, .is_store = is_store}};
            EXPECT_EQ(page_goes_round(1, faults).failure.substr(0, 4), "race")
                << tail << ' ' << is_store;
        }
    }
}

/// Frees a page before each request, twice; a request carries the number freed before it.
void free_and_request(Queues& queues)
{
    for (std::uint32_t freed = 1; freed <= 2; ++freed)
    {
        require(queues.freed.try_push(freed), "no room for a freed page");
        require(queues.wanted.try_push(freed), "no room for a request");
    }
}

/// ChunkLoader::step(): requests are counted before the freed pages are taken.
void take_freed_and_requests(Queues& queues, bool counts_first)
{
    std::uint32_t taken = 0;
    for (int step = 0; step < 2; ++step)
    {
        const std::size_t counted = queues.wanted.size();
        for (std::uint32_t slot = 0; queues.freed.try_pop(slot);)
        {
            ++taken;
        }
        const std::size_t requests = counts_first ? counted : queues.wanted.size();
        std::uint32_t request = 0;
        for (std::size_t i = 0; i < requests && queues.wanted.try_pop(request); ++i)
        {
            require(taken >= request, "a request came before the freeing that went before it");
        }
    }
}

Exploration requests_after_freeing(bool counts_first, std::span<const Fault> faults = {})
{
    return two_threads([=](Queues& queues) { take_freed_and_requests(queues, counts_first); },
                       free_and_request, faults);
}

TEST(SlotQueueOrders, whoever_takes_a_request_has_taken_what_was_freed_before_it)
{
    expect_sound("two pages freed, each before a request", requests_after_freeing(true), 11);
}

TEST(SlotQueueOrders, requests_counted_too_late_or_published_too_weakly_are_found)
{
    EXPECT_EQ(requests_after_freeing(false).failure.substr(0, 26), "a request came before the ");
    for (const bool is_store : {false, true})
    {
        const std::array faults{Fault{.location = kWantedTail, .is_store = is_store}};
        EXPECT_NE(requests_after_freeing(true, faults).failure, "") << is_store;
    }
}

enum class Telling
{
    in_order,         ///< Order of Linker and ChunkLoader.
    before_it_is_so,  ///< The linked bit is pushed before `next` and the record are written.
    is_not_waited_for ///< The haptic thread reads the record of a page that has only arrived.
};

/// Hands over a page with a waiting record. Then the record is linked: its content is written in
/// the page that the haptic thread has, `next` of its owner is set, and it is notified.
Exploration link_later(Telling telling, std::span<const Fault> faults = {})
{
    constexpr std::uint32_t kArrival = 1;
    constexpr std::uint32_t kUpdate = 2;
    constexpr std::uint32_t kId = 7;
    const QueueBody transport = [=](Queues& queues)
    {
        queues.pages[0] = 1;
        require(queues.arrived.try_push(kArrival), "no room for an arrival");
        if (telling == Telling::before_it_is_so)
        {
            require(queues.arrived.try_push(kUpdate), "no room for an update");
        }
        queues.pages[1] = 1; // The record: unlinked until here, owned by the transport thread.
        queues.next.store(kId, std::memory_order_relaxed);
        if (telling != Telling::before_it_is_so)
        {
            require(queues.arrived.try_push(kUpdate), "no room for an update");
        }
    };
    const QueueBody haptic = [=](Queues& queues)
    {
        bool is_told = false;
        for (int frame = 0; frame < 3; ++frame)
        {
            std::uint32_t event = 0;
            if (queues.arrived.try_pop(event))
            {
                require(queues.pages[0] == 1, "a page without its content");
                is_told = is_told || event == kUpdate;
            }
            const std::uint32_t next = queues.next.load(std::memory_order_relaxed);
            require(next == kId || next == kPending, "a next out of nowhere");
            require(!is_told || next == kId, "a record is told as linked before its next is set");
            if (is_told || (telling == Telling::is_not_waited_for && event == kArrival))
            {
                require(queues.pages[1] == 1, "a record is told as linked before it is whole");
            }
        }
    };
    return two_threads(transport, haptic, faults);
}

TEST(SlotQueueOrders, a_record_told_as_linked_is_whole_and_its_next_is_set)
{
    expect_sound("a record linked after its page's arrival", link_later(Telling::in_order), 11);
}

TEST(SlotQueueOrders, a_record_told_too_early_or_read_untold_is_found)
{
    EXPECT_NE(link_later(Telling::before_it_is_so).failure, "");
    EXPECT_EQ(link_later(Telling::is_not_waited_for).failure.substr(0, 4), "race");
    for (const bool is_store : {false, true})
    {
        const std::array faults{Fault{.location = kToHapticTail, .is_store = is_store}};
        EXPECT_NE(link_later(Telling::in_order, faults).failure, "") << is_store;
    }
}

} // namespace
} // namespace tactus::interleave
