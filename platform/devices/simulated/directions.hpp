// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <Eigen/Geometry>

namespace tactus
{

/// Unit vector, or zero for the zero vector.
[[nodiscard]] inline Vec3 direction_or_zero(const Vec3& v) noexcept
{
    const double length = v.norm();
    return length > 0.0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

/// Unit vector perpendicular to `direction`, a function of it alone; `direction` must not be zero.
[[nodiscard]] inline Vec3 any_across(const Vec3& direction) noexcept
{
    int least = 0;
    direction.cwiseAbs().minCoeff(&least);
    return direction.cross(Vec3::Unit(least)).normalized();
}

/// Component of `v` perpendicular to the unit vector `direction`.
[[nodiscard]] inline Vec3 part_across(const Vec3& v, const Vec3& direction) noexcept
{
    return v - direction * v.dot(direction);
}

} // namespace tactus
