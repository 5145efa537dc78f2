// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/closest_points.hpp"

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

/// Returns a shared point of two triangles that meet.
ClosestPoints find_shared_point(const Triangle& first, const Triangle& second) noexcept
{
    if (const auto found = find_edge_piercing(first, second))
    {
        const Triangle& triangle = *found->triangle;
        const double parameter = found->piercing.parameter;
        const Vec3 point =
            point_at({triangle[found->edge], triangle[(found->edge + 1) % 3]}, parameter);
        const TriangleFeature on_edge = feature_of_edge(found->edge, parameter);
        return found->triangle == &first ? meeting_at(point, on_edge, found->piercing.feature)
                                         : meeting_at(point, found->piercing.feature, on_edge);
    }
    const ClosestPoints nearest = nearest_boundary_points(first, second);
    return meeting_at(nearest.on_shape, nearest.shape_feature, nearest.feature);
}

template <typename DoMeet>
ClosestPoints find_closest(const Triangle& first, const Triangle& second, DoMeet do_meet) noexcept
{
    return solve_in_range(std::array{first[0], first[1], first[2], second[0], second[1], second[2]},
                          [do_meet](const auto& points) noexcept
                          {
                              const Triangle a{points[0], points[1], points[2]};
                              const Triangle b{points[3], points[4], points[5]};
                              return do_meet(a, b) ? find_shared_point(a, b)
                                                   : nearest_boundary_points(a, b);
                          });
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

ClosestPoints closest_points(const Triangle& first, const Triangle& second) noexcept
{
    return find_closest(first, second,
                        [](const Triangle& a, const Triangle& b) noexcept { return meet(a, b); });
}

ClosestPoints closest_points(const Triangle& first, const Triangle& second, bool do_meet) noexcept
{
    return find_closest(first, second,
                        [do_meet](const Triangle& /*a*/, const Triangle& /*b*/) noexcept
                        { return do_meet; });
}

} // namespace tactus
