// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/transport/tiny_model.hpp"

#include "rt_core/base/crc32c.hpp"
#include "rt_core/spm/index_page.hpp"

#include <sodium.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>

namespace tactus::test
{

namespace
{

constexpr std::int32_t kQuantumLog2 = -20;
constexpr std::uint32_t kExtent = 1'000;
constexpr std::uint8_t kSomeError = 20;

class Bytes
{
public:
    template <typename T>
    Bytes& put(const T& value)
    {
        const auto* first = reinterpret_cast<const std::byte*>(&value);
        bytes_.insert(bytes_.end(), first, first + sizeof(T));
        return *this;
    }
    Bytes& varint(std::uint32_t value)
    {
        while (value >= 128)
        {
            put(static_cast<std::uint8_t>(value | 128U));
            value >>= 7U;
        }
        return put(static_cast<std::uint8_t>(value));
    }
    Bytes& zigzag(std::int32_t value)
    {
        return varint(value < 0 ? 2 * static_cast<std::uint32_t>(-(value + 1)) + 1
                                : 2 * static_cast<std::uint32_t>(value));
    }
    Bytes& append(std::span<const std::byte> other)
    {
        bytes_.insert(bytes_.end(), other.begin(), other.end());
        return *this;
    }
    std::vector<std::byte> with_checksum()
    {
        put(crc32c(bytes_));
        return std::move(bytes_);
    }
    [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }

private:
    std::vector<std::byte> bytes_;
};

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

struct LiveFace
{
    FaceId face;
    FaceState state;
    std::uint32_t depth{0};
};

/// Splits random faces of the cut, as a stand-in for a real simplification run backwards.
void grow_records(TinyModel& model, const TinyModelSpec& spec)
{
    std::mt19937 random(spec.seed);
    std::vector<std::uint32_t> ids(spec.records);
    std::iota(ids.begin(), ids.end(), 0U);
    if (spec.shuffled_ids)
    {
        std::shuffle(ids.begin(), ids.end(), random);
    }
    model.base_next.assign(spec.base_faces, kNextExact);
    model.records.assign(spec.records, VsplitRecord{});
    std::vector<LiveFace> cut;
    for (std::uint32_t face = 0; face < spec.base_faces; ++face)
    {
        cut.push_back({{face}, FaceState::base(), 0});
    }
    for (const std::uint32_t id : ids)
    {
        VsplitRecord& record = model.records[id];
        record.fan_size =
            static_cast<std::uint8_t>(1 + random() % std::min<std::size_t>(4, cut.size()));
        record.parent = {0};
        record.reach = 1;
        std::fill_n(record.next.begin() + 2, record.fan_size, kNextExact);
        for (float& coordinate : record.position_m)
        {
            coordinate = std::ldexp(static_cast<float>(random() % (kExtent + 1)), kQuantumLog2);
        }
        std::shuffle(cut.begin(), cut.end(), random);
        std::uint32_t depth = 0;
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            LiveFace& live = cut[i];
            record.star[2 + i] = live.face;
            record.before[i] = live.state;
            (live.state.is_base()
                 ? model.base_next[live.face.value]
                 : model.records[live.state.record().value].next[live.state.place()]) = id;
            depth = std::max(depth, live.depth);
        }
        record.depth = static_cast<std::uint16_t>(depth + 1);
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            cut[i].state = FaceState::after({id}, 2 + i);
            cut[i].depth = depth + 1;
        }
        // Bit 0: A, bit 1: B.
        const auto sides = static_cast<std::uint32_t>(1 + random() % 3);
        for (std::uint32_t side = 0; side < 2; ++side)
        {
            if (((sides >> side) & 1U) != 0)
            {
                record.star[side] = model.counts.face_of({id}, side);
                record.next[side] = kNextExact;
                cut.push_back({record.star[side], FaceState::after({id}, side), depth + 1});
            }
        }
    }
    for (VsplitRecord& record : model.records)
    {
        for (std::uint32_t place = 0; place < record.star_end(); ++place)
        {
            record.error[place] = record.next[place] == kNextExact ? 0 : kSomeError;
        }
    }
}

