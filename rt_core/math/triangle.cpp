// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/math/triangle.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/kernel_error.hpp"
#include "rt_core/math/safe_scale.hpp"
#include "rt_core/math/triple.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// A triangle relative to the query point, which is the origin.
struct Surroundings
{
    std::array<Vec3, 3> corner;
    std::array<Vec3, 3> edge;
    std::array<double, 3> edge_sq;
    double longest_sq{0.0}; ///< Of the edges.
    double local_sq{0.0};   ///< Of edges and corners.
};

Surroundings look_from(const Vec3& query, const Triangle& triangle) noexcept
{
    Surroundings around{
        {triangle[0] - query, triangle[1] - query, triangle[2] - query}, {}, {}, 0.0, 0.0};
    for (std::size_t i = 0; i < 3; ++i)
    {
        around.edge[i] = around.corner[(i + 1) % 3] - around.corner[i];
        around.edge_sq[i] = around.edge[i].squaredNorm();
        around.longest_sq = std::max(around.longest_sq, around.edge_sq[i]);
        around.local_sq = std::max(around.local_sq, around.corner[i].squaredNorm());
    }
    around.local_sq = std::max(around.local_sq, around.longest_sq);
    return around;
}

struct SegmentFoot
{
    Vec3 foot;
    double parameter;
};

SegmentFoot foot_on_segment(const Vec3& from, const Vec3& edge, double length_sq) noexcept
{
    if (length_sq == 0.0)
    {
        return {from, 0.0};
    }
    const double parameter = std::clamp(-from.dot(edge) / length_sq, 0.0, 1.0);
    // From the nearer end, so that the far end's rounding does not enter.
    const Vec3 foot = parameter <= 0.5 ? Vec3(from + parameter * edge)
                                       : Vec3((from + edge) - (1.0 - parameter) * edge);
    return {foot, parameter};
}

void find_on_edges(const Surroundings& around, ClosestPoint& result) noexcept
{
    result.gap = around.corner[0];
    result.distance_sq = around.corner[0].squaredNorm();
    result.feature = TriangleFeature::corner_0;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const SegmentFoot foot =
            foot_on_segment(around.corner[i], around.edge[i], around.edge_sq[i]);
        const double distance_sq = foot.foot.squaredNorm();
        if (distance_sq < result.distance_sq)
        {
            result.distance_sq = distance_sq;
            result.gap = foot.foot;
            result.feature = feature_of_edge(i, foot.parameter);
        }
    }
}

void find_in_interior(const Surroundings& around, const Vec3& normal, ClosestPoint& result) noexcept
{
    for (std::size_t i = 0; i < 3; ++i)
    {
        if (!(around.edge[i].cross(normal).dot(around.corner[i]) > 0.0))
        {
            return;
        }
    }
    const double normal_sq = normal.squaredNorm();
    const double height = around.corner[0].dot(normal);
    const double plane_sq = height * height / normal_sq;
    if (plane_sq < result.distance_sq)
    {
        result.distance_sq = plane_sq;
        result.gap = normal * (height / normal_sq);
        result.feature = TriangleFeature::interior;
    }
}

/// Of lengths between 2^-130 and 2^130.
ClosestPoint find_closest(const Triangle& triangle, const Surroundings& around) noexcept
{
    ClosestPoint result;
    find_on_edges(around, result);
    Vec3 normal = around.edge[0].cross(around.edge[1]);
    double aspect = kLargestAspect;
    if (normal.squaredNorm() * (kLargestAspect * kLargestAspect) >
        around.longest_sq * around.longest_sq)
    {
        aspect = around.longest_sq / normal.norm();
    }
    else
    {
        normal = exact_normal(triangle, around.longest_sq);
    }
    find_in_interior(around, normal, result);
    result.distance_error = kernel_error(aspect, std::sqrt(around.local_sq));
    return result;
}

/// Of coordinates so large or small that their products would not be doubles.
[[gnu::noinline]] ClosestPoint find_closest_scaled(const Vec3& query,
                                                   const Triangle& triangle) noexcept
{
    const std::array<Vec3, 4> points{query, triangle[0], triangle[1], triangle[2]};
    const double scale = safe_scale(largest_coordinate(points));
    const Triangle near = scaled(triangle, scale);
    ClosestPoint result = find_closest(near, look_from(query * scale, near));
    const double inverse = 1.0 / scale;
    result.gap *= inverse;
    result.distance_sq = result.distance_sq * inverse * inverse;
    result.distance_error *= inverse;
    return result;
}

} // namespace

Vec3 exact_normal(const Triangle& triangle, double longest_sq) noexcept
{
    TACTUS_ASSERT(longest_sq >= 0.0);
    const auto normal = to_vec3(cross(difference<DoubleDouble>(triangle[1], triangle[0]),
                                      difference<DoubleDouble>(triangle[2], triangle[1])));
    const double least = 0x1p-50 * longest_sq;
    return normal.squaredNorm() > least * least ? normal : Vec3(0.0, 0.0, 0.0);
}

ClosestPoint closest_point_on_triangle(const Vec3& query, const Triangle& triangle) noexcept
{
    const Surroundings around = look_from(query, triangle);
    const bool is_in_range = around.local_sq > 0x1p-260 && around.local_sq < 0x1p260;
    ClosestPoint result =
        is_in_range ? find_closest(triangle, around) : find_closest_scaled(query, triangle);
    result.point = query + result.gap;
    return result;
}

} // namespace tactus
