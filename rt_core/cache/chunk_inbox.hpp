// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/spsc_queue.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/door_event.hpp"

#include <cstdint>

namespace tactus
{

/// The one door between the transport thread and the haptic thread, for one model.
///
/// A slot of PageSlots (a page, or an index page) has one owner at a time:
///
///     transport: loan (parse into it) -> fill -> hand over (`arrived`)
///     haptic:    adopt -> use -> evict -> free (`freed`) -> the transport's again
///
/// At start every slot is the transport's. Besides slots, wishes and words of linked bits cross,
/// and nothing else. `arrived` keeps arrivals and link updates in one order, so what a frame learns
/// is what it popped, however the threads ran.
class ChunkInbox
{
public:
    /// A slot that the haptic thread has no more use for. Kind base never occurs.
    struct Freed
    {
        ContentKind kind{ContentKind::chunk};
        std::uint32_t slot{0};
    };
    /// A piece that the haptic thread wants. Wishes of an older generation may be dropped.
    struct Wish
    {
        ContentKey key;
        std::uint32_t generation{0};
    };

    /// Room for every slot in both slot queues, so those never refuse, for `wishes` wishes, and for
    /// link updates while those leave arrivals their room (has_room_for_update()).
    ChunkInbox(Arena& arena, std::uint32_t page_capacity, std::uint32_t index_capacity,
               std::uint32_t wishes) noexcept
        : arrived(arena.take<DoorEvent>(std::size_t{page_capacity} + index_capacity +
                                        kMaxLinkUpdatesPerFrame))
        , freed(arena.take<Freed>(std::size_t{page_capacity} + index_capacity))
        , wanted(arena.take<Wish>(wishes))
    {
    }

    /// Whether a link update may be pushed: with fewer than kMaxLinkUpdatesPerFrame events waiting
    /// no more than that many updates are ever among them, and every arrival finds room.
    [[nodiscard]] bool has_room_for_update() const noexcept
    {
        return arrived.size() < kMaxLinkUpdatesPerFrame;
    }

    SpscQueue<DoorEvent> arrived; ///< Transport -> haptic.
    SpscQueue<Freed> freed;       ///< Haptic -> transport.
    SpscQueue<Wish> wanted;       ///< Haptic -> transport.
};

} // namespace tactus