std::vector<std::byte> write_base(const TinyModel& model)
{
    Bytes bytes;
    for (std::uint32_t vertex = 0; vertex < model.counts.base_vertices; ++vertex)
    {
        bytes.put(vertex % kExtent).put((7 * vertex) % kExtent).put((13 * vertex) % kExtent);
    }
    for (std::uint32_t face = 0; face < model.counts.base_faces; ++face)
    {
        bytes.put(face).put(face + 1).put(face + 2).put(std::uint32_t{0});
        bytes.put(model.base_next[face] == kNextExact ? std::uint8_t{0} : kSomeError);
    }
    return bytes.with_checksum();
}

std::vector<std::byte> write_index_page(const TinyModel& model, std::uint32_t page)
{
    Bytes bytes;
    bytes.put(page);
    for (std::size_t chunk = std::size_t{page} * 64;
         chunk < std::min<std::size_t>(model.chunks.size(), std::size_t{page} * 64 + 64); ++chunk)
    {
        bytes.put(std::array<std::uint16_t, 6>{0, 0, 0, 1'000, 1'000, 1'000});
        bytes.put(static_cast<std::uint16_t>(model.chunks[chunk].size()));
        bytes.put(short_hash(model.chunks[chunk]));
    }
    return bytes.with_checksum();
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

void write_header_and_file(TinyModel& model)
{
    HeaderFields fields = fields_of(model);
    std::uint64_t offset = fields.index_offset;
    for (const auto& page : model.index_pages)
    {
        offset += page.size();
    }
    Bytes entries;
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
    Bytes header;
    header.put(fields).append(entries.bytes()).put(std::uint8_t{1});
    header.put(blake2b(header.bytes()));
    model.header = header.with_checksum();
    Bytes file;
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

std::vector<std::byte> write_chunk(ChunkId id, std::span<const VsplitRecord> records)
{
    Bytes bytes;
    bytes.put(id.value).put(static_cast<std::uint8_t>(records.size()));
    std::array<std::int32_t, 3> last{};
    for (const VsplitRecord& record : records)
    {
        bytes.varint(record.depth);
        bytes.put(static_cast<std::uint8_t>(record.fan_size | (record.has_face(0) ? 8 : 0) |
                                            (record.has_face(1) ? 16 : 0)));
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const auto quanta =
                static_cast<std::int32_t>(std::ldexp(record.position_m[axis], -kQuantumLog2));
            bytes.zigzag(quanta - last[axis]);
            last[axis] = quanta;
        }
        bytes.varint(record.parent.value);
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            bytes.varint(record.star[2 + i].value);
            bytes.varint(record.before[i].is_base() ? 0 : 1 + record.before[i].value);
        }
        for (std::uint32_t place = 0; place < record.star_end(); ++place)
        {
            if (place >= 2 || record.has_face(place))
            {
                bytes.put(record.error[place]);
            }
        }
        for (std::uint32_t side = 0; side < 2; ++side)
        {
            if (record.has_face(side))
            {
                bytes.varint(record.bucket[side]);
            }
        }
        bytes.put(record.reach);
    }
    return bytes.with_checksum();
}

std::span<const std::byte> TinyModel::piece(ContentKey key) const
{
    return key.kind == ContentKind::base         ? base
           : key.kind == ContentKind::index_page ? index_pages.at(key.number)
                                                 : chunks.at(key.number);
}

TinyModel make_tiny_model(const TinyModelSpec& spec)
{
    TinyModel model;
    model.counts = {spec.base_faces + 2, spec.base_faces, spec.records};
    grow_records(model, spec);
    for (std::uint32_t chunk = 0; chunk < model.counts.chunks(); ++chunk)
    {
        const std::size_t first = std::size_t{chunk} * 64;
        model.chunks.push_back(write_chunk(
            {chunk}, std::span(model.records)
                         .subspan(first, std::min<std::size_t>(64, spec.records - first))));
    }
    for (std::uint32_t page = 0; page < model.counts.index_pages(); ++page)
    {
        model.index_pages.push_back(write_index_page(model, page));
    }
    model.base = write_base(model);
    write_header_and_file(model);
    return model;
}

TemporaryFolder::TemporaryFolder()
{
    std::string name = (std::filesystem::temp_directory_path() / "tactus_test_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
    {
        throw std::runtime_error("no temporary folder: " + name);
    }
    path_ = name;
}

TemporaryFolder::~TemporaryFolder()
{
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TemporaryFolder::write(const char* name,
                                             std::span<const std::byte> bytes) const
{
    const auto path = path_ / name;
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return path;
}

} // namespace tactus::test
