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

/// Assumptions of the two threads at the door besides each queue alone: a page circulates without a
/// race; a thread that sees a request sees the earlier freeing; a notified linked record is read
/// completely. Uses the product's queues, with verbs as in Courier, Linker and ChunkCache, reduced
/// to shared accesses. Thread 0 is the transport's.
namespace tactus::interleave
{
namespace
{

template <typename T>
using CheckedQueue = SpscQueue<T, CheckedAtomic, CheckedSlot<T>>;

/// Locations in the order in which a Door builds them.
constexpr std::size_t kToHapticTail = 1;
constexpr std::size_t kToTransportTail = 3;
constexpr std::size_t kWantedTail = 5;
constexpr std::uint32_t kPending = 99;

struct Door
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
using DoorBody = std::function<void(Door&)>;

Exploration two_threads(const DoorBody& transport, const DoorBody& haptic,
                        std::span<const Fault> faults = {})
{
    return explore_small<Door>({transport, haptic}, {}, faults);
}

/// Fills free pages with ascending numbers and hands them over, `turns` times.
void lend_and_fill(Door& door, std::uint32_t pages, int turns)
{
    std::uint32_t free = pages; // Number of pages on `stack`, as in the loader.
    std::array<std::uint32_t, 2> stack{0, 1};
    std::uint32_t number = 0;
    for (int turn = 0; turn < turns; ++turn)
    {
        std::uint32_t slot = 0;
        if (door.freed.try_pop(slot))
        {
            require(free < pages, "a page was freed twice");
            stack.at(free++) = slot;
        }
        if (free > 0)
        {
            slot = stack.at(--free);
            door.pages.at(slot) = ++number;
            require(door.arrived.try_push(slot), "no room for an arrival");
        }
    }
}

void adopt_and_free(Door& door, int turns)
{
    std::uint32_t last = 0;
    for (int turn = 0; turn < turns; ++turn)
    {
        std::uint32_t slot = 0;
        if (door.arrived.try_pop(slot))
        {
            const std::uint32_t number = door.pages.at(slot);
            require(number == ++last, "a page with another one's content");
            require(door.freed.try_push(slot), "no room for a freed page");
        }
    }
}

Exploration page_goes_round(std::uint32_t pages, std::span<const Fault> faults = {})
{
    return two_threads([pages](Door& door) { lend_and_fill(door, pages, 3); },
                       [](Door& door) { adopt_and_free(door, 3); }, faults);
}

TEST(DoorOrders, a_page_goes_round_without_a_race)
{
    expect_sound("one page, three turns", page_goes_round(1), 11);
    expect_sound("two pages, three turns", page_goes_round(2), 11);
}

TEST(DoorOrders, a_page_handed_over_or_back_by_a_weaker_order_is_found)
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
void free_and_wish(Door& door)
{
    for (std::uint32_t freed = 1; freed <= 2; ++freed)
    {
        require(door.freed.try_push(freed), "no room for a freed page");
        require(door.wanted.try_push(freed), "no room for a wish");
    }
}

/// Courier::step(): requests are counted before the freed pages are taken.
void take_freed_and_wishes(Door& door, bool counts_first)
{
    std::uint32_t taken = 0;
    for (int step = 0; step < 2; ++step)
    {
        const std::size_t counted = door.wanted.size();
        for (std::uint32_t slot = 0; door.freed.try_pop(slot);)
        {
            ++taken;
        }
        const std::size_t wishes = counts_first ? counted : door.wanted.size();
        std::uint32_t wish = 0;
        for (std::size_t i = 0; i < wishes && door.wanted.try_pop(wish); ++i)
        {
            require(taken >= wish, "a wish came before the freeing that went before it");
        }
    }
}

Exploration wishes_after_freeing(bool counts_first, std::span<const Fault> faults = {})
{
    return two_threads([=](Door& door) { take_freed_and_wishes(door, counts_first); },
                       free_and_wish, faults);
}

TEST(DoorOrders, whoever_takes_a_wish_has_taken_what_was_freed_before_it)
{
    expect_sound("two pages freed, each before a wish", wishes_after_freeing(true), 11);
}

TEST(DoorOrders, wishes_counted_too_late_or_published_too_weakly_are_found)
{
    EXPECT_EQ(wishes_after_freeing(false).failure.substr(0, 23), "a wish came before the ");
    for (const bool is_store : {false, true})
    {
        const std::array faults{Fault{.location = kWantedTail, .is_store = is_store}};
        EXPECT_NE(wishes_after_freeing(true, faults).failure, "") << is_store;
    }
}

enum class Telling
{
    in_order,         ///< Order of Linker and Courier.
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
    const DoorBody transport = [=](Door& door)
    {
        door.pages[0] = 1;
        require(door.arrived.try_push(kArrival), "no room for an arrival");
        if (telling == Telling::before_it_is_so)
        {
            require(door.arrived.try_push(kUpdate), "no room for an update");
        }
        door.pages[1] = 1; // The record: unlinked until here, owned by the transport thread.
        door.next.store(kId, std::memory_order_relaxed);
        if (telling != Telling::before_it_is_so)
        {
            require(door.arrived.try_push(kUpdate), "no room for an update");
        }
    };
    const DoorBody haptic = [=](Door& door)
    {
        bool is_told = false;
        for (int frame = 0; frame < 3; ++frame)
        {
            std::uint32_t event = 0;
            if (door.arrived.try_pop(event))
            {
                require(door.pages[0] == 1, "a page without its content");
                is_told = is_told || event == kUpdate;
            }
            const std::uint32_t next = door.next.load(std::memory_order_relaxed);
            require(next == kId || next == kPending, "a next out of nowhere");
            require(!is_told || next == kId, "a record is told as linked before its next is set");
            if (is_told || (telling == Telling::is_not_waited_for && event == kArrival))
            {
                require(door.pages[1] == 1, "a record is told as linked before it is whole");
            }
        }
    };
    return two_threads(transport, haptic, faults);
}

TEST(DoorOrders, a_record_told_as_linked_is_whole_and_its_next_is_set)
{
    expect_sound("a record linked after its page's arrival", link_later(Telling::in_order), 11);
}

TEST(DoorOrders, a_record_told_too_early_or_read_untold_is_found)
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
