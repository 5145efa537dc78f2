// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/scene/object_pose.hpp"

#include "rt_core/math/rotation.hpp"

namespace tactus::hrtc
{

Similarity to_similarity(const Pose& pose)
{
    const auto& at = pose.translation_m;
    Similarity place;
    place.rotation = to_rotation(pose.rotation);
    place.translation_m = Vec3(at[0], at[1], at[2]);
    place.scale = pose.scale;
    return place;
}

ObjectPose object_pose(const Similarity& place, const ModelHeader& header)
{
    ObjectPose pose{place};
    pose.revision = header.fields().revision;
    return pose;
}

} // namespace tactus::hrtc
