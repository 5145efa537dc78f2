// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/content_key.hpp"
#include "rt_core/spm/ids.hpp"

#include <cstdint>
#include <span>
#include <type_traits>

namespace tactus
{

enum class QueueEventKind : std::uint8_t
{
    arrival,     ///< A filled slot is handed to the haptic thread.
    link_update, ///< More records of an adopted page are linked.
    /// A requested base mesh does not arrive; its memory cells are returned.
    base_back,
};

/// Message of the transport thread to the haptic thread about one slot. A frame receives nothing
/// else from outside besides its arguments, so a recording keeps all messages, in order.
struct QueueEvent
{
    ContentKey key;
    std::uint32_t slot{0}; ///< Number of the slot; for a base mesh the number of its first cell.
    /// Slots that the transport thread had taken back in all (modulo 2^32) when it linked an
    /// arrived page. Linking depends on this number, so a replay waits until it is the same.
    std::uint32_t freed_taken{0};
    static_assert(kRecordsPerChunk <= 64);
    std::uint64_t linked{0}; ///< Linked records of the chunk, one bit each; 0 for an index page.
    QueueEventKind kind{QueueEventKind::arrival};
    std::uint8_t owner{0}; ///< Model that the piece belongs to.
};

static_assert(sizeof(QueueEvent) == 32 && std::is_trivially_copyable_v<QueueEvent>);

/// Events that a frame took from the queues.
struct QueueTake
{
    std::span<const QueueEvent> events; ///< Events in the order in which they were taken.
    std::uint32_t request_room{0};      ///< Number of requests that the queues had room for.
};

} // namespace tactus
