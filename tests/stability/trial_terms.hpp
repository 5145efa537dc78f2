// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "rt_core/records/contact.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <string>

/// Constants and functions of all trials.
namespace tactus::test
{

[[nodiscard]] inline bool same_bits(double a, double b)
{
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

[[nodiscard]] inline bool same_bits(const Vec3& a, const Vec3& b)
{
    return same_bits(a.x(), b.x()) && same_bits(a.y(), b.y()) && same_bits(a.z(), b.z());
}

[[nodiscard]] inline bool same_bits(const Contact& a, const Contact& b)
{
    return a.face == b.face && a.tool_face == b.tool_face && a.feature == b.feature &&
           same_bits(a.distance_m, b.distance_m) && same_bits(a.on_tool_m, b.on_tool_m) &&
           same_bits(a.on_surface_m, b.on_surface_m) && same_bits(a.normal, b.normal);
}

[[nodiscard]] inline bool same_bits(const ContactSet& a, const ContactSet& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Contact& x, const Contact& y) { return same_bits(x, y); });
}

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
