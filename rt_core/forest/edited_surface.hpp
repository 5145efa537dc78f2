// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/aabb.hpp"
#include "rt_core/records/surface_edit.hpp"
#include "rt_core/spm/header.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// What edits have changed of one model's surface: the removed source faces, one bit each, the
/// added faces, and boxes round the removed ones. Its memory is reserved at start: 44 B for each
/// face of the room, and one bit for each face of the model. Haptic thread.
class EditedSurface
{
public:
    /// Room for `room` added faces; with none the model can't be edited, and nothing is reserved.
    EditedSurface(Arena& arena, const ModelHeader& header, std::uint32_t room) noexcept;

    [[nodiscard]] bool can_be_edited() const noexcept { return !added_.empty(); }
    /// True if a source face was removed. Then coarse faces may be outdated, and final ones hidden.
    [[nodiscard]] bool has_removed() const noexcept { return !boxes_.empty(); }
    /// Number of the last edit; 0: none.
    [[nodiscard]] std::uint32_t revision() const noexcept { return revision_; }
    [[nodiscard]] std::uint32_t added() const noexcept { return added_count_; }
    [[nodiscard]] std::uint32_t added_max() const noexcept { return added_max_; }
    [[nodiscard]] std::uint32_t room() const noexcept
    {
        return static_cast<std::uint32_t>(added_.size());
    }

    /// True for the id of an added face.
    [[nodiscard]] bool is_added(FaceId face) const noexcept
    {
        return face.value >= face_ids_ && can_be_edited();
    }
    /// The added face of that id, which must be part of the surface (asserted).
    [[nodiscard]] const AddedFace& added(FaceId face) const noexcept
    {
        TACTUS_ASSERT(is_present(face));
        return added_[face.value - face_ids_];
    }
    /// Id of an added face.
    [[nodiscard]] FaceId id_of(const AddedFace& face) const noexcept
    {
        return {face_ids_ + face.slot};
    }
    /// True if edits removed this source face.
    [[nodiscard]] bool is_removed(FaceId face) const noexcept
    {
        return (removed_[face.value / kBits] >> (face.value % kBits) & 1U) != 0;
    }
    /// True if removed source faces may lie within `margin_m` >= 0 of the box.
    [[nodiscard]] bool may_be_removed_near(const Aabb& box,
                                           float margin_m) const noexcept TACTUS_NONBLOCKING;

    /// Takes an edit over: its removed and added faces and its box. If it is refused, nothing has
    /// changed. Time is linear in the edit.
    [[nodiscard]] std::optional<EditRefusal>
    take(const SurfaceEdit& edit) noexcept TACTUS_NONBLOCKING;

private:
    static constexpr std::uint32_t kBits = 64;

    [[nodiscard]] bool is_present(FaceId face) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool fits(const AddedFace& face) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool try_remove(std::span<const FaceId> faces) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool try_add(std::span<const AddedFace> faces) noexcept TACTUS_NONBLOCKING;
    void flip_all(std::span<const FaceId> faces) noexcept TACTUS_NONBLOCKING;
    void add_box(const Aabb& box) noexcept TACTUS_NONBLOCKING;
    void flip(FaceId face) noexcept;

    std::uint32_t face_ids_{0}; ///< Ids of source faces are below this.
    float quantum_m_{0.0F};
    std::array<std::uint32_t, 3> extent_quanta_{};
    /// One bit for each source face, set if it was removed, then one for each slot of an added
    /// face, set if there is none.
    std::span<std::uint64_t> removed_;
    std::span<AddedFace> added_;                     ///< Added faces by slot.
    StaticVector<Aabb, kMaxRemovedBoxes + 1> boxes_; ///< One more only while two become one.
    std::uint32_t revision_{0};
    std::uint32_t added_count_{0};
    std::uint32_t added_max_{0};
};

} // namespace tactus
