// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry> // cross(), whose absence shows only as a link error.

#include <algorithm>
#include <array>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

#ifndef EIGEN_DONT_VECTORIZE
#error "Tactus needs EIGEN_DONT_VECTORIZE: Eigen's explicit FMA would change bits between builds."
#endif

/// Double precision, in which decisions are made. The default constructor leaves values undefined.
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// Single precision, in which coordinates are stored; exact for mesh vertices.
using Vec3f = std::array<float, 3>;

[[nodiscard]] inline Vec3 to_vec3(const Vec3f& v) noexcept
{
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// Coordinate-wise minimum and maximum. Eigen's own are not marked TACTUS_NONBLOCKING.
[[nodiscard]] inline Vec3 least_of(const Vec3& a, const Vec3& b) noexcept
{
    return {std::min(a.x(), b.x()), std::min(a.y(), b.y()), std::min(a.z(), b.z())};
}
[[nodiscard]] inline Vec3 greatest_of(const Vec3& a, const Vec3& b) noexcept
{
    return {std::max(a.x(), b.x()), std::max(a.y(), b.y()), std::max(a.z(), b.z())};
}

} // namespace tactus
