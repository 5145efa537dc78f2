// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/transport/tiny_model.hpp"

#include "host_tools/encode/piece_coding.hpp"
#include "host_tools/encode/record_coder.hpp"
#include "rt_core/spm/index_page.hpp"
#include "tests/unit/rt_core/coded_bytes.hpp"

#include <sodium.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

namespace tactus::test
{
namespace
{

constexpr std::int32_t kQuantumLog2 = -20;
constexpr std::uint32_t kExtent = 1'000;
constexpr std::uint8_t kSomeError = 20;

std::array<std::uint8_t, 32> blake2b(std::span<const std::byte> bytes)
{
    std::array<std::uint8_t, 32> hash{};
    crypto_generichash(hash.data(), hash.size(),
                       reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), nullptr,
                       0);
    return hash;
}

ContentHash short_hash(std::span<const std::byte> bytes)
{
    ContentHash hash{};
    std::copy_n(blake2b(bytes).begin(), hash.size(), hash.begin());
    return hash;
}

/// Synthetic mesh that grows split by split, as a simplification run backwards.
struct GrowingMesh
{
    GrowingMesh(TinyModel& model, std::mt19937& random) : model_(model), random_(random)
    {
        for (std::uint32_t vertex = 0; vertex < model.counts.base_vertices; ++vertex)
        {
            model.base_positions_m.push_back(somewhere());
        }
        for (std::uint32_t face = 0; face < model.counts.base_faces; ++face)
        {
            const std::array<VertexId, 3> corners{VertexId{0}, VertexId{face + 1},
                                                  VertexId{face + 2}};
            model.base_faces.push_back({corners, bucket_of({face}), 0});
            put({face}, {corners, FaceState::base(), 0});
        }
    }

    /// Splits a random vertex into a run of its faces.
    void split(RecordId id)
    {
        VsplitRecord& record = model_.records[id.value];
        StarRing& ring = model_.rings[id.value];
        choose_fan(record, ring);
        record.position_m = somewhere();
        const VertexId v = model_.counts.vertex_of(id);
        std::uint32_t depth = 0;
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            const Live& live = faces_.at(record.star[2 + i].value);
            record.before[i] = live.state;
            (live.state.is_base()
                 ? model_.base_next[record.star[2 + i].value]
                 : model_.records[live.state.record().value].next[live.state.place()]) = id.value;
            depth = std::max(depth, live.depth);
        }
        record.depth = static_cast<std::uint16_t>(depth + 1);
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            Live live = take(record.star[2 + i]);
            std::ranges::replace(live.corners, record.parent, v);
            put(record.star[2 + i], {live.corners, FaceState::after(id, 2 + i), depth + 1});
            record.next[2 + i] = kNextExact;
        }
        add_sides(id, v, depth + 1);
    }

private:
    struct Live
    {
        std::array<VertexId, 3> corners{};
        FaceState state;
        std::uint32_t depth{0};
    };

    Vec3f somewhere()
    {
        Vec3f position_m;
        for (float& coordinate : position_m)
        {
            coordinate = std::ldexp(static_cast<float>(random_() % (kExtent + 1)), kQuantumLog2);
        }
        return position_m;
    }
    [[nodiscard]] std::uint32_t bucket_of(FaceId face) const
    {
        return face.value * 37 % ((model_.counts.face_ids() - 1) / 8 + 1);
    }

    void put(FaceId face, const Live& live)
    {
        faces_[face.value] = live;
        for (std::size_t i = 0; i < 3; ++i)
        {
            edges_[{live.corners[i].value, live.corners[(i + 1) % 3].value}] = face;
        }
    }
    Live take(FaceId face)
    {
        const Live live = faces_.at(face.value);
        for (std::size_t i = 0; i < 3; ++i)
        {
            edges_.erase({live.corners[i].value, live.corners[(i + 1) % 3].value});
        }
        return live;
    }

    /// Corner of the face that follows `from` -> `to`.
    [[nodiscard]] VertexId third(FaceId face, VertexId from, VertexId to) const
    {
        const auto& corners = faces_.at(face.value).corners;
        return *std::ranges::find_if(corners, [&](VertexId c) { return c != from && c != to; });
    }

    void choose_fan(VsplitRecord& record, StarRing& ring)
    {
        auto at = faces_.begin();
        std::advance(at, static_cast<std::ptrdiff_t>(random_() % faces_.size()));
        const std::size_t corner = random_() % 3;
        const VertexId u = at->second.corners[corner];
        record.parent = u;
        record.star[2] = {at->first};
        ring.w[0] = at->second.corners[(corner + 1) % 3];
        ring.w[1] = at->second.corners[(corner + 2) % 3];
        record.fan_size = 1;
        const auto most = static_cast<std::uint32_t>(1 + random_() % 4);
        while (record.fan_size < most)
        {
            const VertexId end = ring.w[record.fan_size];
            const auto next = edges_.find({u.value, end.value});
            // One face of a closed ring stays, so that u keeps one of its own.
            if (next == edges_.end() || third(next->second, u, end) == ring.w[0])
            {
                return;
            }
            record.star[2U + record.fan_size] = next->second;
            ring.w[record.fan_size + 1U] = third(next->second, u, end);
            ++record.fan_size;
        }
    }

    /// A or B may be missing only at a border, and not both.
    void add_sides(RecordId id, VertexId v, std::uint32_t depth)
    {
        VsplitRecord& record = model_.records[id.value];
        const StarRing& ring = model_.rings[id.value];
        const VertexId u = record.parent;
        const VertexId first = ring.w[0];
        const VertexId last = ring.w[record.fan_size];
        const bool may_miss_a = !edges_.contains({first.value, u.value});
        const bool may_miss_b = !edges_.contains({u.value, last.value});
        const bool misses_a = may_miss_a && random_() % 3 == 0;
        const bool misses_b = may_miss_b && !misses_a && random_() % 3 == 0;
        const std::array<std::array<VertexId, 3>, 2> corners{std::array{v, u, first},
                                                             std::array{v, last, u}};
        for (std::uint32_t side = 0; side < 2; ++side)
        {
            if (!(side == 0 ? misses_a : misses_b))
            {
                record.star[side] = model_.counts.face_of(id, side);
                record.bucket[side] = bucket_of(record.star[side]);
                record.next[side] = kNextExact;
                put(record.star[side], {corners[side], FaceState::after(id, side), depth});
            }
        }
    }

    TinyModel& model_;
    std::mt19937& random_;
    std::map<std::uint32_t, Live> faces_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, FaceId> edges_;
};

