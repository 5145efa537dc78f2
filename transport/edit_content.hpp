// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/aabb.hpp"
#include "rt_core/records/surface_edit.hpp"
#include "rt_core/spm/ids.hpp"

#include <cstdint>
#include <vector>

// Any thread except the haptic one: lists allocate.
namespace tactus
{

/// A SurfaceEdit with its own memory, of a model that the context names.
struct EditContent
{
    std::uint32_t revision{0};
    std::vector<FaceId> removed;
    std::vector<AddedFace> added;
    Aabb removed_m; ///< Box of the removed source faces in the model's frame; empty without any.
};

} // namespace tactus
