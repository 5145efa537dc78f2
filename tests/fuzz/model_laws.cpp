// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/fuzz/model_laws.hpp"

#include "rt_core/spm/page.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

namespace tactus::fuzz
{

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