void grow_records(TinyModel& model, const TinyModelSpec& spec)
{
    std::mt19937 random(spec.seed);
    std::vector<std::uint32_t> ids(spec.records);
    std::iota(ids.begin(), ids.end(), 0U);
    // A record depends on none of a later tier.
    for (std::size_t first = 0, end = 64; spec.shuffled_ids && first < ids.size();
         first = end, end *= 5)
    {
        std::shuffle(ids.begin() + static_cast<std::ptrdiff_t>(first),
                     ids.begin() + static_cast<std::ptrdiff_t>(std::min(end, ids.size())), random);
    }
    model.base_next.assign(spec.base_faces, kNextExact);
    model.records.assign(spec.records, VsplitRecord{});
    model.rings.assign(spec.records, StarRing{});
    GrowingMesh mesh(model, random);
    for (const std::uint32_t id : ids)
    {
        mesh.split({id});
    }
    for (VsplitRecord& record : model.records)
    {
        for (std::uint32_t place = 0; place < record.star_end(); ++place)
        {
            record.error[place] =
                record.star[place].is_none() || record.next[place] == kNextExact ? 0 : kSomeError;
        }
    }
    for (std::uint32_t face = 0; face < spec.base_faces; ++face)
    {
        model.base_faces[face].error = model.base_next[face] == kNextExact ? 0 : kSomeError;
    }
}

HeaderFields fields_of(const TinyModel& model)
{
    HeaderFields fields;
    fields.base_vertices = model.counts.base_vertices;
    fields.base_faces = model.counts.base_faces;
    fields.records = model.counts.records;
    fields.quantum_log2 = kQuantumLog2;
    fields.position_bits = 16;
    fields.extent_quanta = {kExtent, kExtent, kExtent};
    for (const VsplitRecord& record : model.records)
    {
        fields.max_depth = std::max<std::uint32_t>(fields.max_depth, record.depth);
    }
    fields.source_vertices = model.counts.vertices();
    fields.source_faces = model.counts.face_ids();
    fields.region_cell_quanta = 1'024;
    fields.region_grid = {1, 1, 1};
    fields.occupied_regions = 1;
    fields.header_bytes = static_cast<std::uint32_t>(header_bytes(model.index_pages.size(), 1));
    fields.base_bytes = static_cast<std::uint32_t>(model.base.size());
    fields.base_offset = fields.header_bytes;
    fields.index_offset = fields.base_offset + model.base.size();
    fields.base_hash = short_hash(model.base);
    return fields;
}

GridPosition on_grid(const Vec3f& position_m)
{
    GridPosition position{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        position[axis] = static_cast<std::int32_t>(std::ldexp(position_m[axis], -kQuantumLog2));
    }
    return position;
}

GridPosition vertex_on_grid(const TinyModel& model, VertexId vertex)
{
    return on_grid(model.counts.is_base(vertex)
                       ? model.base_positions_m[vertex.value]
                       : model.records[model.counts.record_of(vertex).value].position_m);
}

