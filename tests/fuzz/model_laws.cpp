// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/fuzz/model_laws.hpp"

#include "rt_core/spm/coded_record.hpp"
#include "rt_core/spm/page.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <string_view>

namespace tactus::fuzz
{
namespace
{

bool has_lawful_star(const ModelCounts& counts, RecordId id, const VsplitRecord& record)
{
    const std::uint32_t first_face = counts.base_faces + 2 * id.value;
    for (std::uint32_t side = 0; side < 2; ++side)
    {
        if (record.has_face(side) && record.star[side].value != first_face + side)
        {
            return false;
        }
    }
    if (record.fan_size < 1 || record.fan_size > 6)
    {
        return false;
    }
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        const FaceId face = record.star[2 + i];
        const FaceState before = record.before[i];
        const auto fan = std::span(record.star).subspan(2, record.fan_size);
        const bool is_possible =
            before.is_base() ? face.value < counts.base_faces
                             : before.record().value < counts.records && before.record() != id;
        if (face.value >= counts.base_faces + 2 * counts.records || !is_possible ||
            std::ranges::count(fan, face) != 1)
        {
            return false;
        }
    }
    return true;
}

/// Exact faces and only those are never split.
bool has_lawful_next(const ModelCounts& counts, const VsplitRecord& record)
{
    for (std::uint32_t place = 0; place < 2U + record.fan_size; ++place)
    {
        const std::uint32_t next = record.next[place];
        const bool is_exact = record.error[place] == 0;
        if (!record.star[place].is_none() &&
            (is_exact ? next != kNextExact : next != kNextPending && next >= counts.records))
        {
            return false;
        }
    }
    return true;
}

bool is_lawful_owner(const ModelCounts& counts, RecordId id, const CodedRecord::Owner& owner)
{
    switch (owner.kind)
    {
    case CodedRecord::Owner::Kind::derived:
        return owner.value == 0;
    case CodedRecord::Owner::Kind::record:
        return owner.value < counts.records && owner.value != id.value;
    case CodedRecord::Owner::Kind::base:
        return owner.value < counts.base_faces;
    }
    return false;
}

/// True if there is an L with each error 0 or one of L, L - 2, ... L - 28, at least 1.
bool has_lawful_errors(const CodedRecord& record)
{
    const int largest = std::ranges::max(record.error);
    for (int top = std::max(largest, 1); top <= std::min(largest + 28, 255); ++top)
    {
        const auto is_step = [top](int error)
        {
            const bool is_below = error >= top - 28 && (top - error) % 2 == 0;
            return error == 0 || is_below || (error == 1 && top <= 28);
        };
        if (std::ranges::all_of(record.error, is_step))
        {
            return true;
        }
    }
    return false;
}

/// True if all fields that the grammar does not store are 0.
bool has_nothing_else(const CodedRecord& record)
{
    CodedRecord told;
    told.anchor = {record.anchor.value, record.anchor.kind, {}};
    told.place =
        record.anchor.kind == CodedRecord::Owner::Kind::base ? std::uint8_t{0} : record.place;
    told.corner = record.corner;
    told.left = record.left;
    told.right = record.right;
    told.sides = record.sides;
    told.residual = record.residual;
    for (std::size_t i = 0; i < std::size_t{0} + record.left + record.right; ++i)
    {
        told.others[i] = {record.others[i].value, record.others[i].kind, {}};
        told.error[2 + i] = record.error[2 + i];
    }
    const std::size_t last = std::size_t{2} + record.left + record.right;
    told.error[last] = record.error[last];
    for (std::uint32_t side = 0; side < 2; ++side)
    {
        if (((record.sides >> side) & 1U) != 0)
        {
            told.error[side] = record.error[side];
            told.bucket_step[side] = record.bucket_step[side];
        }
    }
    return std::memcmp(&told, &record, sizeof(told)) == 0;
}

bool is_lawful_coded(const ModelCounts& counts, RecordId id, const CodedRecord& record)
{
    const bool has_fan = record.left + record.right <= 5;
    return has_fan && record.anchor.kind != CodedRecord::Owner::Kind::derived &&
           is_lawful_owner(counts, id, record.anchor) &&
           std::ranges::all_of(record.others, [&](const CodedRecord::Owner& owner)
                               { return is_lawful_owner(counts, id, owner); }) &&
           record.place <= 7 && record.corner <= 2 && is_in(record.sides, 0, 3) &&
           std::ranges::all_of(record.residual, [](std::int32_t residual)
                               { return is_in(residual, -134'217'728, 134'217'728); }) &&
           has_lawful_errors(record) && has_nothing_else(record);
}

bool is_cleared(const VsplitRecord& record)
{
    const VsplitRecord clear;
    return std::memcmp(&record, &clear, sizeof(record)) == 0;
}

} // namespace

bool is_lawful_parsed_page(const ModelHeader& header, ChunkId id, const Page& page)
{
    for (std::uint32_t place = 0; place < 64; ++place)
    {
        const RecordId record{id.value * 64 + place};
        const bool is_lawful =
            record.value < header.fields().records
                ? is_lawful_coded(header.counts(), record, coded_form(page.records[place]))
                : is_cleared(page.records[place]);
        if (!is_lawful)
        {
            return false;
        }
    }
    return true;
}

