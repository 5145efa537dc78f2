// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/chunk_coding.hpp"

#include "rt_core/base/byte_io.hpp"
#include "rt_core/base/crc32c.hpp"
#include "rt_core/spm/range_decoder.hpp"

#include <cmath>

namespace tactus
{

namespace
{

using Owner = CodedRecord::Owner;

/// Larger than any difference of two places on the grid.
constexpr std::int32_t kMaxResidual = 1 << 27;

bool is_possible(const Owner& owner, RecordId id, const ModelCounts& counts) noexcept
{
    switch (owner.kind)
    {
    case Owner::Kind::derived:
        return true;
    case Owner::Kind::base:
        return owner.value < counts.base_faces;
    case Owner::Kind::record:
        return owner.value < counts.records && owner.value != id.value;
    }
    return false;
}

bool is_possible(const CodedRecord& record, RecordId id, const ModelCounts& counts) noexcept
{
    bool all = record.fan_size() <= kMaxFanFaces && record.corner < 3 &&
               is_possible(record.anchor, id, counts);
    for (const Owner& owner : record.others)
    {
        all = all && is_possible(owner, id, counts);
    }
    for (const std::int32_t residual : record.residual)
    {
        all = all && residual >= -kMaxResidual && residual <= kMaxResidual;
    }
    return all;
}

} // namespace

Result<Done, SpmRefusal> parse_chunk(std::span<const std::byte> bytes, const ModelHeader& header,
                                     ChunkId id, Page& page) noexcept
{
    const ModelCounts counts = header.counts();
    TACTUS_ASSERT(id.value < counts.chunks());
    if (bytes.size() < kChecksumBytes)
    {
        return SpmRefusal::too_short;
    }
    const auto code = bytes.first(bytes.size() - kChecksumBytes);
    if (ByteReader(bytes.last(kChecksumBytes)).read<std::uint32_t>() != chunk_checksum(code, id))
    {
        return SpmRefusal::wrong_checksum;
    }
    RangeDecoder decoder(code);
    ChunkGrammar grammar(decoder, counts, id);
    page = Page{};
    for (std::uint32_t place = 0; place < records_in_chunk(counts, id); ++place)
    {
        const RecordId record{(id.value << kRecordsPerChunkLog2) + place};
        CodedRecord coded;
        grammar.code(record, coded);
        if (!grammar.is_sound() || !is_possible(coded, record, counts))
        {
            return SpmRefusal::value_out_of_range;
        }
        page.records[place] = waiting_form(coded);
    }
    return decoder.has_bytes_left() ? Result<Done, SpmRefusal>(SpmRefusal::trailing_bytes) : Done{};
}

std::uint32_t chunk_checksum(std::span<const std::byte> code, ChunkId id) noexcept
{
    const std::array<std::uint32_t, 1> number{id.value};
    return crc32c(std::as_bytes(std::span(number)), crc32c(code));
}

} // namespace tactus
