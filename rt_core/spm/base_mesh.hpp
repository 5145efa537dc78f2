// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/spm/error_code.hpp"
#include "rt_core/spm/header.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <span>

namespace tactus
{

/// One face of the base mesh: the coarsest cut, always resident.
struct BaseFace
{
    std::array<VertexId, 3> corners{};
    std::uint32_t bucket{0}; ///< rank >> 3 in the left-full median order.
    ErrorCode error{0};
};

/// The base mesh in memory lent by the caller, sized by the header's counts.
struct BaseMesh
{
    std::span<Vec3f> positions_m;
    std::span<BaseFace> faces;
    /// Per face: which record splits it first, as VsplitRecord::next.
    std::span<std::uint32_t> next;
};

/// Bytes of the coded base mesh: 12 a vertex, 17 a face, a checksum.
[[nodiscard]] constexpr std::uint64_t coded_base_bytes(const ModelCounts& counts) noexcept
{
    return 12ULL * counts.base_vertices + 17ULL * counts.base_faces + kChecksumBytes;
}

/// Reads a coded base mesh into `mesh`, whose spans have the header's counts. On refusal the
/// content of `mesh` is unspecified, nothing else is touched.
[[nodiscard]] Result<Done, SpmRefusal> parse_base_mesh(std::span<const std::byte> bytes,
                                                       const ModelHeader& header,
                                                       const BaseMesh& mesh) noexcept;

} // namespace tactus
