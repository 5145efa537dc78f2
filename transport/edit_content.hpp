// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/surface_edit.hpp"

#include <cstdint>
#include <vector>

// Any thread except the haptic one: values that allocate.
namespace tactus
{

/// Largest number of faces that one part of a sum of edits removes, and that it adds. Frames take
/// the sum in edits of kMaxEditFaces.
inline constexpr std::uint32_t kMaxSumFaces = 1'024;

/// A SurfaceEdit that owns its faces, for a model that its holder knows.
struct EditContent
{
    std::uint32_t revision{0};
    std::vector<FaceId> removed;
    std::vector<AddedFace> added;
    Aabb removed_m; ///< SurfaceEdit::removed_m.

    bool operator==(const EditContent&) const = default;

    /// View for a frame; valid as long as this object and unchanged.
    [[nodiscard]] SurfaceEdit view(ModelId model) const noexcept
    {
        return {model, revision, removed, added, removed_m};
    }
};

} // namespace tactus