/// Coded form of the records in their chunks, with the resulting radius.
void code_records(TinyModel& model)
{
    for (std::uint32_t id = 0; id < model.records.size(); ++id)
    {
        VsplitRecord& record = model.records[id];
        std::vector<GridPosition> ring{vertex_on_grid(model, record.parent)};
        for (std::uint32_t i = 0; i <= record.fan_size; ++i)
        {
            ring.push_back(vertex_on_grid(model, model.rings[id].w[i]));
        }
        record.reach = star_reach(on_grid(record.position_m), ring, kSomeError);
    }
    // The coder has `next` as parse leaves it.
    std::vector<VsplitRecord> records = model.records;
    for (VsplitRecord& record : records)
    {
        for (std::uint32_t place = 0; place < record.star_end(); ++place)
        {
            if (!record.star[place].is_none())
            {
                record.next[place] = record.error[place] == 0 ? kNextExact : kNextPending;
            }
        }
    }
    const AllStars stars{records, model.rings};
    const BaseView base{model.base_positions_m, model.base_faces};
    const HeaderFields fields = fields_of(model);
    RecordCoder coder(stars, model.counts, base, fields, std::ldexp(1.0F, kQuantumLog2));
    for (std::uint32_t id = 0; id < model.records.size(); ++id)
    {
        model.coded.push_back(coder.code({id}));
    }
}

std::vector<std::byte> write_base(const TinyModel& model)
{
    CodedBytes bytes;
    for (const Vec3f& position_m : model.base_positions_m)
    {
        for (const std::int32_t quanta : on_grid(position_m))
        {
            bytes.bits(10, static_cast<std::uint32_t>(quanta)); // kExtent has ten.
        }
    }
    const auto width = [](std::uint32_t largest)
    { return static_cast<std::uint32_t>(std::ceil(std::log2(largest + 1.0))); };
    for (const BaseFace& face : model.base_faces)
    {
        for (const VertexId corner : face.corners)
        {
            bytes.bits(width(model.counts.base_vertices - 1), corner.value);
        }
        bytes.bits(width((model.counts.face_ids() - 1) / 8), face.bucket);
        bytes.bits(8, face.error);
    }
    return bytes.with_checksum();
}

std::vector<std::byte> write_index_page(const TinyModel& model, std::uint32_t page, bool in_a_row)
{
    CodedBytes bytes;
    bytes.put(page);
    for (std::size_t chunk = std::size_t{page} * 64;
         chunk < std::min<std::size_t>(model.chunks.size(), std::size_t{page} * 64 + 64); ++chunk)
    {
        const std::size_t chunks = model.chunks.size();
        const auto low =
            static_cast<std::uint16_t>(in_a_row ? (chunk * kExtent + 100) / chunks : 0);
        const auto high =
            static_cast<std::uint16_t>(in_a_row ? (chunk * kExtent + 900) / chunks : kExtent);
        bytes.put(std::array<std::uint16_t, 6>{low, 0, 0, high, kExtent, kExtent});
        bytes.put(static_cast<std::uint16_t>(model.chunks[chunk].size()));
        bytes.put(short_hash(model.chunks[chunk]));
    }
    return bytes.with_checksum();
}

void write_header_and_file(TinyModel& model)
{
    HeaderFields fields = fields_of(model);
    std::uint64_t offset = fields.index_offset;
    for (const auto& page : model.index_pages)
    {
        offset += page.size();
    }
    CodedBytes entries;
    for (std::size_t page = 0; page < model.index_pages.size(); ++page)
    {
        entries.put(IndexPageEntry{
            {{0, 0, 0}, {kExtent, kExtent, kExtent}}, offset, short_hash(model.index_pages[page])});
        for (std::size_t i = 64 * page; i < std::min(model.chunks.size(), 64 * page + 64); ++i)
        {
            offset += model.chunks[i].size();
        }
    }
    fields.file_bytes = offset;
    CodedBytes header;
    header.put(fields).append(entries.bytes()).put(std::uint8_t{1});
    header.put(blake2b(header.bytes()));
    model.header = header.with_checksum();
    CodedBytes file;
    file.append(model.header).append(model.base);
    for (const auto& page : model.index_pages)
    {
        file.append(page);
    }
    for (const auto& chunk : model.chunks)
    {
        file.append(chunk);
    }
    model.file = file.bytes();
}

} // namespace

std::span<const std::byte> TinyModel::piece(ContentKey key) const
{
    return key.kind == ContentKind::base         ? base
           : key.kind == ContentKind::index_page ? index_pages.at(key.number)
                                                 : chunks.at(key.number);
}

std::vector<std::byte> TinyModel::chunk_of(ChunkId id, std::span<const CodedRecord> all) const
{
    const std::size_t first = std::size_t{id.value} * 64;
    return encode_chunk(id, counts,
                        all.subspan(first, std::min<std::size_t>(64, all.size() - first)));
}

TinyModel make_tiny_model(const TinyModelSpec& spec)
{
    TinyModel model;
    model.counts = {spec.base_faces + 2, spec.base_faces, spec.records};
    grow_records(model, spec);
    code_records(model);
    for (std::uint32_t chunk = 0; chunk < model.counts.chunks(); ++chunk)
    {
        model.chunks.push_back(model.chunk_of({chunk}, model.coded));
    }
    for (std::uint32_t page = 0; page < model.counts.index_pages(); ++page)
    {
        model.index_pages.push_back(write_index_page(model, page, spec.boxes_in_a_row));
    }
    model.base = write_base(model);
    write_header_and_file(model);
    return model;
}

} // namespace tactus::test
