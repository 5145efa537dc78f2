// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/spsc_queue.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/queue_event.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace tactus
{

/// A slot that the haptic thread returns, or a base mesh, after all pages of its model. Cells that
/// came back without a mesh are confirmed with the same message.
struct FreedSlot
{
    ContentKind kind{ContentKind::chunk};
    std::uint32_t slot{0};       ///< Slot; for a base mesh its model.
    std::uint32_t generation{0}; ///< Requests for a base mesh with a lower generation are void.
};

/// A request of the haptic thread for a piece. Requests of an older generation may be dropped.
struct PieceRequest
{
    ContentKey key; ///< Key of the piece; for a base mesh, the number is the first of the cells
                    ///< lent for it.
    std::uint32_t generation{0};
    std::uint8_t owner{0}; ///< Model that the piece belongs to.
};

/// Queues between the transport thread and the haptic thread, for all models. Only slots, words of
/// linked bits and requests pass through them, each kind in order.
///
/// A slot of PageSlots (page or index page) has one owner at a time. So have the cells of a base
/// mesh, which the haptic thread lends with its request:
///
///     transport: loan (parse into it) -> fill -> hand over (`arrived`)
///     haptic:    adopt -> use -> evict -> free (`freed`) -> the transport's again
///
/// Cells for which no base mesh arrived are returned through `arrived`; the haptic thread confirms
/// that through `freed`, so that no older request lends them again.
///
/// Every slot starts as the transport's. `arrived` keeps arrivals and link updates in one order, so
/// a frame's input is what it popped, independent of thread timing.
struct SlotQueues
{
    /// Largest number of requests under way, of all models: the transport thread remembers no more.
    /// It would drop the oldest, regardless of priority, and dropped requests are repeated only
    /// after the timeout.
    static constexpr std::uint32_t kOpenRequests = 256;

    /// `slots` is the number of all slots: `arrived` and `freed` have room for each. `arrived` also
    /// holds link updates (has_room_for_update()), and `wanted` holds `requests`.
    SlotQueues(Arena& arena, std::size_t slots, std::size_t requests) noexcept
        : arrived(arena.take<QueueEvent>(slots + kMaxLinkUpdatesPerFrame))
        , freed(arena.take<FreedSlot>(std::max<std::size_t>(slots, 1)))
        , wanted(arena.take<PieceRequest>(std::max<std::size_t>(requests, 1)))
    {
    }

    /// True if a link update may be pushed. Updates need fewer than kMaxLinkUpdatesPerFrame waiting
    /// events, so at most that many updates are in the queue, and every arrival finds room.
    [[nodiscard]] bool has_room_for_update() const noexcept
    {
        return arrived.size() < kMaxLinkUpdatesPerFrame;
    }

    SpscQueue<QueueEvent> arrived;  ///< Transport -> haptic.
    SpscQueue<FreedSlot> freed;     ///< Haptic -> transport.
    SpscQueue<PieceRequest> wanted; ///< Haptic -> transport.
};

} // namespace tactus
