// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/model_id.hpp"
#include "rt_core/math/aabb.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/spm/ids.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// A face that an edit adds to a model. It is exact and always resident.
struct AddedFace
{
    /// Place among the added faces, below the model's room for them. The face's id is
    /// ModelCounts::face_ids() + slot.
    std::uint32_t slot{0};
    /// Upper part of the face's path in the AB-Tree: that of a source face nearby.
    std::uint32_t bucket{0};
    /// Corners in the model's frame, each a whole number of quanta; counter-clockwise from outside.
    std::array<Vec3f, 3> corners_m{};

    constexpr bool operator==(const AddedFace&) const noexcept = default;
};

/// A change of a model's surface, an input of a frame: faces that go and faces that come, both at
/// once. A face is a source face, or one that an earlier edit added.
struct SurfaceEdit
{
    ModelId model;
    std::uint32_t revision{0}; ///< Number of the edit for this model, from 1, without gaps.
    std::span<const FaceId> removed;
    std::span<const AddedFace> added;
    Aabb removed_m; ///< Box that holds the removed source faces; empty without any. Model frame.
};

/// Reasons why a frame refused an edit; the model is unchanged.
enum class EditRefusal : std::uint8_t
{
    too_many,       ///< The frame has taken kMaxEditsPerFrame already. Send the edit later.
    unknown_model,  ///< The model does not exist, or has no room for added faces.
    wrong_revision, ///< Not the number after that of the model's last edit.
    too_large,      ///< More than kMaxEditFaces faces.
    unknown_face,   ///< A removed face is not part of the surface.
    /// An added face has a used or too large slot, or leaves the model's box; or the box of the
    /// removed source faces is none.
    bad_face,
};
inline constexpr std::size_t kEditRefusals = 6;
/// Names of the reasons, in the order of EditRefusal.
inline constexpr std::array<const char*, kEditRefusals> kEditRefusalNames{
    "too_many", "unknown_model", "wrong_revision", "too_large", "unknown_face", "bad_face"};
static_assert(static_cast<std::size_t>(EditRefusal::bad_face) + 1 == kEditRefusals);

} // namespace tactus
