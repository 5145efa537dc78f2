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

/// Height of a triangle, as a share of its longest edge, up to which its edges represent it.
constexpr double kThinnestHeight = 0x1p-50;
/// Range of squared lengths for which the products in find_closest() neither overflow nor lose
/// bits.
constexpr double kLeastLocalSq = 0x1p-260;
constexpr double kLargestLocalSq = 0x1p260;

// NOLINTBEGIN(cppcoreguidelines-pro-bounds-constant-array-index): columns below 3.
// NOLINTBEGIN(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays): rows of SeenTriangle.

Vec3 column(const double (&rows)[3][4], std::size_t i) noexcept
{
    return {rows[0][i], rows[1][i], rows[2][i]};
}

void put_column(double (&rows)[3][4], std::size_t i, const Vec3& value) noexcept
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        rows[axis][i] = value[static_cast<Eigen::Index>(axis)];
    }
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
    // Measured from the nearer end, so that the far end's rounding does not enter.
    const Vec3 foot = parameter <= 0.5 ? Vec3(from + parameter * edge)
                                       : Vec3((from + edge) - (1.0 - parameter) * edge);
    return {foot, parameter};
}

/// True if the origin lies over the triangle along the normal: all three edge tests agree.
bool is_over(const SeenTriangle& seen, const Vec3& normal) noexcept
{
    for (std::size_t i = 0; i < 3; ++i)
    {
        if (!(column(seen.edge, i).cross(normal).dot(column(seen.corner, i)) > 0.0))
        {
            return false;
        }
    }
    return true;
}

double largest_of(const double (&values)[4]) noexcept
{
    return std::max({values[0], values[1], values[2]});
}

void find_on_edges(const SeenTriangle& seen, ClosestPoint& result) noexcept
{
    result.gap = column(seen.corner, 0);
    result.distance_sq = seen.corner_sq[0];
    result.feature = TriangleFeature::corner_0;
    for (std::size_t i = 0; i < 3; ++i)
    {
        if (seen.foot_sq[i] < result.distance_sq)
        {
            result.distance_sq = seen.foot_sq[i];
            result.gap = column(seen.foot, i);
            result.feature = feature_of_edge(i, seen.parameter[i]);
        }
    }
}

void find_in_interior(const SeenTriangle& seen, const Vec3& normal, ClosestPoint& result) noexcept
{
    const double normal_sq = normal.squaredNorm();
    const double height = column(seen.corner, 0).dot(normal);
    const double plane_sq = height * height / normal_sq;
    if (plane_sq < result.distance_sq)
    {
        result.distance_sq = plane_sq;
        result.gap = normal * (height / normal_sq);
        result.feature = TriangleFeature::interior;
    }
}

/// Nearest point for squared lengths between kLeastLocalSq and kLargestLocalSq; `local_sq` is the
/// largest squared length of edges and corners.
ClosestPoint find_closest(const Triangle& triangle, const SeenTriangle& seen,
                          double local_sq) noexcept
{
    ClosestPoint result;
    find_on_edges(seen, result);
    Vec3 normal(seen.normal[0], seen.normal[1], seen.normal[2]);
    bool is_inside = seen.is_inside;
    double aspect = kLargestAspect;
    const double longest_sq = largest_of(seen.edge_sq);
    if (normal.squaredNorm() * (kLargestAspect * kLargestAspect) > longest_sq * longest_sq)
    {
        aspect = longest_sq / normal.norm();
    }
    else
    {
        normal = exact_normal(triangle, longest_sq);
        is_inside = is_over(seen, normal);
    }
    if (is_inside)
    {
        find_in_interior(seen, normal, result);
    }
    result.distance_error = kernel_error(aspect, std::sqrt(local_sq));
    return result;
}

double local_sq(const SeenTriangle& seen) noexcept
{
    return std::max(largest_of(seen.corner_sq), largest_of(seen.edge_sq));
}

/// find_closest() for coordinates so large or small that their products would not be doubles.
[[gnu::noinline]] ClosestPoint find_closest_scaled(const Vec3& query,
                                                   const Triangle& triangle) noexcept
{
    const std::array<Vec3, 4> points{query, triangle[0], triangle[1], triangle[2]};
    const double scale = safe_scale(largest_coordinate(points));
    const Triangle near = scaled(triangle, scale);
    const Vec3 near_query = query * scale;
    SeenTriangle seen; // NOLINT(cppcoreguidelines-pro-type-member-init): filled below.
    see_triangle(near_query.data(), near[0].data(), seen);
    ClosestPoint result = find_closest(near, seen, local_sq(seen));
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
    const double least = kThinnestHeight * longest_sq;
    return normal.squaredNorm() > least * least ? normal : Vec3(0.0, 0.0, 0.0);
}

void see_triangle(const double* query, const double* triangle, SeenTriangle& seen) noexcept
{
    const Vec3 from(query[0], query[1], query[2]);
    for (std::size_t i = 0; i < 3; ++i)
    {
        const double* at = triangle + 3 * i;
        const Vec3 corner = Vec3(at[0], at[1], at[2]) - from;
        put_column(seen.corner, i, corner);
        seen.corner_sq[i] = corner.squaredNorm();
    }
    for (std::size_t i = 0; i < 3; ++i)
    {
        const Vec3 corner = column(seen.corner, i);
        const Vec3 edge = column(seen.corner, (i + 1) % 3) - corner;
        seen.edge_sq[i] = edge.squaredNorm();
        const SegmentFoot foot = foot_on_segment(corner, edge, seen.edge_sq[i]);
        put_column(seen.edge, i, edge);
        put_column(seen.foot, i, foot.foot);
        seen.foot_sq[i] = foot.foot.squaredNorm();
        seen.parameter[i] = foot.parameter;
    }
    const Vec3 normal = column(seen.edge, 0).cross(column(seen.edge, 1));
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        seen.normal[axis] = normal[static_cast<Eigen::Index>(axis)];
    }
    seen.is_inside = is_over(seen, normal);
}

ClosestPoint closest_point_seen(const Vec3& query, const Triangle& triangle,
                                const SeenTriangle& seen) noexcept
{
    const double local = local_sq(seen);
    const bool is_in_range = local > kLeastLocalSq && local < kLargestLocalSq;
    ClosestPoint result =
        is_in_range ? find_closest(triangle, seen, local) : find_closest_scaled(query, triangle);
    result.point = query + result.gap;
    return result;
}

ClosestPoint closest_point_on_triangle(const Vec3& query, const Triangle& triangle) noexcept
{
    SeenTriangle seen; // NOLINT(cppcoreguidelines-pro-type-member-init): filled below.
    see_triangle(query.data(), triangle[0].data(), seen);
    return closest_point_seen(query, triangle, seen);
}

// NOLINTEND(cppcoreguidelines-avoid-c-arrays,modernize-avoid-c-arrays)
// NOLINTEND(cppcoreguidelines-pro-bounds-constant-array-index)

} // namespace tactus
