// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/segment_triangle.hpp"

#include "rt_core/geometry/boundary_distance.hpp"
#include "rt_core/geometry/crossing.hpp"

namespace tactus
{

namespace
{

ClosestPoints find_closest(const Segment& segment, const Triangle& triangle) noexcept
{
    const bool is_met = meet(segment, triangle);
    if (is_met)
    {
        if (const auto piercing = find_piercing(segment, triangle))
        {
            return meeting_at(point_at(segment, piercing->parameter),
                              feature_of_edge(0, piercing->parameter), piercing->feature);
        }
    }
    const std::array<Vec3, 2> ends{segment.from, segment.to};
    const ClosestPoints nearest = nearest_boundary_points(ends, triangle);
    return is_met ? meeting_at(nearest.on_shape, nearest.shape_feature, nearest.feature) : nearest;
}

} // namespace

ClosestPoints closest_points(const Segment& segment, const Triangle& triangle) noexcept
{
    return solve_in_range(
        std::array{segment.from, segment.to, triangle[0], triangle[1], triangle[2]},
        [](const auto& points) noexcept {
            return find_closest({points[0], points[1]}, {points[2], points[3], points[4]});
        });
}

} // namespace tactus
