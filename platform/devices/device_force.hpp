// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/haptic_device.hpp"
#include "rt_core/math/vec3.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus
{

/// Converts a vector to the array type of DeviceInfo, DeviceSample and Wrench.
[[nodiscard]] inline std::array<double, 3> to_array(const Vec3& v) noexcept
{
    return {v.x(), v.y(), v.z()};
}

[[nodiscard]] inline Vec3 to_vec3(const std::array<double, 3>& v) noexcept
{
    return {v[0], v[1], v[2]};
}

/// Wrench that a device renders for a written one, by the rules of HapticDevice::write(). Counts
/// clamped and refused wrenches in `status`.
[[nodiscard]] inline Wrench take_wrench(const Wrench& written, const DeviceInfo& info,
                                        DeviceStatus& status) noexcept
{
    const Vec3 force_n = to_vec3(written.force_world_n);
    const double torque_max_nm = info.limits.rotation.torque_max_nm;
    const Vec3 torque_nm =
        torque_max_nm > 0.0 ? to_vec3(written.torque_world_nm) : Vec3(Vec3::Zero());
    const double norm_n = force_n.norm();
    const double norm_nm = torque_nm.norm();
    const double grip_n =
        std::clamp(written.gripper_force_n, -info.gripper_force_max_n, info.gripper_force_max_n);
    if (!std::isfinite(norm_n + norm_nm + written.gripper_force_n))
    {
        ++status.forces_refused;
        return {};
    }
    double share = 1.0;
    share = norm_n > info.limits.force_max_n ? info.limits.force_max_n / norm_n : share;
    share = norm_nm > torque_max_nm ? std::min(share, torque_max_nm / norm_nm) : share;
    const bool is_grip_clamped =
        info.gripper_force_max_n > 0.0 && grip_n != written.gripper_force_n;
    status.forces_clamped += share < 1.0 || is_grip_clamped ? 1U : 0U;
    return {to_array(force_n * share), to_array(torque_nm * share), grip_n};
}

} // namespace tactus
