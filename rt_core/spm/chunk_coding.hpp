// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/page.hpp"

#include <span>

namespace tactus
{

/// Coder version 1: every field of a record explicit, as little-endian base-128 numbers.
///
///     chunk  = number (4 bytes), records (1 byte, 1 .. 64), record ..., CRC-32C (4 bytes)
///     record = depth, shape (1 byte: fan size | has A << 3 | has B << 4),
///              position (3 signed differences to the record before, in quanta), parent,
///              per fan face: face id, state before (0 = base, else 1 + FaceState value),
///              per face of the star, A and B first: error code (1 byte),
///              bucket of A, bucket of B (of those that are there), reach (1 byte)
///
/// The ids of A and B follow from the record's own id. Parse needs this chunk's bytes only; what
/// ties a record to others is checked when it is linked (rt_core/spm/linker.hpp).

/// Reads the coded chunk `id` into `page`; unused records of a last, shorter page are cleared.
/// Every `next` is exact or pending by its error code. On refusal the page is unspecified. 64
/// records at most, no allocation; transport thread.
[[nodiscard]] Result<Done, SpmRefusal> parse_chunk(std::span<const std::byte> bytes,
                                                   const ModelHeader& header, ChunkId id,
                                                   Page& page) noexcept;

/// How many records a chunk holds: 64 but for the last one.
[[nodiscard]] constexpr std::uint32_t records_in_chunk(const ModelCounts& counts,
                                                       ChunkId chunk) noexcept
{
    const std::uint32_t left = counts.records - (chunk.value << kRecordsPerChunkLog2);
    return left < kRecordsPerChunk ? left : kRecordsPerChunk;
}

} // namespace tactus
