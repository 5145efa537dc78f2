// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/strong_id.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/spm/error_code.hpp"
#include "rt_core/spm/ids.hpp"

#include <array>
#include <cstdint>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Index of an active face in the pool of all models, and its name in the AB-Tree. Indices are
/// reused: one is valid only until the next frame. FaceId is the lasting name.
using PrimId = StrongId<struct PrimTag>;

/// Present state of a face that splits or merges of this frame have changed, for the AB-Tree.
/// Several changes of one face become one record.
struct ChangedFace
{
    PrimId prim{};
    FaceId face{}; ///< Lasting id of the face; none if the face is no longer active.
    /// Upper part of the face's path in the AB-Tree; never changes for a face.
    std::uint32_t bucket{0};
    ErrorCode error{0}; ///< Code of the face's error; 0: exact, unless the face is outdated.
    std::array<Vec3f, 3> corners_m{};
    /// True for a coarse face that may stand for faces that an edit removed: it bounds distances
    /// from below only.
    bool is_outdated{false};
};

} // namespace tactus
