// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/piece_coding.hpp"

#include "host_tools/encode/range_encoder.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "rt_core/spm/chunk_grammar.hpp"
#include "transport/content_hash.hpp"

namespace tactus
{

std::vector<std::byte> encode_base_mesh(std::span<const GridPosition> positions,
                                        std::span<const BaseFace> faces, const BaseLayout& layout)
{
    ByteWriter writer;
    for (const GridPosition& position : positions)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            writer.write_bits(layout.axis_bits[axis], static_cast<std::uint32_t>(position[axis]));
        }
    }
    for (const BaseFace& face : faces)
    {
        for (const VertexId corner : face.corners)
        {
            writer.write_bits(layout.vertex_bits, corner.value);
        }
        writer.write_bits(layout.bucket_bits, face.bucket);
        writer.write_bits(8, face.error);
    }
    writer.end_bits();
    writer.write_checksum();
    return writer.take();
}

std::vector<std::byte> encode_chunk(ChunkId id, const ModelCounts& counts,
                                    std::span<const CodedRecord> records)
{
    TACTUS_ASSERT(!records.empty() && records.size() == records_in_chunk(counts, id));
    RangeEncoder encoder;
    ChunkGrammar grammar(encoder, counts, id);
    for (std::uint32_t place = 0; place < records.size(); ++place)
    {
        CodedRecord record = records[place];
        grammar.code({(id.value << kRecordsPerChunkLog2) + place}, record);
        TACTUS_ASSERT(record == records[place]);
    }
    ByteWriter writer;
    const std::vector<std::byte> code = encoder.finish();
    writer.write_bytes(code);
    writer.write(chunk_checksum(code, id));
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
