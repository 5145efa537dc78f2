// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/box_triangle.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/closest_features.hpp"
#include "rt_core/geometry/face_filter.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/kernel_error.hpp"
#include "rt_core/math/orientation.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// Edges as near as this, in local lengths, share a point with the box: what double-double leaves.
constexpr double kTouching = 1e-25;

Vec3 farthest_corner(const Box& box, const Vec3& direction) noexcept
{
    return {std::copysign(box.half.x(), direction.x()), std::copysign(box.half.y(), direction.y()),
            std::copysign(box.half.z(), direction.z())};
}

bool is_beyond_a_side(const Box& box, const Triangle& triangle) noexcept
{
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
        const auto [low, high] =
            std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
        if (low > box.half[axis] || high < -box.half[axis])
        {
            return true;
        }
    }
    return false;
}

/// Seen along an axis, the box is a rectangle and the triangle a triangle, and a line through one
/// of the triangle's edges may have one on either side.
bool has_edge_between_along(std::size_t axis, const Box& box, const Triangle& triangle) noexcept
{
    const Vec2 half = seen_along(axis, box.half);
    for (std::size_t i = 0; i < 3; ++i)
    {
        const Vec2 from = seen_along(axis, triangle[i]);
        const Vec2 to = seen_along(axis, triangle[(i + 1) % 3]);
        const Vec2 leftmost{from[1] > to[1] ? half[0] : -half[0],
                            to[0] > from[0] ? half[1] : -half[1]};
        const int third = side_of_line(from, to, seen_along(axis, triangle[(i + 2) % 3]));
        if ((third >= 0 && side_of_line(from, to, leftmost) < 0) ||
            (third <= 0 && side_of_line(from, to, {-leftmost[0], -leftmost[1]}) > 0))
        {
            return true;
        }
    }
    return false;
}

bool is_on_one_side_of(const Triangle& triangle, const Box& box) noexcept
{
    const Vec3 normal_signs(area_sign_along(0, triangle), area_sign_along(1, triangle),
                            area_sign_along(2, triangle));
    const Vec3 corner = farthest_corner(box, normal_signs);
    return side_of_plane(triangle[0], triangle[1], triangle[2], corner) < 0 ||
           side_of_plane(triangle[0], triangle[1], triangle[2], -corner) > 0;
}

double local_length(const Box& box, const Triangle& triangle) noexcept
{
    double longest_sq = 4.0 * box.half.squaredNorm();
    for (std::size_t i = 0; i < 3; ++i)
    {
        longest_sq = std::max({longest_sq, (triangle[i].cwiseAbs() + box.half).squaredNorm(),
                               (triangle[(i + 1) % 3] - triangle[i]).squaredNorm()});
    }
    return std::sqrt(longest_sq);
}

/// Of edges of the triangle and the box, and of a corner of the box and the face.
class BoxDistance
{
public:
    BoxDistance(const Box& box, const Triangle& triangle) noexcept
        : box_(box)
        , triangle_(triangle)
        , length_(local_length(box, triangle))
        , face_(triangle, length_)
    {
        TACTUS_ASSERT(box.half.x() >= 0.0);
        TACTUS_ASSERT(box.half.y() >= 0.0);
        TACTUS_ASSERT(box.half.z() >= 0.0);
    }

    ClosestPoints find() noexcept
    {
        double upper = kInfinity;
        std::array<double, 3> distance{};
        for (std::size_t i = 0; i < 3; ++i)
        {
            const Triple<double> gap = SegmentAndBox<double>(edge(i), box_).approach().gap;
            distance[i] = std::sqrt(dot(gap, gap));
            upper = std::min(upper, distance[i] + kFilterMargin * length_);
        }
        const Vec3 corner = corner_towards_face();
        if (face_.height_of(corner) - kFilterMargin * length_ <= upper)
        {
            decide_corner(corner);
        }
        for (std::size_t i = 0; i < 3; ++i)
        {
            if (distance[i] - kFilterMargin * length_ <= std::min(upper, best_.distance))
            {
                decide_edge(i);
            }
        }
        TACTUS_ASSERT(best_.distance < std::numeric_limits<double>::infinity());
        best_.distance_error = kernel_error(0.0, length_);
        return best_;
    }

