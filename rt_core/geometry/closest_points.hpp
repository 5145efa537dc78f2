// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
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
    /// Vector from the first to the second, free of the rounding of large coordinates: its
    /// direction is good even if the points themselves round to one.
    Vec3 gap{0.0, 0.0, 0.0};
    /// Zero where they meet; negative for round shapes, down to minus the radius.
    double distance{0.0};
    /// Bound on |computed - true| of the distance: kernel_error.
    double distance_error{0.0};
    /// True if they share a point: exact except for round shapes, which compare `distance`.
    bool meet{false};
    /// Feature of the triangle.
    TriangleFeature feature{TriangleFeature::interior};
    /// Feature of the shape, if it is a triangle or a segment (corner_0, corner_1 or edge_0).
    TriangleFeature shape_feature{TriangleFeature::interior};
};

/// Result for shapes that meet in a point.
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

/// Result of `solve`(points). If products of coordinates would not be doubles, the points are
/// multiplied by a power of two and the result is divided by it.
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

} // namespace tactus
