// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/device_frame.hpp"

#include "rt_core/math/rotation.hpp"

#include <cmath>

namespace tactus
{

namespace
{

/// NaN is none either.
bool is_right_handed_rotation(const Mat3& matrix) noexcept
{
    const Mat3 off = matrix.transpose() * matrix - Mat3::Identity();
    for (int i = 0; i < 9; ++i)
    {
        if (!(std::abs(off(i / 3, i % 3)) <= DeviceFrame::kRotationTolerance))
        {
            return false;
        }
    }
    return matrix.determinant() > 0.0;
}

bool is_near(const Vec3& translation_m) noexcept
{
    const double most_m = DeviceFrame::kTranslationMax_m;
    return std::abs(translation_m.x()) <= most_m && std::abs(translation_m.y()) <= most_m &&
           std::abs(translation_m.z()) <= most_m;
}

PlatformError refuse(const char* line)
{
    return {PlatformErrorKind::bad_option, line};
}

} // namespace

Result<DeviceFrame, PlatformError> DeviceFrame::create(const Mat3& rotation,
                                                       const Vec3& translation_m, double scale)
{
    if (!is_right_handed_rotation(rotation))
    {
        return refuse("device frame: the rotation must be orthonormal within 1e-6 and "
                      "right-handed (determinant 1, not -1)");
    }
    if (!is_near(translation_m))
    {
        return refuse("device frame: the translation must be within 10000 m on each axis");
    }
    if (!(scale >= kScaleMin && scale <= kScaleMax))
    {
        return refuse("device frame: the workspace scale must be in range 0.001..1000");
    }
    DeviceFrame frame;
    frame.rotation_ = orthonormalised(rotation);
    frame.translation_m_ = translation_m;
    frame.scale_ = scale;
    return frame;
}

DeviceInfo DeviceFrame::to_world(const DeviceInfo& device) const
{
    DeviceInfo world = device;
    world.limits.mass_kg /= scale_;
    world.limits.damping_n_s_per_m /= scale_;
    world.limits.quantum_m *= scale_;
    world.limits.stiffness_max_n_per_m /= scale_;
    world.limits.added_damping_max_n_s_per_m /= scale_;
    const auto& centre = device.workspace_centre_world_m;
    const Vec3 centre_m = position_to_world(Vec3(centre[0], centre[1], centre[2]));
    world.workspace_centre_world_m = {centre_m.x(), centre_m.y(), centre_m.z()};
    world.workspace_radius_m *= scale_;
    world.speed_max_m_per_s *= scale_;
    return world;
}

} // namespace tactus