bool is_lawful_linked(const ModelHeader& header, RecordId id, const VsplitRecord& record)
{
    const ModelCounts counts = header.counts();
    return is_in(record.depth, 1, header.fields().max_depth) && record.reach != 0 &&
           record.parent.value < counts.base_vertices + counts.records &&
           record.parent.value != counts.base_vertices + id.value &&
           is_on_grid(header, record.position_m) && has_lawful_star(counts, id, record) &&
           has_lawful_next(counts, record);
}

namespace
{

constexpr std::uint64_t kMostRecords = 536'870'910; // The bound is 2^29 - 2.

bool has_lawful_counts(const HeaderFields& f)
{
    return std::string_view(f.magic.data(), f.magic.size()) == "TACTSPM\n" &&
           is_in(f.base_vertices, 3, 49'152) && is_in(f.base_faces, 1, 16'384) &&
           f.records <= kMostRecords && f.max_depth <= 1'024 &&
           (f.max_depth == 0) == (f.records == 0);
}

bool has_lawful_geometry(const HeaderFields& f)
{
    bool is_lawful =
        is_in(f.quantum_log2, -60, 20) && is_in(f.position_bits, 16, 24) && f.topology < 2;
    const double quantum_m = std::ldexp(1.0, f.quantum_log2);
    double diagonal_sq = 0.0;
    std::uint32_t largest = 0;
    for (std::size_t axis = 0; axis < 3 && is_lawful; ++axis)
    {
        const double extent_m = f.extent_quanta[axis] * quantum_m;
        diagonal_sq += extent_m * extent_m;
        is_lawful = is_in(f.origin_m[axis], -1e7, 1e7 - extent_m) &&
                    (f.extent_quanta[axis] >> f.position_bits) == 0;
        largest = std::max(largest, f.extent_quanta[axis]);
    }
    return is_lawful && largest > 0 &&
           is_in(f.quantisation_m, 0.0, std::sqrt(diagonal_sq) * (1.0 + 1e-12));
}

bool has_lawful_regions(const ModelHeader& header)
{
    const HeaderFields& f = header.fields();
    double product = 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        product *= f.region_grid[axis];
        if (double{1.0} * f.region_grid[axis] * f.region_cell_quanta <= f.extent_quanta[axis])
        {
            return false;
        }
    }
    if (std::popcount(f.region_cell_quanta) != 1 || !is_in(product, 1, 262'144) ||
        product != header.region_count())
    {
        return false;
    }
    std::uint32_t occupied = 0;
    for (RegionId region{0}; region.value < header.region_count(); ++region.value)
    {
        occupied += header.is_occupied(region) ? 1U : 0U;
    }
    return occupied >= 1 && occupied == f.occupied_regions;
}

bool has_lawful_index(const ModelHeader& header)
{
    const std::uint64_t chunks = (std::uint64_t{header.fields().records} + 63) / 64;
    const std::uint64_t pages = (chunks + 63) / 64;
    for (IndexPageId page{0}; page.value < pages; ++page.value)
    {
        const QuantumBox box = header.index_entry(page).box;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            if (box.low[axis] > box.high[axis])
            {
                return false;
            }
        }
    }
    return true;
}

} // namespace

bool is_lawful_header(const ModelHeader& header, std::span<const std::byte> bytes)
{
    const HeaderFields& f = header.fields();
    const std::uint64_t chunks = (std::uint64_t{f.records} + 63) / 64;
    return f.header_bytes == bytes.size() && has_lawful_counts(f) && has_lawful_geometry(f) &&
           has_lawful_regions(header) && has_lawful_index(header) &&
           f.header_bytes ==
               168 + 48 * ((chunks + 63) / 64) + (header.region_count() + 7ULL) / 8 + 36;
}

bool is_on_grid(const ModelHeader& header, const Vec3f& position_m)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double quanta =
            std::ldexp(static_cast<double>(position_m[axis]), -header.fields().quantum_log2);
        if (!is_in(quanta, 0.0, header.fields().extent_quanta[axis]) ||
            quanta != std::floor(quanta))
        {
            return false;
        }
    }
    return true;
}

bool is_lawful_base(const ModelHeader& header, const BaseMesh& mesh)
{
    for (const Vec3f& position_m : mesh.positions_m)
    {
        if (!is_on_grid(header, position_m))
        {
            return false;
        }
    }
    for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    {
        const auto [a, b, c] = mesh.faces[i].corners;
        if (std::max({a, b, c}).value >= header.fields().base_vertices || a == b || b == c ||
            c == a || mesh.next[i] != (mesh.faces[i].error == 0 ? kNextExact : kNextPending))
        {
            return false;
        }
    }
    return true;
}

bool is_lawful_index_page(const ModelCounts& counts, IndexPageId id, const IndexPage& page,
                          std::span<const ChunkEntry> entries)
{
    const std::uint64_t before = std::uint64_t{id.value} * 64;
    const std::uint64_t all = (std::uint64_t{counts.records} + 63) / 64;
    if (page.chunks != std::min<std::uint64_t>(64, all - before))
    {
        return false;
    }
    for (std::size_t chunk = 0; chunk < page.chunks; ++chunk)
    {
        const InfluenceBox box = page.box(chunk);
        if (box.low[0] > box.high[0] || box.low[1] > box.high[1] || box.low[2] > box.high[2] ||
            entries[chunk].coded_bytes < 1 || entries[chunk].coded_bytes > 8'448)
        {
            return false;
        }
    }
    return true;
}

} // namespace tactus::fuzz
