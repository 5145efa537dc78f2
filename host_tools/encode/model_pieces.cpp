// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/model_pieces.hpp"

#include "host_tools/encode/piece_coding.hpp"
#include "host_tools/encode/record_coder.hpp"
#include "host_tools/simplify/parallel_blocks.hpp"
#include "rt_core/spm/chunk_coding.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

namespace tactus
{

namespace
{

/// A face and three times its centroid, which has integer coordinates.
struct Centroid
{
    std::array<std::int32_t, 3> sum{};
    std::uint32_t face{0};
};

std::vector<Centroid> centroids_of(const QuantisedMesh& mesh)
{
    std::vector<Centroid> centroids(mesh.faces.size());
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face)
    {
        centroids[face].face = face;
        for (const std::uint32_t corner : mesh.faces[face])
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                centroids[face].sum[axis] += mesh.positions[corner][axis];
            }
        }
    }
    return centroids;
}

std::size_t longest_axis(std::span<const Centroid> cell)
{
    std::array<std::int32_t, 3> low = cell.front().sum;
    std::array<std::int32_t, 3> high = low;
    for (const Centroid& centroid : cell)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(low[axis], centroid.sum[axis]);
            high[axis] = std::max(high[axis], centroid.sum[axis]);
        }
    }
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis)
    {
        if (high[axis] - low[axis] > high[longest] - low[longest])
        {
            longest = axis;
        }
    }
    return longest;
}

/// Orders a cell. Cells of at most eight faces stay unordered: each is one bucket, since its first
/// rank is a multiple of eight. Every left part of a larger cell has a power of two of faces, at
/// least eight.
void order_cell(std::span<Centroid> cell)
{
    while (cell.size() > 8)
    {
        const std::size_t axis = longest_axis(cell);
        const std::size_t left = std::bit_floor(cell.size() - 1);
        std::nth_element(cell.begin(), cell.begin() + static_cast<std::ptrdiff_t>(left), cell.end(),
                         [axis](const Centroid& a, const Centroid& b) {
                             return a.sum[axis] != b.sum[axis] ? a.sum[axis] < b.sum[axis]
                                                               : a.face < b.face;
                         });
        // The right part is never larger than the left one: at most 32 levels.
        order_cell(cell.subspan(left));
        cell = cell.first(left);
    }
}

} // namespace

std::vector<std::uint32_t> left_full_buckets(const QuantisedMesh& mesh)
{
    std::vector<Centroid> centroids = centroids_of(mesh);
    order_cell(centroids);
    std::vector<std::uint32_t> buckets(centroids.size());
    for (std::size_t rank = 0; rank < centroids.size(); ++rank)
    {
        buckets[centroids[rank].face] = static_cast<std::uint32_t>(rank >> 3U);
    }
    return buckets;
}

namespace
{

constexpr std::size_t kRecordBlock = 1024;

Vec3f to_metres(const GridPosition& position, double quantum_m)
{
    Vec3f metres;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        metres[axis] = static_cast<float>(position[axis]) * static_cast<float>(quantum_m);
    }
    return metres;
}

ErrorCode largest_error(const StarHistory& star)
{
    return std::max(*std::ranges::max_element(star.error_before),
                    *std::ranges::max_element(star.error_after));
}

} // namespace

ModelPieces::ModelPieces(const PreparedMesh& prepared, const Simplification& simplification,
                         unsigned threads)
    : prepared_(prepared)
    , simplification_(simplification)
    , numbering_(number_model(prepared.mesh, simplification))
    , history_(trace_faces(prepared.mesh, simplification, numbering_))
    , influence_(find_influence(prepared.mesh, simplification, numbering_, history_))
    , buckets_(left_full_buckets(prepared.mesh))
{
    records_.resize(counts().records);
    parallel_blocks(threads, records_.size(), kRecordBlock,
                    [&](unsigned, std::size_t begin, std::size_t end)
                    {
                        for (std::size_t id = begin; id < end; ++id)
                        {
                            records_[id] = make_record({static_cast<std::uint32_t>(id)});
                        }
                    });
    for (const std::uint32_t vertex : numbering_.base_vertices)
    {
        base_positions_m_.push_back(to_metres(prepared.mesh.positions[vertex], prepared.quantum_m));
    }
    for (std::uint32_t id = 0; id < counts().base_faces; ++id)
    {
        base_faces_.push_back(base_face({id}));
    }
}

VsplitRecord ModelPieces::make_record(RecordId id) const
{
    const Collapse& collapse = simplification_.collapses[numbering_.collapse_of_record[id.value]];
    const StarHistory& star = history_.stars[id.value];
    VsplitRecord record;
    const GridPosition& v = prepared_.mesh.positions[collapse.vertex];
    record.position_m = to_metres(v, prepared_.quantum_m);
    record.parent = numbering_.vertex_ids[collapse.parent];
    record.before = star.before;
    record.error = star.error_after;
    record.depth = static_cast<std::uint16_t>(star.depth);
    record.fan_size = static_cast<std::uint8_t>(collapse.fan_size);
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
    record.reach = star_reach(v, ring_positions(id, record), largest_error(star));
    return record;
}

std::vector<GridPosition> ModelPieces::ring_positions(RecordId id, const VsplitRecord& record) const
{
    std::vector<GridPosition> ring{position_of(record.parent)};
    for (std::uint32_t i = 0; i <= record.fan_size; ++i)
    {
        ring.push_back(position_of(influence_.rings[id.value].w[i]));
    }
    return ring;
}

GridPosition ModelPieces::position_of(VertexId vertex) const
{
    const std::uint32_t source =
        counts().is_base(vertex)
            ? numbering_.base_vertices[vertex.value]
            : simplification_
                  .collapses[numbering_.collapse_of_record[counts().record_of(vertex).value]]
                  .vertex;
    return prepared_.mesh.positions[source];
}

std::vector<CodedRecord> ModelPieces::chunk_records(ChunkId id) const
{
    const AllStars stars{records_, influence_.rings};
    const BaseView base{base_positions_m_, base_faces_};
    HeaderFields fields;
    fields.extent_quanta.fill((1U << kMaxPositionBits) - 1);
    fields.max_depth = max_depth();
    RecordCoder coder(stars, counts(), base, fields, static_cast<float>(prepared_.quantum_m));
    std::vector<CodedRecord> records;
    for (std::uint32_t place = 0; place < records_in_chunk(counts(), id); ++place)
    {
        records.push_back(coder.code({(id.value << kRecordsPerChunkLog2) + place}));
    }
    return records;
}

std::vector<std::byte> ModelPieces::coded_chunk(ChunkId id) const
{
    return encode_chunk(id, counts(), chunk_records(id));
}

std::vector<std::byte> ModelPieces::coded_base(const BaseLayout& layout) const
{
    std::vector<GridPosition> positions;
    positions.reserve(counts().base_vertices);
    for (const std::uint32_t vertex : numbering_.base_vertices)
    {
        positions.push_back(prepared_.mesh.positions[vertex]);
    }
    return encode_base_mesh(positions, base_faces_, layout);
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
