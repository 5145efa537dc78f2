// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/index_page.hpp"

#include "rt_core/base/byte_io.hpp"
#include "rt_core/base/crc32c.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

bool read_entry(ByteReader& reader, InfluenceBox& box, ChunkEntry& entry) noexcept
{
    box = reader.read<InfluenceBox>();
    entry.coded_bytes = reader.read<std::uint16_t>();
    entry.hash = reader.read<ContentHash>();
    return box.low[0] <= box.high[0] && box.low[1] <= box.high[1] && box.low[2] <= box.high[2] &&
           entry.coded_bytes > 0 && entry.coded_bytes <= kMaxCodedChunkBytes;
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

double distance_sq(const std::array<double, 3>& place, const QuantumBox& box) noexcept
{
    double sum = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double gap = std::max({static_cast<double>(box.low[axis]) - place[axis],
                                     place[axis] - static_cast<double>(box.high[axis]), 0.0});
        sum += gap * gap;
    }
    return sum;
}

QuantumBox box_of(const IndexPage& page, const QuantumBox& page_box, std::size_t chunk) noexcept
{
    const InfluenceBox steps = page.box(chunk);
    QuantumBox box;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const std::uint32_t step = index_step(page_box.low[axis], page_box.high[axis]);
        const auto at = [&](std::uint16_t steps_up)
        { return page_box.low[axis] + static_cast<std::int32_t>(step * steps_up); };
        box.low[axis] = at(steps.low[axis]);
        box.high[axis] = at(steps.high[axis]);
    }
    return box;
}

} // namespace tactus
