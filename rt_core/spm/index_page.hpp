// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/spm/header.hpp"

#include <array>
#include <cstdint>
#include <span>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// A chunk's influence box in steps of its index page's box, rounded outward: a sphere that misses
/// it needs no record of the chunk. `low > high` on an axis never occurs.
struct InfluenceBox
{
    std::array<std::uint16_t, 3> low{};
    std::array<std::uint16_t, 3> high{};
};

/// Lower level of the influence-box index: the boxes of 64 consecutive chunks, as rows.
struct IndexPage
{
    using Row = std::array<std::uint16_t, kChunksPerIndexPage>;

    std::array<Row, 3> low{};
    std::array<Row, 3> high{};
    std::uint32_t chunks{0}; ///< 1 .. 64; below 64 only in the last page.

    [[nodiscard]] InfluenceBox box(std::size_t chunk) const noexcept
    {
        TACTUS_ASSERT(chunk < chunks);
        return {{low[0][chunk], low[1][chunk], low[2][chunk]},
                {high[0][chunk], high[1][chunk], high[2][chunk]}};
    }
    void set_box(std::size_t chunk, const InfluenceBox& box) noexcept
    {
        TACTUS_ASSERT(chunk < kChunksPerIndexPage);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low[axis][chunk] = box.low[axis];
            high[axis][chunk] = box.high[axis];
        }
    }
};

/// A sphere in the quanta of a model.
struct QuantumSphere
{
    std::array<double, 3> center{};
    double radius{0.0};
};

/// Squared distance of a place from a box, in quanta; 0 inside.
[[nodiscard]] double distance_sq(const std::array<double, 3>& place,
                                 const QuantumBox& box) noexcept TACTUS_NONBLOCKING;

[[nodiscard]] inline bool meets(const QuantumSphere& sphere, const QuantumBox& box) noexcept
{
    return distance_sq(sphere.center, box) <= sphere.radius * sphere.radius;
}

/// Influence box of a chunk; `page_box` is its page's box.
[[nodiscard]] QuantumBox box_of(const IndexPage& page, const QuantumBox& page_box,
                                std::size_t chunk) noexcept TACTUS_NONBLOCKING;

/// Size and hash of a coded chunk, for the transport thread.
struct ChunkEntry
{
    std::uint16_t coded_bytes{0};
    ContentHash hash{};
};

/// Length, in quanta, of a step of an index page's boxes along an axis: the least with which 16
/// bits reach from `low` to `high`.
[[nodiscard]] constexpr std::uint32_t index_step(std::int32_t low, std::int32_t high) noexcept
{
    TACTUS_ASSERT(low <= high);
    const auto extent = static_cast<std::uint64_t>(static_cast<std::int64_t>(high) -
                                                   static_cast<std::int64_t>(low));
    return static_cast<std::uint32_t>(extent / 65'535 + 1);
}

/// Size of one entry in the coded page: box, coded size, hash.
inline constexpr std::size_t kIndexEntryBytes = 12 + 2 + 16;
/// Size of a coded index page: page number, entries, checksum.
[[nodiscard]] constexpr std::size_t coded_index_page_bytes(std::uint32_t chunks) noexcept
{
    TACTUS_ASSERT(chunks <= kChunksPerIndexPage);
    return 4 + chunks * kIndexEntryBytes + kChecksumBytes;
}
/// Number of chunks in an index page.
[[nodiscard]] constexpr std::uint32_t chunks_in_index_page(const ModelCounts& counts,
                                                           IndexPageId page) noexcept
{
    TACTUS_ASSERT(page.value < counts.index_pages());
    const std::uint32_t left = counts.chunks() - (page.value << kChunksPerIndexPageLog2);
    return left < kChunksPerIndexPage ? left : kChunksPerIndexPage;
}

/// Reads the coded index page `id` of a model. `entries` has room for 64 and receives one
/// ChunkEntry per chunk. On refusal the outputs are unspecified.
[[nodiscard]] Result<Done, SpmRefusal> parse_index_page(std::span<const std::byte> bytes,
                                                        const ModelCounts& counts, IndexPageId id,
                                                        IndexPage& page,
                                                        std::span<ChunkEntry> entries) noexcept;

} // namespace tactus
