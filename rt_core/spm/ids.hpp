// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/base/model_id.hpp"
#include "rt_core/base/strong_id.hpp"
#include "rt_core/limits.hpp"

#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Number of a vsplit record: by tier, then along a Morton curve.
using RecordId = StrongId<struct RecordTag>;
/// Number of a chunk, which is 64 consecutive records.
using ChunkId = StrongId<struct ChunkTag>;
/// Number of an index page, which covers 64 consecutive chunks.
using IndexPageId = StrongId<struct IndexPageTag>;
/// Number of a vertex: base vertices first, then one per record.
using VertexId = StrongId<struct VertexTag>;
/// Number of a face: base faces first, then two per record, 2 x record + side. The same in every
/// run.
using FaceId = StrongId<struct FaceTag>;
/// Number of a cell of the header's regular partition.
using RegionId = StrongId<struct RegionTag>;

inline constexpr std::uint32_t kRecordsPerChunkLog2 = 6;
inline constexpr std::uint32_t kRecordsPerChunk = 1U << kRecordsPerChunkLog2;
inline constexpr std::uint32_t kChunksPerIndexPageLog2 = 6;
inline constexpr std::uint32_t kChunksPerIndexPage = 1U << kChunksPerIndexPageLog2;

/// Number of ids of each kind in one model, and the arithmetic of ids. Ids that the model doesn't
/// have are a bug: record_of(), vertex_of() and face_of() assert.
struct ModelCounts
{
    std::uint32_t base_vertices{0};
    std::uint32_t base_faces{0};
    std::uint32_t records{0};

    [[nodiscard]] constexpr std::uint32_t vertices() const noexcept
    {
        return base_vertices + records;
    }
    /// Upper end of the FaceId range; a record on a border leaves one of its two ids unused.
    [[nodiscard]] constexpr std::uint32_t face_ids() const noexcept
    {
        return base_faces + 2 * records;
    }
    [[nodiscard]] constexpr std::uint32_t chunks() const noexcept
    {
        return (records + kRecordsPerChunk - 1) >> kRecordsPerChunkLog2;
    }
    [[nodiscard]] constexpr std::uint32_t index_pages() const noexcept
    {
        return (chunks() + kChunksPerIndexPage - 1) >> kChunksPerIndexPageLog2;
    }
    [[nodiscard]] constexpr bool is_base(VertexId vertex) const noexcept
    {
        return vertex.value < base_vertices;
    }
    [[nodiscard]] constexpr bool is_base(FaceId face) const noexcept
    {
        return face.value < base_faces;
    }
    [[nodiscard]] constexpr RecordId record_of(VertexId vertex) const noexcept
    {
        TACTUS_ASSERT(!is_base(vertex));
        TACTUS_ASSERT(vertex.value < vertices());
        return {vertex.value - base_vertices};
    }
    [[nodiscard]] constexpr VertexId vertex_of(RecordId record) const noexcept
    {
        TACTUS_ASSERT(record.value < records);
        return {record.value + base_vertices};
    }
    /// The face that appears on side 0 (A) or 1 (B) when the record is split.
    [[nodiscard]] constexpr FaceId face_of(RecordId record, std::uint32_t side) const noexcept
    {
        TACTUS_ASSERT(record.value < records);
        TACTUS_ASSERT(side < 2);
        return {base_faces + 2 * record.value + side};
    }
};

[[nodiscard]] constexpr ChunkId chunk_of(RecordId record) noexcept
{
    return {record.value >> kRecordsPerChunkLog2};
}

[[nodiscard]] constexpr std::uint32_t place_in_chunk(RecordId record) noexcept
{
    return record.value & (kRecordsPerChunk - 1);
}

} // namespace tactus
