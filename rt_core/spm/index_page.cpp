// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/index_page.hpp"

#include "rt_core/base/byte_io.hpp"
#include "rt_core/base/crc32c.hpp"
#include "rt_core/math/four_lanes.hpp"
#include "rt_core/math/rounding.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace tactus
{

namespace
{

/// Of an index page's boxes.
constexpr double kLastStep = 65'535.0;

bool read_entry(ByteReader& reader, InfluenceBox& box, ChunkEntry& entry) noexcept
{
    box = reader.read<InfluenceBox>();
    entry.coded_bytes = reader.read<std::uint16_t>();
    entry.hash = reader.read<ContentHash>();
    return box.low[0] <= box.high[0] && box.low[1] <= box.high[1] && box.low[2] <= box.high[2] &&
           entry.coded_bytes > 0 && entry.coded_bytes <= kMaxCodedChunkBytes;
}

EightUnsigned eight_of(const std::uint16_t* from) noexcept
{
    EightUnsigned lanes;
    std::memcpy(&lanes, from, sizeof lanes);
    return lanes;
}

} // namespace

Result<Done, SpmRefusal> parse_index_page(std::span<const std::byte> bytes,
                                          const ModelCounts& counts, IndexPageId id,
                                          IndexPage& page, std::span<ChunkEntry> entries) noexcept
{
    TACTUS_ASSERT(id.value < counts.index_pages());
    TACTUS_ASSERT(entries.size() >= kChunksPerIndexPage);
    page.chunks = chunks_in_index_page(counts, id);
    const std::size_t expected = coded_index_page_bytes(page.chunks);
    if (bytes.size() != expected)
    {
        return bytes.size() < expected ? SpmRefusal::too_short : SpmRefusal::trailing_bytes;
    }
    ByteReader reader(bytes);
    const auto number = reader.read<std::uint32_t>();
    bool in_range = true;
    for (std::uint32_t i = 0; i < page.chunks; ++i)
    {
        InfluenceBox box;
        in_range = read_entry(reader, box, entries[i]) && in_range;
        page.set_box(i, box);
    }
    if (reader.read<std::uint32_t>() != crc32c(bytes.first(bytes.size() - kChecksumBytes)))
    {
        return SpmRefusal::wrong_checksum;
    }
    if (number != id.value)
    {
        return SpmRefusal::wrong_identity;
    }
    if (!in_range)
    {
        return SpmRefusal::value_out_of_range;
    }
    return Done{};
}

std::uint64_t chunks_meeting(const IndexPage& page, const QuantumBox& page_box,
                             const QuantumBall& ball, std::uint64_t known) noexcept
{
    std::array<double, 3> step{};
    std::array<double, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        step[axis] = static_cast<double>(index_step(page_box.low[axis], page_box.high[axis]));
        at[axis] = ball.center[axis] - static_cast<double>(page_box.low[axis]);
    }
    // What the ball spans on each axis, in steps; a step more on both sides than rounding can be.
    std::array<EightUnsigned, 3> lows{};
    std::array<EightUnsigned, 3> highs{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double reach = ball.radius * kWidened;
        const double low = (at[axis] - reach) / step[axis] - 1.0;
        const double high = (at[axis] + reach) / step[axis] + 1.0;
        const bool is_in_page = low <= kLastStep && high >= 0.0;
        if (!is_in_page)
        {
            return known;
        }
        lows[axis] = EightUnsigned{} + static_cast<std::uint16_t>(std::max(low, 0.0));
        highs[axis] = EightUnsigned{} + static_cast<std::uint16_t>(std::min(high, kLastStep));
    }
    std::uint64_t near = 0;
    for (std::size_t first = 0; first < page.chunks; first += 8)
    {
        EightUnsigned outside{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            outside |= excess(eight_of(&page.low[axis][first]), highs[axis]);
            outside |= excess(lows[axis], eight_of(&page.high[axis][first]));
        }
        near |= std::uint64_t{bits_of(outside == EightUnsigned{})} << first;
    }
    std::uint64_t meeting = known;
    const std::uint64_t all = ~std::uint64_t{0} >> (kChunksPerIndexPage - page.chunks);
    for (near &= all & ~known; near != 0; near &= near - 1)
    {
        const auto i = static_cast<std::size_t>(std::countr_zero(near));
        double distance_sq = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const double below = static_cast<double>(page.low[axis][i]) * step[axis] - at[axis];
            const double above = at[axis] - static_cast<double>(page.high[axis][i]) * step[axis];
            const double gap = std::max({below, above, 0.0});
            distance_sq += gap * gap;
        }
        meeting |= distance_sq <= ball.radius * ball.radius ? std::uint64_t{1} << i : 0U;
    }
    return meeting;
}

} // namespace tactus
