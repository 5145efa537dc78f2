// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/header.hpp"

#include "rt_core/base/byte_io.hpp"
#include "rt_core/base/crc32c.hpp"
#include "rt_core/math/vec3.hpp"

#include <bit>

namespace tactus
{

namespace
{

bool counts_are_in_range(const HeaderFields& fields) noexcept
{
    return fields.base_faces >= 1 && fields.base_faces <= kMaxBaseFaces &&
           fields.base_vertices >= 3 && fields.base_vertices <= kMaxBaseVertices &&
           fields.records <= kMaxRecords && fields.max_depth <= kMaxDepth &&
           (fields.records == 0) == (fields.max_depth == 0);
}

bool geometry_is_in_range(const HeaderFields& fields) noexcept
{
    if (fields.position_bits < kMinPositionBits || fields.position_bits > kMaxPositionBits ||
        fields.topology > kClosedTopology || fields.quantum_log2 < kMinQuantumLog2 ||
        fields.quantum_log2 > kMaxQuantumLog2)
    {
        return false;
    }
    bool has_extent = false;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        if (fields.extent_quanta[axis] >= (1U << fields.position_bits))
        {
            return false;
        }
        has_extent = has_extent || fields.extent_quanta[axis] > 0;
    }
    return has_extent;
}

/// True if the model is within kModelReachMax_m; false for NaN.
bool is_in_reach(const HeaderFields& fields, double quantum_m) noexcept
{
    bool is = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double low_m = fields.origin_m[axis];
        const double high_m = low_m + fields.extent_quanta[axis] * quantum_m;
        is = is && low_m >= -kModelReachMax_m && high_m <= kModelReachMax_m;
    }
    return is;
}

bool regions_are_in_range(const HeaderFields& fields) noexcept
{
    std::uint64_t regions = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const std::uint64_t cells = fields.region_grid[axis];
        if (cells == 0 || cells > kMaxRegions ||
            cells * fields.region_cell_quanta <= fields.extent_quanta[axis])
        {
            return false;
        }
        regions *= cells;
    }
    return std::has_single_bit(fields.region_cell_quanta) && regions <= kMaxRegions &&
           fields.occupied_regions >= 1 && fields.occupied_regions <= regions;
}

} // namespace

const char* refusal_text(SpmRefusal refusal) noexcept
{
    switch (refusal)
    {
    case SpmRefusal::too_short:
        return "is cut short";
    case SpmRefusal::wrong_magic:
        return "is not an SPM model";
    case SpmRefusal::unknown_version:
        return "has a format or coder version that this build does not know";
    case SpmRefusal::wrong_checksum:
        return "is damaged: its checksum does not match";
    case SpmRefusal::wrong_size:
        return "is damaged: a stated size does not match";
    case SpmRefusal::count_out_of_range:
        return "states a count outside the supported range";
    case SpmRefusal::id_out_of_range:
        return "names an id that the model does not have";
    case SpmRefusal::value_out_of_range:
        return "holds a value outside its range";
    case SpmRefusal::too_far:
        return "lies farther than 10,000 km from the origin of its coordinates";
    case SpmRefusal::trailing_bytes:
        return "is followed by bytes that do not belong to it";
    case SpmRefusal::wrong_identity:
        return "belongs to another model or place than stated";
    }
    return "is damaged";
}

