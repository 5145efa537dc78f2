// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/shapes.hpp"
#include "rt_core/math/safe_scale.hpp"
#include "rt_core/math/triangle.hpp"

#include <array>

namespace tactus
{

/// Nearest points of a shape and a triangle, one on each.
struct ClosestPoints
{
    Vec3 on_shape{0.0, 0.0, 0.0};
    Vec3 on_triangle{0.0, 0.0, 0.0};
    /// Vector from on_shape to on_triangle, without the rounding of large coordinates: its
    /// direction is good even if the two points round to one.
    Vec3 gap{0.0, 0.0, 0.0};
    /// Distance of the two; zero if they meet, negative for overlapping round shapes, down to minus
    /// the radius.
    double distance{0.0};
    /// Bound on the error |computed - true| of `distance`: kernel_error().
    double distance_error{0.0};
    /// True if the two share a point: exact, except for round shapes, which compare `distance`.
    bool meet{false};
    /// Feature of the triangle at its nearest point.
    TriangleFeature feature{TriangleFeature::interior};
    /// Feature of the shape at its nearest point, if it is a triangle or a segment (corner_0,
    /// corner_1 or edge_0).
    TriangleFeature shape_feature{TriangleFeature::interior};
};

/// Closest points of shapes that meet in `point`.
[[nodiscard]] inline ClosestPoints meeting_at(const Vec3& point, TriangleFeature shape_feature,
                                              TriangleFeature feature) noexcept
{
    ClosestPoints result;
    result.on_shape = point;
    result.on_triangle = point;
    result.meet = true;
    result.shape_feature = shape_feature;
    result.feature = feature;
    return result;
}

/// Returns `solve`(points). If products of coordinates would leave the range of double, the points
/// are multiplied by a power of two first, and the result is divided by it.
template <std::size_t N, typename Solve>
[[nodiscard]] ClosestPoints solve_in_range(const std::array<Vec3, N>& points, Solve solve) noexcept
{
    const double scale = safe_scale(largest_coordinate(points));
    TACTUS_ASSERT(scale > 0.0);
    if (scale == 1.0)
    {
        return solve(points);
    }
    std::array<Vec3, N> near = points;
    for (Vec3& point : near)
    {
        point *= scale;
    }
    ClosestPoints result = solve(near);
    const double inverse = 1.0 / scale;
    result.on_shape *= inverse;
    result.on_triangle *= inverse;
    result.gap *= inverse;
    result.distance *= inverse;
    result.distance_error *= inverse;
    return result;
}

/// Nearest points of a segment and a triangle; if they meet, a shared point.
///
/// |computed - true| <= 4e-16 x local length for any shapes, including slivers and points. The
/// local length is the longest of the edges and of the distances between corners. The points are
/// rounded to doubles in addition. Coordinates up to 1e300; those below 1e-85 of the largest may
/// count as 0. About 0.9 us for separate shapes; 1 to 3 us if they touch or many features are
/// equally near.
[[nodiscard]] ClosestPoints closest_points(const Segment& segment,
                                           const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

/// Nearest points of two triangles, of which `first` is the shape; if they meet, a shared point.
/// Error law and range are those of a segment and a triangle. About 1.4 us for separate ones; 3 to
/// 7 us if they touch or lie in one plane.
[[nodiscard]] ClosestPoints closest_points(const Triangle& first,
                                           const Triangle& second) noexcept TACTUS_NONBLOCKING;

/// closest_points() with the result of meet() given; the same to the bit.
[[nodiscard]] ClosestPoints closest_points(const Triangle& first, const Triangle& second,
                                           bool do_meet) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
