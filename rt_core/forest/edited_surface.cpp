// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/forest/edited_surface.hpp"

#include "rt_core/math/smallest_union.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Buckets are ranks of faces, in eighths; AB-Tree paths have room for no more.
constexpr std::uint32_t kBucketEnd = 1U << 31U;

} // namespace

EditedSurface::EditedSurface(Arena& arena, const ModelHeader& header, std::uint32_t room) noexcept
    : face_ids_(header.counts().face_ids())
    , quantum_m_(header.quantum_m())
    , extent_quanta_(header.fields().extent_quanta)
    , removed_(arena.take<std::uint64_t>(room > 0 ? (face_ids_ + room + kBits - 1) / kBits : 0))
    , added_(arena.take<AddedFace>(room))
{
    if (arena.is_measuring())
    {
        added_ = {};
        return;
    }
    for (std::uint32_t slot = 0; slot < room; ++slot)
    {
        flip(FaceId{face_ids_ + slot});
    }
}

bool EditedSurface::may_be_removed_near(const Aabb& box, float margin_m) const noexcept
{
    const Aabb wide = box.inflated(margin_m);
    return std::ranges::any_of(boxes_, [&](const Aabb& removed) { return do_meet(wide, removed); });
}

std::optional<EditRefusal> EditedSurface::take(const SurfaceEdit& edit) noexcept
{
    if (!can_be_edited())
    {
        return EditRefusal::unknown_model;
    }
    if (edit.revision != revision_ + 1)
    {
        return EditRefusal::wrong_revision;
    }
    if (edit.removed.size() > kMaxEditFaces || edit.added.size() > kMaxEditFaces)
    {
        return EditRefusal::too_large;
    }
    if (!try_remove(edit.removed))
    {
        return EditRefusal::unknown_face;
    }
    const auto gone = static_cast<std::uint32_t>(
        std::ranges::count_if(edit.removed, [&](FaceId face) { return is_added(face); }));
    const bool has_source = gone < edit.removed.size();
    const bool has_good_box = has_source ? is_sound(edit.removed_m) : edit.removed_m == Aabb{};
    if (!has_good_box || !try_add(edit.added))
    {
        flip_all(edit.removed);
        return EditRefusal::bad_face;
    }
    for (const AddedFace& face : edit.added)
    {
        added_[face.slot] = face;
    }
    added_count_ = added_count_ - gone + static_cast<std::uint32_t>(edit.added.size());
    added_max_ = std::max(added_max_, added_count_);
    if (has_source)
    {
        add_box(edit.removed_m);
    }
    revision_ = edit.revision;
    return std::nullopt;
}

bool EditedSurface::is_present(FaceId face) const noexcept
{
    return face.value < face_ids_ + added_.size() && !is_removed(face);
}

bool EditedSurface::fits(const AddedFace& face) const noexcept
{
    if (face.slot >= added_.size() || face.bucket >= kBucketEnd)
    {
        return false;
    }
    for (const Vec3f& corner : face.corners_m)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const float quanta = corner[axis] / quantum_m_; // Exact: a power of two.
            const bool is_inside =
                quanta >= 0.0F && quanta <= static_cast<float>(extent_quanta_[axis]);
            if (!is_inside || quanta != static_cast<float>(static_cast<std::int32_t>(quanta)))
            {
                return false;
            }
        }
    }
    return true;
}

/// Marks all these faces as removed. False, with nothing changed, if one is not part of the surface
/// or occurs twice.
bool EditedSurface::try_remove(std::span<const FaceId> faces) noexcept
{
    for (std::size_t i = 0; i < faces.size(); ++i)
    {
        if (faces[i].is_none() || !is_present(faces[i]))
        {
            flip_all(faces.first(i));
            return false;
        }
        flip(faces[i]);
    }
    return true;
}

/// Marks the slots of all these faces as used. False, with nothing changed, if a face is not sound
/// or its slot is used, also by an earlier one of them.
bool EditedSurface::try_add(std::span<const AddedFace> faces) noexcept
{
    for (std::size_t i = 0; i < faces.size(); ++i)
    {
        if (!fits(faces[i]) || !is_removed(id_of(faces[i])))
        {
            for (const AddedFace& face : faces.first(i))
            {
                flip(id_of(face));
            }
            return false;
        }
        flip(id_of(faces[i]));
    }
    return true;
}

void EditedSurface::flip_all(std::span<const FaceId> faces) noexcept
{
    for (const FaceId face : faces)
    {
        flip(face);
    }
}

/// Adds a box; if there are too many, the two whose union is smallest become one.
void EditedSurface::add_box(const Aabb& box) noexcept
{
    if (std::ranges::any_of(boxes_, [&](const Aabb& known) { return holds(known, box); }))
    {
        return;
    }
    boxes_.push_back(box);
    if (boxes_.size() <= kMaxRemovedBoxes)
    {
        return;
    }
    const auto [first, second] = smallest_union(boxes_.view());
    boxes_[first].add(boxes_[second]);
    const Aabb last = boxes_.pop_back();
    if (second < boxes_.size())
    {
        boxes_[second] = last;
    }
}

void EditedSurface::flip(FaceId face) noexcept
{
    removed_[face.value / kBits] ^= std::uint64_t{1} << (face.value % kBits);
}

} // namespace tactus
