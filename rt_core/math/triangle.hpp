// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/vec3.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

using Triangle = std::array<Vec3, 3>;

[[nodiscard]] inline Triangle to_triangle(const std::array<Vec3f, 3>& corners) noexcept
{
    return {to_vec3(corners[0]), to_vec3(corners[1]), to_vec3(corners[2])};
}

/// Where on a triangle a point lies; edge i joins corners i and i + 1.
enum class TriangleFeature : std::uint8_t
{
    corner_0,
    corner_1,
    corner_2,
    edge_0,
    edge_1,
    edge_2,
    interior,
};

/// Aspect ratio (longest edge squared / twice the area) beyond which the error law below grows no
/// further: such a triangle's plane is never the nearest feature by more than that.
inline constexpr double kLargestAspect = 1e8;

struct ClosestPoint
{
    Vec3 point{0.0, 0.0, 0.0};
    double distance_sq{0.0};
    /// Bound on |computed - true| of the distance: (4e-16 + 1e-16 x aspect) x local length, with
    /// aspect = longest edge squared / twice the area, and local length the largest of the edges
    /// and the distances from the query point to the corners.
    double distance_error{0.0};
    TriangleFeature feature{TriangleFeature::interior};
};

/// The point of the triangle nearest to `query`.
///
/// In double precision, translated to the query point: the least of three clamped segment
/// distances, and the plane's only when all three edge tests agree. A triangle with two or three
/// equal corners is a segment or a point and no NaN arises for finite input. About 60
/// multiplications, one square root.
[[nodiscard]] ClosestPoint
closest_point_on_triangle(const Vec3& query, const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