    /// Where an edge meets the box; if none does, the face cuts through the box, and so through the
    /// diagonal to the corner on its side.
    ClosestPoints find_shared_point() noexcept
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            decide_edge(i);
        }
        if (!(best_.distance > kTouching * length_))
        {
            return meeting_at(best_.on_triangle, TriangleFeature::interior, best_.feature);
        }
        const Vec3 corner = corner_towards_face();
        const double height = face_.unit_normal().dot(corner);
        const double share = height == 0.0 ? 0.0 : face_.unit_normal().dot(triangle_[0]) / height;
        return meeting_at(corner * std::clamp(share, 0.0, 1.0), TriangleFeature::interior,
                          TriangleFeature::interior);
    }

private:
    [[nodiscard]] Segment edge(std::size_t i) const noexcept
    {
        return {triangle_[i], triangle_[(i + 1) % 3]};
    }

    /// The box's centre is the origin.
    [[nodiscard]] Vec3 corner_towards_face() const noexcept
    {
        const Vec3& normal = face_.unit_normal();
        return farthest_corner(box_, normal.dot(triangle_[0]) < 0.0 ? Vec3(-normal) : normal);
    }

    void decide_corner(const Vec3& corner) noexcept
    {
        if (const auto gap = approach_face<DoubleDouble>(corner, triangle_))
        {
            keep_if_nearer(to_triple<DoubleDouble>(corner) + *gap, *gap, TriangleFeature::interior);
        }
    }

    void decide_edge(std::size_t i) noexcept
    {
        const Segment segment = edge(i);
        const auto at = SegmentAndBox<DoubleDouble>(segment, box_).approach();
        keep_if_nearer(to_triple<DoubleDouble>(segment.from) +
                           at.parameter * difference<DoubleDouble>(segment.to, segment.from),
                       at.gap, feature_of_edge(i, to_double(at.parameter)));
    }

    /// Ties go to the first candidate.
    void keep_if_nearer(const Triple<DoubleDouble>& on_triangle, const Triple<DoubleDouble>& gap,
                        TriangleFeature feature) noexcept
    {
        const DoubleDouble distance_sq = dot(gap, gap);
        if (distance_sq < best_sq_)
        {
            best_sq_ = distance_sq;
            best_.on_triangle = to_vec3(on_triangle);
            best_.on_shape = to_vec3(on_triangle - gap);
            best_.gap = to_vec3(gap);
            best_.distance = std::sqrt(distance_sq.high);
            best_.feature = feature;
        }
    }

    const Box& box_;
    const Triangle& triangle_;
    double length_;
    FaceFilter face_;
    DoubleDouble best_sq_{kInfinity};
    ClosestPoints best_{.distance = kInfinity};
};

} // namespace

bool meet(const Box& box, const Triangle& triangle) noexcept
{
    return !is_beyond_a_side(box, triangle) && !is_on_one_side_of(triangle, box) &&
           !has_edge_between_along(0, box, triangle) && !has_edge_between_along(1, box, triangle) &&
           !has_edge_between_along(2, box, triangle);
}

ClosestPoints closest_points(const Box& box, const Triangle& triangle) noexcept
{
    return solve_in_range(std::array{box.half, triangle[0], triangle[1], triangle[2]},
                          [](const auto& points) noexcept
                          {
                              const Box near_box{points[0]};
                              const Triangle near{points[1], points[2], points[3]};
                              BoxDistance distance(near_box, near);
                              return meet(near_box, near) ? distance.find_shared_point()
                                                          : distance.find();
                          });
}

} // namespace tactus
