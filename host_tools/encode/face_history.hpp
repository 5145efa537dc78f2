// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/numbering.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "rt_core/spm/error_code.hpp"
#include "rt_core/spm/page.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tactus
{

/// States and error bounds of the faces of one record's star: of the fan before the split, of all
/// faces after it.
struct StarHistory
{
    std::array<FaceState, kMaxFanFaces> before{};
    std::array<ErrorCode, kMaxFanFaces> error_before{};
    std::array<ErrorCode, kMaxStarFaces> error_after{}; ///< 0 only for a face of the source.
    std::uint32_t depth{0};
};

/// History of every face from the base mesh to the source mesh.
struct FaceHistory
{
    std::vector<StarHistory> stars;    ///< Histories, by RecordId.
    std::vector<ErrorCode> base_error; ///< Error bounds of the base mesh's faces, by FaceId.
    std::uint32_t max_depth{0};
    ErrorCode max_error{0};
};

/// Reverts the collapses, coarsest first, and records the faces' states before and after each
/// split. Linear; 44 B a record.
[[nodiscard]] FaceHistory trace_faces(const QuantisedMesh& mesh,
                                      const Simplification& simplification,
                                      const Numbering& numbering);

} // namespace tactus
