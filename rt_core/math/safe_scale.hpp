// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/triangle.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

namespace tactus
{

/// The power of two that brings a positive number near 1. Multiplication by it changes no bit of a
/// coordinate unless that is 1e-280 times smaller.
[[nodiscard]] inline double scale_to_one(double largest) noexcept
{
    const std::uint64_t exponent = std::bit_cast<std::uint64_t>(largest) >> 52U;
    // The clamp keeps the inverse an ordinary double, too.
    const std::uint64_t inverse =
        std::clamp<std::uint64_t>(2046 - std::min<std::uint64_t>(exponent, 2045), 1, 2045);
    return std::bit_cast<double>(inverse << 52U);
}

/// Factor with which products of four or six coordinates neither overflow nor vanish: 1 if the
/// largest coordinate is 0 or between 2^-60 and 2^60, otherwise scale_to_one().
[[nodiscard]] inline double safe_scale(double largest) noexcept
{
    const bool is_safe = largest == 0.0 || (largest >= 0x1p-60 && largest <= 0x1p60);
    return is_safe ? 1.0 : scale_to_one(largest);
}

[[nodiscard]] inline double largest_coordinate(std::span<const Vec3> points) noexcept
{
    double largest = 0.0;
    for (const Vec3& point : points)
    {
        largest =
            std::max({largest, std::abs(point.x()), std::abs(point.y()), std::abs(point.z())});
    }
    return largest;
}

[[nodiscard]] inline Triangle scaled(const Triangle& triangle, double factor) noexcept
{
    return {triangle[0] * factor, triangle[1] * factor, triangle[2] * factor};
}

} // namespace tactus
