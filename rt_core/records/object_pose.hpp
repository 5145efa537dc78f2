// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/similarity.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/material.hpp"
#include "rt_core/spm/ids.hpp"

#include <cstdint>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Pose of an object in the world: of its source mesh's frame, or, from model_pose() on, of its
/// model's frame. A SceneChange with a pose beyond kPoseReachMax_m, kPoseScaleMin .. kPoseScaleMax
/// or kRotationTolerance is refused as ChangeRefusal::bad_pose.
struct ObjectPose : Similarity
{
    std::int64_t stamp_ns{0}; ///< Time of the pose on the sender's clock; frames ignore it.
    /// Arrival on the clock of FrameInput::now_ns. A pose older than FrameSetup::pose_age_max_ns
    /// makes answers stale; 0: the pose does not age.
    std::int64_t arrival_ns{0};
    /// Model revision that the pose is for; answers for another revision are stale.
    std::uint32_t revision{0};
};

/// Model and material of an object.
struct ObjectSpec
{
    ModelId model{};
    Material material{};
};

/// The pose of the model's frame, whose origin lies at `origin_m` (ModelHeader::origin_m) in the
/// frame of the source mesh.
[[nodiscard]] inline ObjectPose model_pose(const ObjectPose& source_pose,
                                           const Vec3& origin_m) noexcept
{
    ObjectPose pose = source_pose;
    pose.translation_m = source_pose.local_to_world(origin_m);
    return pose;
}

[[nodiscard]] inline Vec3 to_model(const ObjectPose& pose, const Vec3& world_m) noexcept
{
    return pose.world_to_local(world_m);
}

[[nodiscard]] inline Vec3 to_world(const ObjectPose& pose, const Vec3& model_m) noexcept
{
    return pose.local_to_world(model_m);
}

/// Bound, in metres, on the rounding of a distance that is computed in the model's frame and
/// converted to the world (kPoseRounding). The core has the centre `world_m` and this radius.
[[nodiscard]] inline double pose_rounding_m(const ObjectPose& pose, const Vec3& world_m,
                                            double radius_m) noexcept
{
    TACTUS_ASSERT(radius_m >= 0.0);
    return kPoseRounding *
           ((world_m - pose.translation_m).norm() + world_m.norm() + 2.0 * radius_m);
}

/// Age of a pose at `now_ns`; 0 if the pose does not age or arrived after `now_ns`.
[[nodiscard]] inline std::int64_t age_ns(const ObjectPose& pose, std::int64_t now_ns) noexcept
{
    return pose.arrival_ns == 0 || pose.arrival_ns > now_ns ? 0 : now_ns - pose.arrival_ns;
}

} // namespace tactus
