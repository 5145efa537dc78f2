// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/object_pose.hpp"

namespace tactus::hrtc
{

Similarity to_similarity(const Pose& pose)
{
    const auto [x, y, z, w] = pose.rotation;
    // Divided here, once: a length that rounding left beside 1 does no harm.
    const double s = 2.0 / (x * x + y * y + z * z + w * w);
    const auto& at = pose.translation_m;
    Similarity place;
    place.rotation << 1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w),
        s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w), s * (x * z - y * w),
        s * (y * z + x * w), 1.0 - s * (x * x + y * y);
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
