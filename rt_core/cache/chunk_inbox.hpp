// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/spsc_queue.hpp"
#include "rt_core/spm/content_key.hpp"

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
/// At start every slot is the transport's. Nothing else crosses, in either direction, but wishes.
class ChunkInbox
{
public:
    /// A filled slot, handed over to the haptic thread.
    struct Arrival
    {
        ContentKey key;
        std::uint32_t slot{0};
    };
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

    /// Room for every slot in both slot queues, so those never refuse, and for `wishes` wishes.
    ChunkInbox(Arena& arena, std::uint32_t page_capacity, std::uint32_t index_capacity,
               std::uint32_t wishes) noexcept
        : arrived(arena.take<Arrival>(std::size_t{page_capacity} + index_capacity))
        , freed(arena.take<Freed>(std::size_t{page_capacity} + index_capacity))
        , wanted(arena.take<Wish>(wishes))
    {
    }

    SpscQueue<Arrival> arrived; ///< Transport -> haptic.
    SpscQueue<Freed> freed;     ///< Haptic -> transport.
    SpscQueue<Wish> wanted;     ///< Haptic -> transport.
};

} // namespace tactus
