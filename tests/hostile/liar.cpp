// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// liar MODEL OUT LIE: writes a model with false content and valid checksums and hashes. Exits 3
/// for an unknown LIE.

#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/header.hpp"
#include "tests/fuzz/seal_model.hpp"

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace
{

using namespace tactus;

using File = std::vector<char>;
using Lie = std::function<void(HeaderFields&, File&)>;

constexpr std::size_t kBoxesAt = sizeof(HeaderFields);

std::size_t regions_at(const HeaderFields& fields)
{
    const ModelCounts counts{fields.base_vertices, fields.base_faces, fields.records};
    return sizeof(HeaderFields) + counts.index_pages() * sizeof(IndexPageEntry);
}

void put_bits(File& file, std::uint64_t at_bit, std::uint32_t bits, std::uint32_t value)
{
    for (std::uint32_t i = 0; i < bits; ++i, ++at_bit)
    {
        const auto mask = static_cast<unsigned>(1U << (at_bit % 8));
        const auto byte = static_cast<unsigned>(static_cast<unsigned char>(file[at_bit / 8]));
        file[at_bit / 8] = static_cast<char>((value >> i & 1U) != 0 ? byte | mask : byte & ~mask);
    }
}

/// Sets a field of each base face, `from_end` bits before the face's end.
void put_in_base_faces(const HeaderFields& fields, File& file, std::uint32_t from_end,
                       std::uint32_t bits, std::uint32_t value)
{
    const BaseLayout layout(fields);
    const std::uint64_t vertex = layout.axis_bits[0] + layout.axis_bits[1] + layout.axis_bits[2];
    const std::uint64_t face = 3ULL * layout.vertex_bits + layout.bucket_bits + 8;
    for (std::uint64_t i = 1; i <= fields.base_faces; ++i)
    {
        put_bits(file, 8 * fields.base_offset + fields.base_vertices * vertex + i * face - from_end,
                 bits, value);
    }
}

/// Sets both corners of each chunk's box, in steps of its page's box.
void put_in_chunk_boxes(const HeaderFields& fields, File& file, int low_byte, int high_byte)
{
    const ModelCounts counts{fields.base_vertices, fields.base_faces, fields.records};
    for (std::uint32_t chunk = 0; chunk < counts.chunks(); ++chunk)
    {
        char* const box =
            file.data() + fields.index_offset + 1'928 * (chunk / 64) + 4 + 30 * (chunk % 64);
        std::memset(box, low_byte, 6);
        std::memset(box + 6, high_byte, 6);
    }
}

/// Shrinks all chunks' boxes to the low corner of their page's.
void shrink_boxes(HeaderFields& fields, File& file)
{
    put_in_chunk_boxes(fields, file, 0, 0);
}

/// Enlarges all chunks' boxes to the greatest size of the format.
void spread_chunk_boxes(HeaderFields& fields, File& file)
{
    put_in_chunk_boxes(fields, file, 0, 0xFF);
}

void put_i32(char* at, std::int32_t value)
{
    std::memcpy(at, &value, sizeof(value));
}

/// Makes all boxes the greatest possible: every chunk is needed everywhere.
void spread_boxes(HeaderFields& fields, File& file)
{
    spread_chunk_boxes(fields, file);
    const ModelCounts counts{fields.base_vertices, fields.base_faces, fields.records};
    for (std::uint32_t page = 0; page < counts.index_pages(); ++page)
    {
        char* const box = file.data() + kBoxesAt + page * sizeof(IndexPageEntry);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            put_i32(box + 4 * axis, std::numeric_limits<std::int32_t>::min());
            put_i32(box + 12 + 4 * axis, std::numeric_limits<std::int32_t>::max());
        }
    }
}

const std::map<std::string, Lie>& lies()
{
    static const std::map<std::string, Lie> all{
        {"faces", [](HeaderFields& f, File&) { ++f.source_faces; }},
        {"vertices", [](HeaderFields& f, File&) { --f.source_vertices; }},
        {"depth", [](HeaderFields& f, File&) { ++f.max_depth; }},
        {"open", [](HeaderFields& f, File&) { f.topology = kOpenTopology; }},
        {"extent", [](HeaderFields& f, File&) { ++f.extent_quanta[1]; }},
        {"no_error", [](HeaderFields& f, File&) { f.max_error_quanta = 0; }},
        {"most_error", [](HeaderFields& f, File&) { f.max_error_quanta = UINT32_MAX; }},
        {"regions",
         [](HeaderFields& f, File& file)
         {
             f.occupied_regions = 1;
             const std::size_t bytes =
                 f.header_bytes - regions_at(f) - kRootHashBytes - kChecksumBytes;
             std::memset(file.data() + regions_at(f), 0, bytes);
             file[regions_at(f)] = 1;
         }},
        {"boxes", shrink_boxes},
        {"chunk_boxes_all", spread_chunk_boxes},
        {"box_all", spread_boxes},
        {"page_boxes", [](HeaderFields&, File& file)
         { std::memcpy(file.data() + kBoxesAt + 12, file.data() + kBoxesAt, 12); }},
        {"base_errors", [](HeaderFields& f, File& file) { put_in_base_faces(f, file, 8, 8, 1); }},
        {"buckets",
         [](HeaderFields& f, File& file) {
             put_in_base_faces(f, file, 8 + BaseLayout(f).bucket_bits, BaseLayout(f).bucket_bits,
                               0);
         }},
        {"origin", [](HeaderFields& f, File&) { f.origin_m[0] = 1e300; }},
        {"far", [](HeaderFields& f, File&) { f.origin_m[2] = -1e9; }},
        {"quantum", [](HeaderFields& f, File&) { f.quantum_log2 = kMaxQuantumLog2; }},
        {"quantisation", [](HeaderFields& f, File&) { f.quantisation_m = 1e300; }},
    };
    return all;
}

} // namespace

int main(int argc, char** argv)
{
    const auto lie = argc == 4 ? lies().find(argv[3]) : lies().end();
    if (lie == lies().end())
    {
        std::fprintf(stderr, "liar MODEL OUT LIE; lies:");
        for (const auto& [name, unused] : lies())
        {
            std::fprintf(stderr, " %s", name.c_str());
        }
        std::fprintf(stderr, "\n");
        return 3;
    }
    std::ifstream in(argv[1], std::ios::binary);
    File file{std::istreambuf_iterator<char>(in), {}};
    HeaderFields fields;
    std::memcpy(&fields, file.data(), sizeof(fields));
    lie->second(fields, file);
    std::memcpy(file.data(), &fields, sizeof(fields));
    fuzz::seal_model(std::as_writable_bytes(std::span(file)));
    std::ofstream(argv[2], std::ios::binary).write(file.data(), std::ssize(file));
    return 0;
}
