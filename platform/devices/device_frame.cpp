// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/device_frame.hpp"

#include "rt_core/limits.hpp"

#include <cmath>

namespace tactus
{

namespace
{

bool is_near(const Vec3& translation_m) noexcept
{
    const double most_m = kPoseReachMax_m;
    return std::abs(translation_m.x()) <= most_m && std::abs(translation_m.y()) <= most_m &&
           std::abs(translation_m.z()) <= most_m;
}

Refusal refuse(const char* line)
{
    return {line};
}

} // namespace

Result<DeviceFrame, Refusal> DeviceFrame::create(const Similarity& in_world)
{
    if (!is_rotation(in_world.rotation, kRotationTolerance))
    {
        return refuse("device frame: the rotation must be orthonormal within 1e-6 and "
                      "right-handed (determinant 1, not -1)");
    }
    if (!is_near(in_world.translation_m))
    {
        return refuse("device frame: the translation must be within 10000 m on each axis");
    }
    if (!(in_world.scale >= kPoseScaleMin && in_world.scale <= kPoseScaleMax))
    {
        return refuse("device frame: the workspace scale must be in range 0.001..1000");
    }
    DeviceFrame frame;
    frame.frame_ = in_world;
    frame.frame_.rotation = orthonormalised(in_world.rotation);
    return frame;
}

DeviceInfo DeviceFrame::to_world(const DeviceInfo& device) const
{
    DeviceInfo world = device;
    world.limits.mass_kg /= frame_.scale;
    world.limits.damping_n_s_per_m /= frame_.scale;
    world.limits.quantum_m *= frame_.scale;
    world.limits.stiffness_max_n_per_m /= frame_.scale;
    world.limits.added_damping_max_n_s_per_m /= frame_.scale;
    const auto& centre = device.workspace_centre_world_m;
    const Vec3 centre_m = position_to_world(Vec3(centre[0], centre[1], centre[2]));
    world.workspace_centre_world_m = {centre_m.x(), centre_m.y(), centre_m.z()};
    world.workspace_radius_m *= frame_.scale;
    world.speed_max_m_per_s *= frame_.scale;
    return world;
}

} // namespace tactus
