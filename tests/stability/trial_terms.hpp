// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <array>
#include <cstdio>
#include <string>

/// Constants and functions of all trials.
namespace tactus::test
{

inline constexpr double kRadius_diag = 0.01; ///< Radius of a spherical tool.
/// Limits of with_tool().
inline constexpr double kForceMax_n = 8.0;
inline constexpr double kWall_n_per_m = 500.0;
/// Diagonals of objects.
inline constexpr double kSmallest_m = 0.1;
inline constexpr double kLargest_m = 0.2;

template <typename Real>
bool is_between(double lower, Real distance, double upper)
{
    return static_cast<Real>(lower) <= distance && distance <= static_cast<Real>(upper);
}

/// Number with all digits.
[[nodiscard]] inline std::string exactly(double value)
{
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.17g", value);
    return text.data();
}
[[nodiscard]] inline std::string exactly(const Vec3& v)
{
    return "(" + exactly(v.x()) + ", " + exactly(v.y()) + ", " + exactly(v.z()) + ")";
}

} // namespace tactus::test
