// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/chunk_coding.hpp"

#include "rt_core/base/byte_io.hpp"
#include "rt_core/base/crc32c.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Reads the records of one chunk, each position relative to the one before.
class RecordParser
{
public:
    RecordParser(ByteReader& reader, const ModelHeader& header) noexcept
        : reader_(reader), header_(header), counts_(header.counts())
    {
    }

    /// False when a value is out of range; the reader says whether bytes ran out.
    [[nodiscard]] bool parse(RecordId id, VsplitRecord& record) noexcept
    {
        record = VsplitRecord{};
        const std::uint32_t depth = reader_.read_varint();
        const auto shape = reader_.read<std::uint8_t>();
        const std::uint32_t fan_size = shape & 7U;
        const std::array<bool, 2> appears{(shape & 8U) != 0, (shape & 16U) != 0};
        if (depth == 0 || depth > header_.fields().max_depth || fan_size == 0 ||
            fan_size > kMaxFanFaces || shape > 31 || !(appears[0] || appears[1]))
        {
            return false;
        }
        record.depth = static_cast<std::uint16_t>(depth);
        record.fan_size = static_cast<std::uint8_t>(fan_size);
        for (std::uint32_t side = 0; side < 2; ++side)
        {
            record.star[side] = appears[side] ? counts_.face_of(id, side) : FaceId{};
        }
        return parse_position(record) && parse_parent(id, record) && parse_fan(id, record) &&
               parse_errors(record) && parse_buckets(record) && !reader_.failed();
    }

private:
    bool parse_position(VsplitRecord& record) noexcept
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            position_[axis] += reader_.read_signed_varint();
            if (position_[axis] < 0 ||
                position_[axis] > static_cast<std::int64_t>(header_.fields().extent_quanta[axis]))
            {
                return false;
            }
            record.position_m[axis] = static_cast<float>(position_[axis]) * header_.quantum_m();
        }
        return true;
    }

    bool parse_parent(RecordId id, VsplitRecord& record) noexcept
    {
        record.parent = {reader_.read_varint()};
        return record.parent.value < counts_.vertices() && record.parent != counts_.vertex_of(id);
    }

    bool parse_fan(RecordId id, VsplitRecord& record) noexcept
    {
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            const FaceId face{reader_.read_varint()};
            const std::uint32_t before = reader_.read_varint();
            if (face.value >= counts_.face_ids())
            {
                return false;
            }
            record.star[2 + i] = face;
            record.before[i] = before == 0 ? FaceState::base() : FaceState{before - 1};
            const std::span<const FaceId> earlier = std::span(record.star).subspan(2, i);
            if (!state_is_possible(id, face, record.before[i]) ||
                std::find(earlier.begin(), earlier.end(), face) != earlier.end())
            {
                return false;
            }
        }
        return true;
    }

    [[nodiscard]] bool state_is_possible(RecordId id, FaceId face, FaceState state) const noexcept
    {
        if (state.is_base())
        {
            return counts_.is_base(face);
        }
        return state.record().value < counts_.records && state.record() != id;
    }

    bool parse_errors(VsplitRecord& record) noexcept
    {
        for (std::uint32_t place = 0; place < record.star_end(); ++place)
        {
            if (place < 2 && !record.has_face(place))
            {
                continue;
            }
            record.error[place] = reader_.read<std::uint8_t>();
            record.next[place] = record.error[place] == 0 ? kNextExact : kNextPending;
        }
        return true;
    }

    bool parse_buckets(VsplitRecord& record) noexcept
    {
        for (std::uint32_t side = 0; side < 2; ++side)
        {
            record.bucket[side] = record.has_face(side) ? reader_.read_varint() : 0;
        }
        record.reach = reader_.read<std::uint8_t>();
        return record.reach > 0;
    }

    ByteReader& reader_;
    const ModelHeader& header_;
    ModelCounts counts_;
    std::array<std::int64_t, 3> position_{};
};

} // namespace

Result<Done, SpmRefusal> parse_chunk(std::span<const std::byte> bytes, const ModelHeader& header,
                                     ChunkId id, Page& page) noexcept
{
    const ModelCounts counts = header.counts();
    TACTUS_ASSERT(id.value < counts.chunks());
    if (bytes.size() < 5 + kChecksumBytes)
    {
        return SpmRefusal::too_short;
    }
    const auto content = bytes.first(bytes.size() - kChecksumBytes);
    if (ByteReader(bytes.last(kChecksumBytes)).read<std::uint32_t>() != crc32c(content))
    {
        return SpmRefusal::wrong_checksum;
    }
    ByteReader reader(content);
    const auto number = reader.read<std::uint32_t>();
    const auto records = reader.read<std::uint8_t>();
    if (number != id.value || records != records_in_chunk(counts, id))
    {
        return SpmRefusal::wrong_identity;
    }
    RecordParser parser(reader, header);
    for (std::uint32_t place = 0; place < kRecordsPerChunk; ++place)
    {
        if (place >= records)
        {
            page.records[place] = VsplitRecord{};
        }
        else if (!parser.parse({(id.value << kRecordsPerChunkLog2) + place}, page.records[place]))
        {
            return reader.failed() ? SpmRefusal::too_short : SpmRefusal::value_out_of_range;
        }
    }
    return reader.at_end() ? Result<Done, SpmRefusal>(Done{}) : SpmRefusal::trailing_bytes;
}

} // namespace tactus
