// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/object_pose.hpp"

namespace tactus::hrtc
{

namespace
{

/// Hosts and options speak of points of the source mesh, frames of the model's: they differ by its
/// origin.
ObjectPose in_model_frame(const Mat3& rotation, const Vec3& translation_m, double scale,
                          const ModelHeader& header)
{
    const auto& origin = header.fields().origin_m;
    const Vec3 origin_m(origin[0], origin[1], origin[2]);
    ObjectPose pose;
    pose.rotation = rotation;
    pose.scale = scale;
    pose.translation_m = translation_m + scale * (rotation * origin_m);
    pose.revision = header.fields().revision;
    return pose;
}

} // namespace

Mat3 rotation_of(const Pose& pose)
{
    const auto [x, y, z, w] = pose.rotation;
    // Divided here, once: a length that rounding left beside 1 does no harm.
    const double s = 2.0 / (x * x + y * y + z * z + w * w);
    Mat3 rotation;
    rotation << 1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w),
        s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w), s * (x * z - y * w),
        s * (y * z + x * w), 1.0 - s * (x * x + y * y);
    return rotation;
}

ObjectPose object_pose(const Placement& placement, const ModelHeader& header)
{
    return in_model_frame(rotation_of(placement), placement.translation_m, placement.scale, header);
}

ObjectPose object_pose(const Pose& pose, const ModelHeader& header)
{
    const auto& at = pose.translation_m;
    return in_model_frame(rotation_of(pose), Vec3(at[0], at[1], at[2]), pose.scale, header);
}

} // namespace tactus::hrtc
