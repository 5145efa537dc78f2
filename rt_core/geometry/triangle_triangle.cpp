// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/triangle_triangle.hpp"

#include "rt_core/geometry/boundary_distance.hpp"
#include "rt_core/geometry/crossing.hpp"

namespace tactus
{

namespace
{

Segment edge_of(const Triangle& triangle, std::size_t edge) noexcept
{
    return {triangle[edge], triangle[(edge + 1) % 3]};
}

/// Triangles that meet.
ClosestPoints find_shared_point(const Triangle& first, const Triangle& second) noexcept
{
    for (std::size_t i = 0; i < 3; ++i)
    {
        const Segment edge = edge_of(first, i);
        if (const auto piercing = find_piercing(edge, second))
        {
            return meeting_at(point_at(edge, piercing->parameter),
                              feature_of_edge(i, piercing->parameter), piercing->feature);
        }
    }
    for (std::size_t i = 0; i < 3; ++i)
    {
        const Segment edge = edge_of(second, i);
        if (const auto piercing = find_piercing(edge, first))
        {
            return meeting_at(point_at(edge, piercing->parameter), piercing->feature,
                              feature_of_edge(i, piercing->parameter));
        }
    }
    const ClosestPoints nearest = nearest_boundary_points(first, second);
    return meeting_at(nearest.on_shape, nearest.shape_feature, nearest.feature);
}

} // namespace

ClosestPoints closest_points(const Triangle& first, const Triangle& second) noexcept
{
    return solve_in_range(std::array{first[0], first[1], first[2], second[0], second[1], second[2]},
                          [](const auto& points) noexcept
                          {
                              const Triangle a{points[0], points[1], points[2]};
                              const Triangle b{points[3], points[4], points[5]};
                              return meet(a, b) ? find_shared_point(a, b)
                                                : nearest_boundary_points(a, b);
                          });
}

} // namespace tactus
