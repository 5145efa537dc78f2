// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/math/vec3.hpp"

#include <array>
#include <cstddef>

namespace tactus
{

using Vec2 = std::array<double, 2>;

/// The other two coordinates, in an order that keeps areas' signs: of x those are y, z.
[[nodiscard]] inline Vec2 seen_along(std::size_t axis, const Vec3& point) noexcept
{
    TACTUS_ASSERT(axis < 3);
    return {point[static_cast<Eigen::Index>((axis + 1) % 3)],
            point[static_cast<Eigen::Index>((axis + 2) % 3)]};
}

/// On which side of the plane through a, b, c the point d lies: 1 where (b - a) x (c - a) points
/// to, -1 on the other side, 0 in the plane, and also where a, b, c are collinear.
///
/// Exact when all coordinates are zero or between 1e-85 and 1e85 in magnitude: floating point with
/// an error bound, and exact arithmetic where that leaves it open. About 8 ns, 0.2 to 0.5 us when
/// exact arithmetic decides.
[[nodiscard]] int side_of_plane(const Vec3& a, const Vec3& b, const Vec3& c,
                                const Vec3& d) noexcept TACTUS_NONBLOCKING;

/// det[b - a, c - a, d - a] within three units in the last place, however much cancels, for the
/// same coordinates: double-double, or exact arithmetic where less than 2^-44 of the terms is left.
[[nodiscard]] double volume(const Vec3& a, const Vec3& b, const Vec3& c,
                            const Vec3& d) noexcept TACTUS_NONBLOCKING;

/// On which side of the line from a to b the point c lies: 1 on the left, -1 on the right, 0 on it,
/// and also where a = b. Exact for the same coordinates.
[[nodiscard]] int side_of_line(const Vec2& a, const Vec2& b,
                               const Vec2& c) noexcept TACTUS_NONBLOCKING;

/// Sign of a coordinate of (b - a) x (c - a) of the corners. Exact for the same coordinates.
[[nodiscard]] inline int area_sign_along(std::size_t axis,
                                         const std::array<Vec3, 3>& triangle) noexcept
{
    return side_of_line(seen_along(axis, triangle[0]), seen_along(axis, triangle[1]),
                        seen_along(axis, triangle[2]));
}

} // namespace tactus
