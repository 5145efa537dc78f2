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

enum class DoorEventKind : std::uint8_t
{
    arrival,     ///< A filled slot, handed over.
    link_update, ///< More records of a page that was handed over before are linked now.
    base_back,   ///< A base mesh doesn't come: the cells that were lent for it are given back.
};

/// What the transport thread tells the haptic thread about one slot, in order. Together these are
/// all that a frame learns from outside besides its arguments, so a recording keeps them.
struct DoorEvent
{
    ContentKey key;
    std::uint32_t slot{0}; ///< Of a base mesh: the first of its cells.
    /// For an arrival: slots that the transport thread had taken back in all when it linked the
    /// page (modulo 2^32). Linking depends on it, so a replay waits for the same number.
    std::uint32_t freed_taken{0};
    static_assert(kRecordsPerChunk <= 64);
    std::uint64_t linked{0}; ///< One bit a record of the chunk; none for an index page.
    DoorEventKind kind{DoorEventKind::arrival};
    std::uint8_t owner{0}; ///< The model that the piece is of.
};

static_assert(sizeof(DoorEvent) == 32 && std::is_trivially_copyable_v<DoorEvent>);

/// What a frame took from the door.
struct DoorTake
{
    std::span<const DoorEvent> events; ///< In the order in which they were taken.
    std::uint32_t wish_room{0};        ///< How many wishes the door had room for.
};

} // namespace tactus
