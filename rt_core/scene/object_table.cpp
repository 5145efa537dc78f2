// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/scene/object_table.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/rotation.hpp"

#include <cmath>

namespace tactus
{

namespace
{

/// Deviation of R^T R from the identity up to which a rotation keeps its bits; kPoseRounding
/// assumes it.
constexpr double kRounded = 2e-15;

} // namespace

bool is_sound(const ObjectPose& pose) noexcept
{
    const Vec3& at_m = pose.translation_m;
    const bool is_in_reach = std::abs(at_m.x()) <= kPoseReachMax_m &&
                             std::abs(at_m.y()) <= kPoseReachMax_m &&
                             std::abs(at_m.z()) <= kPoseReachMax_m;
    return is_in_reach && pose.scale >= kPoseScaleMin && pose.scale <= kPoseScaleMax &&
           is_rotation(pose.rotation, kRotationTolerance);
}

std::optional<ChangeRefusal>
ObjectTable::find_refusal(const SceneChange& change, std::span<const bool> is_shown) const noexcept
{
    if (change.number >= objects_.size())
    {
        return ChangeRefusal::number_too_big;
    }
    const Object& object = objects_[change.number];
    if (change.kind != SceneChangeKind::object_comes)
    {
        if (!object.is_resident)
        {
            return ChangeRefusal::not_here;
        }
        if (change.generation != object.generation)
        {
            return ChangeRefusal::old_generation;
        }
    }
    else
    {
        if (object.is_resident)
        {
            return ChangeRefusal::already_here;
        }
        if (object.was_here && change.generation <= object.generation)
        {
            return ChangeRefusal::old_generation;
        }
        if (change.object.model.value >= is_shown.size() || !is_shown[change.object.model.value])
        {
            return ChangeRefusal::unknown_model;
        }
    }
    if (has_material(change.kind) && !is_sound(change.object.material))
    {
        return ChangeRefusal::bad_material;
    }
    if (has_pose(change.kind) && !is_sound(change.pose))
    {
        return ChangeRefusal::bad_pose;
    }
    return std::nullopt;
}

void ObjectTable::make(const SceneChange& change, const Vec3& origin_m,
                       std::uint32_t frame) noexcept
{
    TACTUS_ASSERT(change.number < objects_.size());
    Object& object = objects_[change.number];
    object.is_resident = change.kind != SceneChangeKind::object_goes;
    if (!object.is_resident)
    {
        return;
    }
    if (change.kind == SceneChangeKind::object_feels)
    {
        object.spec.material = change.object.material;
        return;
    }
    if (change.kind == SceneChangeKind::object_comes)
    {
        object.spec = change.object;
        object.generation = change.generation;
        object.came_frame = frame;
        object.was_here = true;
    }
    object.moved_frame = frame;
    ObjectPose pose = change.pose;
    if (!is_orthonormal(pose.rotation, kRounded))
    {
        pose.rotation = orthonormalised(pose.rotation);
    }
    object.pose = model_pose(pose, origin_m);
}

} // namespace tactus