Result<ModelHeader, SpmRefusal> ModelHeader::parse(std::span<const std::byte> bytes) noexcept
{
    ByteReader reader(bytes);
    ModelHeader header;
    HeaderFields& fields = header.fields_;
    fields = reader.read<HeaderFields>();
    if (reader.failed())
    {
        return SpmRefusal::too_short;
    }
    if (fields.magic != kSpmMagic)
    {
        return SpmRefusal::wrong_magic;
    }
    if (fields.format_version != kFormatVersion || fields.coder_version != kCoderVersion)
    {
        return SpmRefusal::unknown_version;
    }
    if (!counts_are_in_range(fields))
    {
        return SpmRefusal::count_out_of_range;
    }
    if (!geometry_is_in_range(fields) || !regions_are_in_range(fields))
    {
        return SpmRefusal::value_out_of_range;
    }
    if (!is_in_reach(fields, static_cast<double>(header.quantum_m())))
    {
        return SpmRefusal::too_far;
    }
    const bool is_fine =
        fields.quantisation_m >= 0.0 && fields.quantisation_m <= header.diagonal_m();
    if (!is_fine)
    {
        return SpmRefusal::value_out_of_range;
    }
    const std::uint64_t pages = header.counts().index_pages();
    if (fields.header_bytes != header_bytes(pages, header.region_count()))
    {
        return SpmRefusal::wrong_size;
    }
    if (bytes.size() != fields.header_bytes)
    {
        return bytes.size() < fields.header_bytes ? SpmRefusal::too_short
                                                  : SpmRefusal::trailing_bytes;
    }
    header.index_ = reader.read_bytes(pages * sizeof(IndexPageEntry));
    if (!header.index_boxes_are_in_order())
    {
        return SpmRefusal::value_out_of_range;
    }
    header.regions_ = reader.read_bytes((std::size_t{header.region_count()} + 7) / 8);
    if (header.count_occupied() != fields.occupied_regions)
    {
        return SpmRefusal::value_out_of_range;
    }
    static_cast<void>(reader.read_bytes(kRootHashBytes));
    if (reader.read<std::uint32_t>() != crc32c(bytes.first(bytes.size() - kChecksumBytes)))
    {
        return SpmRefusal::wrong_checksum;
    }
    return header;
}

bool ModelHeader::index_boxes_are_in_order() const noexcept
{
    for (std::uint32_t page = 0; page < counts().index_pages(); ++page)
    {
        const QuantumBox box = index_entry({page}).box;
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

std::uint32_t ModelHeader::count_occupied() const noexcept
{
    std::uint32_t count = 0;
    for (RegionId region{0}; region.value < region_count(); ++region.value)
    {
        count += is_occupied(region) ? 1U : 0U;
    }
    return count;
}

float ModelHeader::quantum_m() const noexcept
{
    return std::bit_cast<float>(static_cast<std::uint32_t>(fields_.quantum_log2 + 127) << 23U);
}

double ModelHeader::diagonal_m() const noexcept
{
    const Vec3 extent(fields_.extent_quanta[0], fields_.extent_quanta[1], fields_.extent_quanta[2]);
    return static_cast<double>(quantum_m()) * extent.norm();
}

IndexPageEntry ModelHeader::index_entry(IndexPageId page) const noexcept
{
    TACTUS_ASSERT(page.value < counts().index_pages());
    ByteReader reader(index_.subspan(page.value * sizeof(IndexPageEntry), sizeof(IndexPageEntry)));
    return reader.read<IndexPageEntry>();
}

bool ModelHeader::is_occupied(RegionId region) const noexcept
{
    TACTUS_ASSERT(region.value < region_count());
    return ((static_cast<std::uint32_t>(regions_[region.value / 8]) >> (region.value % 8)) & 1U) !=
           0;
}

RegionId ModelHeader::region_at(const std::array<double, 3>& point_m) const noexcept
{
    const double cell_m =
        static_cast<double>(fields_.region_cell_quanta) * static_cast<double>(quantum_m());
    std::uint32_t index = 0;
    for (std::size_t axis = 3; axis-- > 0;)
    {
        const std::uint32_t cells = fields_.region_grid[axis];
        const double place = point_m[axis] / cell_m;
        // Compared before the cast: a far or non-finite point must not overflow it.
        const std::uint32_t cell = !(place > 0.0) ? 0
                                   : place >= static_cast<double>(cells)
                                       ? cells - 1
                                       : static_cast<std::uint32_t>(place);
        index = index * cells + cell;
    }
    return {index};
}

} // namespace tactus
