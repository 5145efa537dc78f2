// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/spm/ids.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// The first 128 bits of BLAKE2b-256 over a chunk, index page or base mesh in its coded form, or,
/// for a model, over its header: headers name the hashes of index pages, index pages those of
/// chunks, so a model's hash covers every byte of it (docs/internals/spm-format.md).
using ContentHash = std::array<std::uint8_t, 16>;

/// Reasons for which bytes were refused. `refusal_text` gives the words for a message.
enum class SpmRefusal : std::uint8_t
{
    too_short, ///< Fewer bytes than stated.
    wrong_magic,
    unknown_version, ///< Other than kFormatVersion and kCoderVersion.
    wrong_checksum,  ///< Wrong checksum or, if verified, wrong hash.
    wrong_size,      ///< A stated size contradicts the counts.
    count_out_of_range,
    /// The model has no such vertex, face or record.
    id_out_of_range,
    value_out_of_range,
    too_far,        ///< Coordinates beyond kModelReachMax_m.
    trailing_bytes, ///< More bytes than stated.
    /// Sound bytes, but of another model, page or chunk than requested.
    wrong_identity,
};

/// Text that follows the refused thing, such as a file's name; static.
[[nodiscard]] const char* refusal_text(SpmRefusal refusal) noexcept;

inline constexpr std::array<char, 8> kSpmMagic{'T', 'A', 'C', 'T', 'S', 'P', 'M', '\n'};
inline constexpr std::uint16_t kFormatVersion = 1;
/// Version 1 wrote every field of a record explicitly, version 2 had no pair contractions;
/// docs/internals/decisions/0006-chunk-coder.md.
inline constexpr std::uint16_t kCoderVersion = 3;

/// Topology of the source. Closed: every edge has two faces of like winding, so a distance has a
/// sign.
inline constexpr std::uint16_t kOpenTopology = 0;
inline constexpr std::uint16_t kClosedTopology = 1;

/// The fixed part of a header, as in the file and on the wire (little-endian, no padding).
struct HeaderFields
{
    std::array<char, 8> magic{kSpmMagic};
    std::uint16_t format_version{kFormatVersion};
    std::uint16_t coder_version{kCoderVersion};
    std::uint32_t header_bytes{0}; ///< Whole header, including the closing checksum.
    std::uint32_t revision{0};     ///< 0 for a model that was never edited.
    std::uint32_t base_vertices{0};
    std::uint32_t base_faces{0};
    std::uint32_t records{0};
    std::int32_t quantum_log2{0};                 ///< One quantum is 2^this metres.
    std::uint16_t position_bits{0};               ///< 16 .. 24.
    std::uint16_t topology{0};                    ///< kOpenTopology or kClosedTopology.
    std::array<std::uint32_t, 3> extent_quanta{}; ///< Largest coordinate; the smallest is 0.
    std::uint32_t max_depth{0};                   ///< Largest dependency depth of a record.
    std::array<double, 3> origin_m{};             ///< Place of (0, 0, 0) in the source's frame.
    double quantisation_m{0.0};                   ///< Largest shift of a vertex to the grid.
    std::uint32_t source_vertices{0};             ///< Vertices of the quantised mesh.
    std::uint32_t source_faces{0};
    std::uint32_t rounds{0};             ///< Rounds of collapses.
    std::uint32_t max_error_quanta{0};   ///< Largest error bound of a face, rounded up.
    std::uint32_t region_cell_quanta{0}; ///< Edge of a region; a power of two.
    std::array<std::uint32_t, 3> region_grid{};
    std::uint32_t occupied_regions{0};
    std::uint32_t base_bytes{0};
    std::uint64_t base_offset{0};  ///< Offset in the file.
    std::uint64_t index_offset{0}; ///< Offset in the file; index pages are consecutive.
    std::uint64_t file_bytes{0};
    ContentHash base_hash{};
};

static_assert(sizeof(HeaderFields) == 168);

/// A box in quanta; unlike vertices it may reach below zero and beyond the extent.
struct QuantumBox
{
    std::array<std::int32_t, 3> low{};
    std::array<std::int32_t, 3> high{};

    constexpr bool operator==(const QuantumBox&) const noexcept = default;
};

/// Upper level of the influence-box index: one entry for each index page.
struct IndexPageEntry
{
    QuantumBox box;                 ///< Union of the page's influence boxes.
    std::uint64_t chunks_offset{0}; ///< Offset of the page's first chunk in the file.
    ContentHash hash{};             ///< Hash of the index page.
};

static_assert(sizeof(IndexPageEntry) == 48);

/// A header that passed every check; a default one has no model. It is a view of the parsed bytes,
/// which must outlive it and its copies.
class ModelHeader
{
public:
    /// Checks everything: magic, versions, sizes (in 64 bits), counts, ranges and the checksum.
    /// `bytes` is exactly one header. Does not verify hashes (rt_core has no cryptography). Time is
    /// linear in the bytes.
    [[nodiscard]] static Result<ModelHeader, SpmRefusal>
    parse(std::span<const std::byte> bytes) noexcept;

    [[nodiscard]] const HeaderFields& fields() const noexcept { return fields_; }
    [[nodiscard]] ModelCounts counts() const noexcept
    {
        return {fields_.base_vertices, fields_.base_faces, fields_.records};
    }
    /// Metres in one quantum; a power of two, so products with grid integers are exact floats.
    [[nodiscard]] float quantum_m() const noexcept TACTUS_NONBLOCKING;
    /// Diagonal of the model's bounding box.
    [[nodiscard]] double diagonal_m() const noexcept;
    /// Origin of the model's frame in the source mesh's; the axes are parallel.
    [[nodiscard]] Vec3 origin_m() const noexcept
    {
        return {fields_.origin_m[0], fields_.origin_m[1], fields_.origin_m[2]};
    }
    [[nodiscard]] bool is_closed() const noexcept { return fields_.topology == kClosedTopology; }

    /// Index entry of a page, which must exist (asserted).
    [[nodiscard]] IndexPageEntry index_entry(IndexPageId page) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] std::uint32_t region_count() const noexcept
    {
        return fields_.region_grid[0] * fields_.region_grid[1] * fields_.region_grid[2];
    }
    /// True if any face meets the region, which must exist (asserted).
    [[nodiscard]] bool is_occupied(RegionId region) const noexcept;
    /// The region that holds a point of the model's frame; the nearest one for points outside.
    [[nodiscard]] RegionId region_at(const std::array<double, 3>& point_m) const noexcept;

private:
    [[nodiscard]] bool index_boxes_are_in_order() const noexcept;
    [[nodiscard]] std::uint32_t count_occupied() const noexcept;

    HeaderFields fields_;
    std::span<const std::byte> index_;
    std::span<const std::byte> regions_;
};

/// Sizes of the header's last two parts, behind fixed fields, index entries and region bits.
inline constexpr std::size_t kRootHashBytes = 32;
inline constexpr std::size_t kChecksumBytes = 4;
/// Size of a whole header, including the checksum.
[[nodiscard]] constexpr std::uint64_t header_bytes(std::uint64_t index_pages,
                                                   std::uint64_t regions) noexcept
{
    return sizeof(HeaderFields) + index_pages * sizeof(IndexPageEntry) + (regions + 7) / 8 +
           kRootHashBytes + kChecksumBytes;
}

} // namespace tactus
