// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/math/seen_triangle.hpp"
#include "rt_core/math/vec3.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Corners, in any one frame and unit of length.
using Triangle = std::array<Vec3, 3>;
static_assert(sizeof(Triangle) == 9 * sizeof(double), "nine coordinates, corner by corner");

[[nodiscard]] inline Triangle to_triangle(const std::array<Vec3f, 3>& corners) noexcept
{
    return {to_vec3(corners[0]), to_vec3(corners[1]), to_vec3(corners[2])};
}

/// Feature of a triangle on which a point lies; edge i joins corners i and i + 1.
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

/// Point of a triangle nearest to a query point, in the triangle's frame and unit.
struct ClosestPoint
{
    Vec3 point{0.0, 0.0, 0.0}; ///< The triangle's nearest point.
    /// Vector from the query point to `point`, free of the rounding of large coordinates.
    Vec3 gap{0.0, 0.0, 0.0};
    double distance_sq{0.0};
    /// Bound on |computed - true| of the distance: kernel_error, at most 1.2e-15 x local length.
    double distance_error{0.0};
    TriangleFeature feature{TriangleFeature::interior};
};

/// closest_point_on_triangle() for a triangle as see_triangle() computed it.
[[nodiscard]] ClosestPoint closest_point_seen(const Vec3& query, const Triangle& triangle,
                                              const SeenTriangle& seen) noexcept TACTUS_NONBLOCKING;

/// The point of the triangle nearest to `query`.
///
/// Double precision, translated to the query point: the least of three clamped segment distances,
/// and the plane's only if all three edge tests agree. The normal of a thin triangle comes from
/// double-double. A triangle with two or three equal corners is a segment or a point.
///
/// Coordinates up to 1e150 give finite answers. The error law holds if the local length is at least
/// 1e-40 of the largest coordinate. About 50 ns, 80 ns for a thin triangle.
[[nodiscard]] ClosestPoint
closest_point_on_triangle(const Vec3& query, const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

/// (b - a) x (c - b) of the corners, each coordinate correct to the last place however thin the
/// triangle. Zero if the triangle is thinner than 2^-50 of its longest edge (whose square is
/// `longest_sq`); its edges then represent it within half of that. About 80 ns.
[[nodiscard]] Vec3 exact_normal(const Triangle& triangle,
                                double longest_sq) noexcept TACTUS_NONBLOCKING;

/// The feature at `parameter` (0 to 1) of an edge; one of the edge's corners at the ends.
[[nodiscard]] constexpr TriangleFeature feature_of_edge(std::size_t edge, double parameter) noexcept
{
    TACTUS_ASSERT(edge < 3);
    const bool is_end = parameter == 0.0 || parameter == 1.0;
    const std::size_t corner = parameter == 0.0 ? edge : (edge + 1) % 3;
    return static_cast<TriangleFeature>(is_end ? corner : 3 + edge);
}

} // namespace tactus
