// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/model_pieces.hpp"

#include "host_tools/encode/left_full_order.hpp"
#include "host_tools/encode/piece_coding.hpp"
#include "rt_core/spm/chunk_coding.hpp"

namespace tactus
{

ModelPieces::ModelPieces(const PreparedMesh& prepared, const Simplification& simplification)
    : prepared_(prepared)
    , simplification_(simplification)
    , numbering_(number_model(prepared.mesh, simplification))
    , history_(trace_faces(prepared.mesh, simplification, numbering_))
    , influence_(find_influence(prepared.mesh, simplification, numbering_, history_))
    , buckets_(left_full_buckets(prepared.mesh))
{
}

VsplitRecord ModelPieces::record(RecordId id) const
{
    const Collapse& collapse = simplification_.collapses[numbering_.collapse_of_record[id.value]];
    const StarHistory& star = history_.stars[id.value];
    VsplitRecord record;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        record.position_m[axis] =
            static_cast<float>(prepared_.mesh.positions[collapse.vertex][axis]) *
            static_cast<float>(prepared_.quantum_m);
    }
    record.parent = numbering_.vertex_ids[collapse.parent];
    record.before = star.before;
    record.error = star.error_after;
    record.depth = static_cast<std::uint16_t>(star.depth);
    record.fan_size = static_cast<std::uint8_t>(collapse.fan_size);
    record.reach = influence_.reach[id.value];
    for (std::uint32_t place = 0; place < record.star_end(); ++place)
    {
        const std::uint32_t face = collapse.star[place];
        if (face == Collapse::kNoFace)
        {
            continue;
        }
        record.star[place] = numbering_.face_ids[face];
        record.next[place] = record.error[place] == 0 ? kNextExact : kNextPending;
        if (place < 2)
        {
            record.bucket[place] = buckets_[face];
        }
    }
    return record;
}

std::vector<std::byte> ModelPieces::coded_chunk(ChunkId id) const
{
    std::array<VsplitRecord, kRecordsPerChunk> records;
    const std::uint32_t count = records_in_chunk(counts(), id);
    for (std::uint32_t place = 0; place < count; ++place)
    {
        records[place] = record({(id.value << kRecordsPerChunkLog2) + place});
    }
    return encode_chunk(id, std::span(records).first(count),
                        static_cast<float>(prepared_.quantum_m));
}

std::vector<std::byte> ModelPieces::coded_base() const
{
    std::vector<GridPosition> positions;
    positions.reserve(counts().base_vertices);
    for (const std::uint32_t vertex : numbering_.base_vertices)
    {
        positions.push_back(prepared_.mesh.positions[vertex]);
    }
    std::vector<BaseFace> faces;
    faces.reserve(counts().base_faces);
    for (std::uint32_t id = 0; id < counts().base_faces; ++id)
    {
        faces.push_back(base_face({id}));
    }
    return encode_base_mesh(positions, faces);
}

BaseFace ModelPieces::base_face(FaceId id) const
{
    const std::uint32_t at = numbering_.base_faces[id.value];
    BaseFace face;
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
        face.corners[corner] = numbering_.vertex_ids[simplification_.base_corners[at][corner]];
    }
    face.bucket = buckets_[simplification_.base_faces[at]];
    face.error = history_.base_error[id.value];
    return face;
}

} // namespace tactus
