// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/numbering.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/spm/tiers.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace tactus
{

namespace
{

/// Moves bit i of a 21-bit number to bit 3i.
std::uint64_t spread_bits(std::uint64_t value)
{
    value = (value | value << 32U) & 0x001F'0000'0000'FFFFU;
    value = (value | value << 16U) & 0x001F'0000'FF00'00FFU;
    value = (value | value << 8U) & 0x100F'00F0'0F00'F00FU;
    value = (value | value << 4U) & 0x10C3'0C30'C30C'30C3U;
    return (value | value << 2U) & 0x1249'2492'4924'9249U;
}

/// Number of low bits to drop from coordinates, so that each fits the 21 bits of a Morton code.
unsigned surplus_bits(const QuantisedMesh& mesh)
{
    std::uint32_t all = 0;
    for (const auto& position : mesh.positions)
    {
        all |= static_cast<std::uint32_t>(position[0] | position[1] | position[2]);
    }
    const auto width = static_cast<unsigned>(std::bit_width(all));
    return width > 21 ? width - 21 : 0;
}

std::uint64_t morton_code(const std::array<std::int32_t, 3>& position, unsigned surplus)
{
    std::uint64_t code = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        code |= spread_bits(static_cast<std::uint32_t>(position[axis]) >> surplus) << axis;
    }
    return code;
}

/// Sorts the records of each tier by Morton code. Equal codes keep the order of splits, coarsest
/// first.
void order_records(const QuantisedMesh& mesh, const Simplification& simplification,
                   Numbering& numbering)
{
    struct Place
    {
        std::uint64_t code;
        std::uint32_t collapse;
    };
    const std::size_t records = simplification.collapses.size();
    const unsigned surplus = surplus_bits(mesh);
    std::vector<Place> places(records);
    for (std::size_t i = 0; i < records; ++i)
    {
        const auto collapse = static_cast<std::uint32_t>(records - 1 - i);
        const std::uint32_t vertex = simplification.collapses[collapse].vertex;
        places[i] = {morton_code(mesh.positions[vertex], surplus), collapse};
    }
    for (std::uint64_t first = 0; first < records; first = tier_end(first))
    {
        const std::uint64_t end = std::min<std::uint64_t>(tier_end(first), records);
        std::sort(places.begin() + static_cast<std::ptrdiff_t>(first),
                  places.begin() + static_cast<std::ptrdiff_t>(end),
                  [](const Place& a, const Place& b)
                  { return a.code != b.code ? a.code < b.code : a.collapse > b.collapse; });
    }
    numbering.collapse_of_record.resize(records);
    std::transform(places.begin(), places.end(), numbering.collapse_of_record.begin(),
                   [](const Place& place) { return place.collapse; });
}

void number_vertices(const Simplification& simplification, Numbering& numbering)
{
    const ModelCounts& counts = numbering.counts;
    for (std::uint32_t record = 0; record < counts.records; ++record)
    {
        const std::uint32_t collapse = numbering.collapse_of_record[record];
        VertexId& id = numbering.vertex_ids[simplification.collapses[collapse].vertex];
        TACTUS_ASSERT(id.is_none());
        id = counts.vertex_of({record});
    }
    for (std::uint32_t vertex = 0; vertex < numbering.vertex_ids.size(); ++vertex)
    {
        if (numbering.vertex_ids[vertex].is_none())
        {
            numbering.vertex_ids[vertex] = {
                static_cast<std::uint32_t>(numbering.base_vertices.size())};
            numbering.base_vertices.push_back(vertex);
        }
    }
}

void number_faces(const Simplification& simplification, Numbering& numbering)
{
    const auto& remaining = simplification.base_faces;
    numbering.base_faces.resize(remaining.size());
    std::iota(numbering.base_faces.begin(), numbering.base_faces.end(), 0U);
    std::sort(numbering.base_faces.begin(), numbering.base_faces.end(),
              [&](std::uint32_t a, std::uint32_t b) { return remaining[a] < remaining[b]; });
    for (std::uint32_t id = 0; id < numbering.base_faces.size(); ++id)
    {
        numbering.face_ids[remaining[numbering.base_faces[id]]] = {id};
    }
    for (std::uint32_t record = 0; record < numbering.counts.records; ++record)
    {
        const auto& star = simplification.collapses[numbering.collapse_of_record[record]].star;
        for (std::uint32_t side = 0; side < 2; ++side)
        {
            if (star[side] != Collapse::kNoFace)
            {
                TACTUS_ASSERT(numbering.face_ids[star[side]].is_none());
                numbering.face_ids[star[side]] = numbering.counts.face_of({record}, side);
            }
        }
    }
}

} // namespace

Numbering number_model(const QuantisedMesh& mesh, const Simplification& simplification)
{
    const std::size_t records = simplification.collapses.size();
    TACTUS_ASSERT(records <= kMaxRecords && records <= mesh.positions.size());
    Numbering numbering;
    numbering.counts = {static_cast<std::uint32_t>(mesh.positions.size() - records),
                        static_cast<std::uint32_t>(simplification.base_faces.size()),
                        static_cast<std::uint32_t>(records)};
    numbering.vertex_ids.resize(mesh.positions.size());
    numbering.face_ids.resize(mesh.faces.size());
    order_records(mesh, simplification, numbering);
    number_vertices(simplification, numbering);
    number_faces(simplification, numbering);
    return numbering;
}

} // namespace tactus
