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
    arrival,     ///< A filled slot, handed over.
    link_update, ///< More records of a page handed over before are linked.
    /// A base mesh does not arrive: the cells lent for it are returned.
    base_back,
};

/// Message of the transport thread to the haptic thread about one slot, in order. These are all
/// that a frame receives from outside besides its arguments, so a recording keeps them.
struct QueueEvent
{
    ContentKey key;
    std::uint32_t slot{0}; ///< First cell, if the slot is a base mesh's.
    /// For an arrival: the number of slots that the transport thread had taken back in all when it
    /// linked the page (modulo 2^32). Linking depends on it, so a replay waits for the same number.
    std::uint32_t freed_taken{0};
    static_assert(kRecordsPerChunk <= 64);
    std::uint64_t linked{0}; ///< One bit per record of the chunk; 0 for an index page.
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
