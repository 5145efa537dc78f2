// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/page.hpp"

#include <span>

namespace tactus
{

/// A chunk in coder version 3: CodedRecords in a range code (rt_core/spm/chunk_grammar.hpp), then a
/// checksum. The caller knows the chunk's number and its count of records.

/// Reads the coded chunk `id`: each record of `page` is then the waiting_form() of the chunk's
/// record, for the linker to resolve; unused records of a last, shorter page are cleared. Needs
/// this chunk's bytes only. On refusal the page is unspecified. 64 records at most, no allocation;
/// transport thread.
[[nodiscard]] Result<Done, SpmRefusal> parse_chunk(std::span<const std::byte> bytes,
                                                   const ModelHeader& header, ChunkId id,
                                                   Page& page) noexcept;

/// CRC-32C of a chunk's code followed by the chunk's number.
[[nodiscard]] std::uint32_t chunk_checksum(std::span<const std::byte> code, ChunkId id) noexcept;

/// Number of records in a chunk: 64 except in the last one.
[[nodiscard]] constexpr std::uint32_t records_in_chunk(const ModelCounts& counts,
                                                       ChunkId chunk) noexcept
{
    TACTUS_ASSERT(chunk.value < counts.chunks());
    const std::uint32_t left = counts.records - (chunk.value << kRecordsPerChunkLog2);
    return left < kRecordsPerChunk ? left : kRecordsPerChunk;
}

} // namespace tactus
