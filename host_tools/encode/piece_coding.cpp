// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/piece_coding.hpp"

#include "rt_core/base/assert.hpp"
#include "transport/content_hash.hpp"

namespace tactus
{

namespace
{

/// Writes the records of one chunk, each position relative to the one before.
class RecordWriter
{
public:
    RecordWriter(ByteWriter& writer, float quantum_m) : writer_(writer), quantum_m_(quantum_m) {}

    void write(const VsplitRecord& record)
    {
        writer_.write_varint(record.depth);
        writer_.write(static_cast<std::uint8_t>(record.fan_size | (record.has_face(0) ? 8U : 0U) |
                                                (record.has_face(1) ? 16U : 0U)));
        write_position(record);
        writer_.write_varint(record.parent.value);
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            const FaceState before = record.before[i];
            writer_.write_varint(record.star[2 + i].value);
            writer_.write_varint(before.is_base() ? 0 : before.value + 1);
        }
        for (std::uint32_t place = 0; place < record.star_end(); ++place)
        {
            if (place >= 2 || record.has_face(place))
            {
                writer_.write(record.error[place]);
            }
        }
        for (std::uint32_t side = 0; side < 2; ++side)
        {
            if (record.has_face(side))
            {
                writer_.write_varint(record.bucket[side]);
            }
        }
        writer_.write(record.reach);
    }

private:
    void write_position(const VsplitRecord& record)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            // Exact: the quantum is a power of two and the multiple has at most 24 bits.
            const auto quanta = static_cast<std::int32_t>(record.position_m[axis] / quantum_m_);
            writer_.write_signed_varint(quanta - position_[axis]);
            position_[axis] = quanta;
        }
    }

    ByteWriter& writer_;
    float quantum_m_;
    GridPosition position_{};
};

} // namespace

std::vector<std::byte> encode_base_mesh(std::span<const GridPosition> positions,
                                        std::span<const BaseFace> faces)
{
    ByteWriter writer;
    for (const GridPosition& position : positions)
    {
        writer.write(position);
    }
    for (const BaseFace& face : faces)
    {
        for (const VertexId corner : face.corners)
        {
            writer.write(corner.value);
        }
        writer.write(face.bucket);
        writer.write(face.error);
    }
    writer.write_checksum();
    return writer.take();
}

std::vector<std::byte> encode_chunk(ChunkId id, std::span<const VsplitRecord> records,
                                    float quantum_m)
{
    TACTUS_ASSERT(!records.empty() && records.size() <= kRecordsPerChunk);
    ByteWriter writer;
    writer.write(id.value);
    writer.write(static_cast<std::uint8_t>(records.size()));
    RecordWriter record_writer(writer, quantum_m);
    for (const VsplitRecord& record : records)
    {
        record_writer.write(record);
    }
    writer.write_checksum();
    TACTUS_ASSERT(writer.bytes().size() <= kMaxCodedChunkBytes);
    return writer.take();
}

std::vector<std::byte> encode_index_page(IndexPageId id, std::span<const InfluenceBox> boxes,
                                         std::span<const ChunkEntry> entries)
{
    TACTUS_ASSERT(!boxes.empty() && boxes.size() <= kChunksPerIndexPage);
    TACTUS_ASSERT(boxes.size() == entries.size());
    ByteWriter writer;
    writer.write(id.value);
    for (std::size_t i = 0; i < boxes.size(); ++i)
    {
        writer.write(boxes[i]);
        writer.write(entries[i].coded_bytes);
        writer.write(entries[i].hash);
    }
    writer.write_checksum();
    return writer.take();
}

std::vector<std::byte> encode_header(const HeaderFields& fields,
                                     std::span<const IndexPageEntry> index,
                                     std::span<const std::byte> region_bits)
{
    ByteWriter writer;
    writer.write(fields);
    writer.write_bytes(std::as_bytes(index));
    writer.write_bytes(region_bits);
    writer.write(root_hash(writer.bytes()));
    writer.write_checksum();
    TACTUS_ASSERT(writer.bytes().size() == fields.header_bytes);
    return writer.take();
}

} // namespace tactus
