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

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Pose of an object: the frame of its source mesh in the world. The default is the source mesh's
/// own pose. Inside the frame, from model_pose() on, it is the pose of the model's frame. A
/// SceneChange beyond kPoseReachMax_m, kPoseScaleMin to kPoseScaleMax or kRotationTolerance is
/// ChangeRefusal::bad_pose.
struct ObjectPose : Similarity
{
    std::int64_t stamp_ns{0}; ///< The sender's time; frames ignore it.
    /// Arrival on the clock of FrameInput::now_ns. A pose older than FrameSetup::pose_age_max_ns
    /// makes answers stale; 0: the pose does not age.
    std::int64_t arrival_ns{0};
    std::uint32_t revision{0}; ///< Model revision of the pose; another one is stale.
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

/// Bound on the error of distances from a core of this radius round a place of the world that the
/// conversion into the model's frame and back causes: see kPoseRounding.
[[nodiscard]] inline double pose_rounding_m(const ObjectPose& pose, const Vec3& world_m,
                                            double radius_m) noexcept
{
    TACTUS_ASSERT(radius_m >= 0.0);
    return kPoseRounding *
           ((world_m - pose.translation_m).norm() + world_m.norm() + 2.0 * radius_m);
}

/// Age of a pose at `now_ns`; 0 if it arrived after the frame began.
[[nodiscard]] inline std::int64_t age_ns(const ObjectPose& pose, std::int64_t now_ns) noexcept
{
    return pose.arrival_ns == 0 || pose.arrival_ns > now_ns ? 0 : now_ns - pose.arrival_ns;
}

} // namespace tactus
