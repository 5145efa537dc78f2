// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/spm/error_code.hpp"
#include "rt_core/spm/header.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// One face of the base mesh, the coarsest cut, which is always resident.
struct BaseFace
{
    std::array<VertexId, 3> corners{};
    std::uint32_t bucket{0}; ///< Rank in the left-full median order, >> 3.
    ErrorCode error{0};
};

/// The base mesh as a reader uses it; in the model's frame.
struct BaseView
{
    std::span<const Vec3f> positions_m;
    std::span<const BaseFace> faces;
};

/// The base mesh in memory lent by the caller, sized by the header's counts.
struct BaseMesh
{
    std::span<Vec3f> positions_m;
    std::span<BaseFace> faces;
    /// Record that splits each face first, as VsplitRecord::next.
    std::span<std::uint32_t> next;

    [[nodiscard]] BaseView view() const noexcept { return {positions_m, faces}; }
    /// The part of these spans that one of several meshes has: its cells from `first` on.
    [[nodiscard]] BaseMesh part(std::uint32_t first, const ModelCounts& counts) const noexcept
    {
        return {positions_m.subspan(first, counts.base_vertices),
                faces.subspan(first, counts.base_faces), next.subspan(first, counts.base_faces)};
    }
    /// Number of cells of a mesh with these counts; a cell holds a vertex, a face and its `next`.
    [[nodiscard]] static std::uint32_t cells_of(const ModelCounts& counts) noexcept
    {
        return std::max(counts.base_vertices, counts.base_faces);
    }
};

/// Bit widths of a coded base mesh's fields, from their largest values.
struct BaseLayout
{
    std::array<std::uint32_t, 3> axis_bits{};
    std::uint32_t vertex_bits{0};
    std::uint32_t bucket_bits{0};

    explicit constexpr BaseLayout(const HeaderFields& fields) noexcept
        : vertex_bits(static_cast<std::uint32_t>(std::bit_width(fields.base_vertices - 1)))
        , bucket_bits(static_cast<std::uint32_t>(
              std::bit_width(fields.source_faces > 0 ? (fields.source_faces - 1) / 8 : 0)))
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            axis_bits[axis] =
                static_cast<std::uint32_t>(std::bit_width(fields.extent_quanta[axis]));
        }
    }
};

/// Bytes of the coded base mesh: the bits of all fields, and a checksum. The header must be valid.
[[nodiscard]] constexpr std::uint64_t coded_base_bytes(const HeaderFields& fields) noexcept
{
    const BaseLayout layout(fields);
    const std::uint64_t vertex = layout.axis_bits[0] + layout.axis_bits[1] + layout.axis_bits[2];
    const std::uint64_t face = 3ULL * layout.vertex_bits + layout.bucket_bits + 8;
    return (fields.base_vertices * vertex + fields.base_faces * face + 7) / 8 + kChecksumBytes;
}

/// Reads a coded base mesh into `mesh`, whose spans must have the header's counts (asserted). On
/// refusal the content of `mesh` is unspecified, nothing else is changed. Time is linear in the
/// bytes.
[[nodiscard]] Result<Done, SpmRefusal> parse_base_mesh(std::span<const std::byte> bytes,
                                                       const ModelHeader& header,
                                                       const BaseMesh& mesh) noexcept;

} // namespace tactus
