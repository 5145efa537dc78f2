// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/math/triangle.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// Relative to the query point, which is the origin.
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

TriangleFeature segment_feature(std::size_t edge, double parameter) noexcept
{
    if (parameter == 0.0)
    {
        return static_cast<TriangleFeature>(edge);
    }
    if (parameter == 1.0)
    {
        return static_cast<TriangleFeature>((edge + 1) % 3);
    }
    return static_cast<TriangleFeature>(3 + edge);
}

} // namespace

ClosestPoint closest_point_on_triangle(const Vec3& query, const Triangle& triangle) noexcept
{
    const std::array<Vec3, 3> corner{triangle[0] - query, triangle[1] - query, triangle[2] - query};
    const std::array<Vec3, 3> edge{corner[1] - corner[0], corner[2] - corner[1],
                                   corner[0] - corner[2]};
    ClosestPoint result;
    result.distance_sq = corner[0].squaredNorm();
    Vec3 nearest = corner[0];
    result.feature = TriangleFeature::corner_0;
    double longest_sq = 0.0;
    double local_sq = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const double length_sq = edge[i].squaredNorm();
        longest_sq = std::max(longest_sq, length_sq);
        local_sq = std::max(local_sq, corner[i].squaredNorm());
        const SegmentFoot foot = foot_on_segment(corner[i], edge[i], length_sq);
        const double distance_sq = foot.foot.squaredNorm();
        if (distance_sq < result.distance_sq)
        {
            result.distance_sq = distance_sq;
            nearest = foot.foot;
            result.feature = segment_feature(i, foot.parameter);
        }
    }
    const Vec3 normal = edge[0].cross(edge[1]);
    const double normal_sq = normal.squaredNorm();
    const bool over_interior = edge[0].cross(normal).dot(corner[0]) > 0.0 &&
                               edge[1].cross(normal).dot(corner[1]) > 0.0 &&
                               edge[2].cross(normal).dot(corner[2]) > 0.0;
    double aspect = kLargestAspect;
    if (normal_sq > 0.0)
    {
        // Of a thinner triangle the normal may be rounding noise; its plane is nearer than its
        // edges by less than the law allows.
        const double true_aspect = longest_sq / std::sqrt(normal_sq);
        aspect = std::min(kLargestAspect, true_aspect);
        const double height = corner[0].dot(normal);
        const double plane_sq = height * height / normal_sq;
        if (over_interior && true_aspect < kLargestAspect && plane_sq < result.distance_sq)
        {
            result.distance_sq = plane_sq;
            nearest = normal * (height / normal_sq);
            result.feature = TriangleFeature::interior;
        }
    }
    const double local = std::sqrt(std::max(local_sq, longest_sq));
    result.distance_error = (4e-16 + 1e-16 * aspect) * local;
    result.point = query + nearest;
    return result;
}

} // namespace tactus
