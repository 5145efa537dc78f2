// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/haptic_device.hpp"
#include "rt_core/math/vec3.hpp"

#include <array>
#include <cmath>

namespace tactus
{

/// As devices' records have it, which know no Eigen.
[[nodiscard]] inline std::array<double, 3> to_array(const Vec3& v) noexcept
{
    return {v.x(), v.y(), v.z()};
}

/// What a device makes of a written force: none when it isn't finite, else one of at most
/// `force_max_n` in the same direction. Counts in `status` what it had to change.
[[nodiscard]] inline Vec3 take_force(const std::array<double, 3>& force_world_n, double force_max_n,
                                     DeviceStatus& status) noexcept
{
    const Vec3 force_n{force_world_n[0], force_world_n[1], force_world_n[2]};
    const double norm_n = force_n.norm();
    if (!std::isfinite(norm_n))
    {
        ++status.forces_refused;
        return Vec3::Zero();
    }
    if (norm_n > force_max_n)
    {
        ++status.forces_clamped;
        return force_n * (force_max_n / norm_n);
    }
    return force_n;
}

} // namespace tactus
