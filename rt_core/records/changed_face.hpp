// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/strong_id.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/spm/error_code.hpp"
#include "rt_core/spm/ids.hpp"

#include <array>
#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Slot of an active face in the pool of all models: dense and reused. The AB-Tree knows the face
/// by it. Valid only until the next frame; FaceId is the lasting name.
using PrimId = StrongId<struct PrimTag>;

/// A face that splits or merges of this frame have changed, in its present state; the forest passes
/// it to the tree. Several changes of one face in a frame become one.
struct ChangedFace
{
    PrimId prim{};
    FaceId face{};           ///< None: the slot holds no face any more.
    std::uint32_t bucket{0}; ///< Upper part of the face's path in the tree; constant for a face.
    ErrorCode error{0};      ///< 0: the face is exact.
    std::array<Vec3f, 3> corners_m{};
};

} // namespace tactus
