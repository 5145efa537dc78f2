// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/spsc_queue.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/door_event.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace tactus
{

/// A slot that the haptic thread has no more use for. A model's base mesh goes after all its pages,
/// and so do cells that were given back for it.
struct FreedSlot
{
    ContentKind kind{ContentKind::chunk};
    std::uint32_t slot{0};       ///< Of a base mesh: the model that it is of.
    std::uint32_t generation{0}; ///< Of a base mesh: older wishes for it are of no use any more.
};

/// A piece that the haptic thread wants. Wishes of an older generation may be dropped.
struct PieceWish
{
    ContentKey key; ///< Of a base mesh, the number is the first cell of those that are lent for it.
    std::uint32_t generation{0};
    std::uint8_t owner{0}; ///< The model that the piece is of.
};

/// The one door between the transport thread and the haptic thread, for all models. Slots, words of
/// linked bits and wishes cross it, each kind in one order, and nothing else.
///
/// A slot of PageSlots (a page, or an index page), and the cells of a base mesh, which the haptic
/// thread lends with its wish, have one owner at a time:
///
///     transport: loan (parse into it) -> fill -> hand over (`arrived`)
///     haptic:    adopt -> use -> evict -> free (`freed`) -> the transport's again
///
/// Cells that no base mesh came for are given back through `arrived`, and the haptic thread says
/// that it knows through `freed`, so that no older wish lends them again.
///
/// At start every slot is the transport's. `arrived` keeps arrivals and link updates in one order,
/// so what a frame learns is what it popped, however the threads ran.
struct SlotDoor
{
    /// Wishes of all models under way at once: what the transport side remembers. With more it
    /// would forget the oldest, however urgent, and what it forgets is asked again when it times
    /// out.
    static constexpr std::uint32_t kOpenWishes = 256;

    /// `slots` are all that may cross it. Room for each in both queues, so those never refuse, and
    /// for link updates while those leave arrivals their room (has_room_for_update()); for so many
    /// wishes.
    SlotDoor(Arena& arena, std::size_t slots, std::size_t wishes) noexcept
        : arrived(arena.take<DoorEvent>(slots + kMaxLinkUpdatesPerFrame))
        , freed(arena.take<FreedSlot>(std::max<std::size_t>(slots, 1)))
        , wanted(arena.take<PieceWish>(std::max<std::size_t>(wishes, 1)))
    {
    }

    /// Whether a link update may be pushed: with fewer than kMaxLinkUpdatesPerFrame events waiting
    /// no more than that many updates are ever among them, and every arrival finds room.
    [[nodiscard]] bool has_room_for_update() const noexcept
    {
        return arrived.size() < kMaxLinkUpdatesPerFrame;
    }

    SpscQueue<DoorEvent> arrived; ///< Transport -> haptic.
    SpscQueue<FreedSlot> freed;   ///< Haptic -> transport.
    SpscQueue<PieceWish> wanted;  ///< Haptic -> transport.
};

} // namespace tactus
