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
#include <array>
#include <cmath>
#include <optional>

namespace tactus
{

namespace
{

/// Distance, in local lengths, up to which an edge counts as meeting the box: the rounding of
/// double-double.
constexpr double kTouching = 1e-25;

Vec3 farthest_corner(const Box& box, const Vec3& direction) noexcept
{
    return {std::copysign(box.half.x(), direction.x()), std::copysign(box.half.y(), direction.y()),
            std::copysign(box.half.z(), direction.z())};
}

bool is_inside(const Box& box, const Vec3& point) noexcept
{
    return std::abs(point.x()) <= box.half.x() && std::abs(point.y()) <= box.half.y() &&
           std::abs(point.z()) <= box.half.z();
}

bool has_corner_inside(const Box& box, const Triangle& triangle) noexcept
{
    return is_inside(box, triangle[0]) || is_inside(box, triangle[1]) ||
           is_inside(box, triangle[2]);
}

/// Parameter of the middle of the segment's part in the box, if there is one; rounded.
double middle_inside(const Box& box, const Segment& segment) noexcept
{
    double low = 0.0;
    double high = 1.0;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
        const double way = segment.to[axis] - segment.from[axis];
        if (way != 0.0)
        {
            const double first = (-box.half[axis] - segment.from[axis]) / way;
            const double second = (box.half[axis] - segment.from[axis]) / way;
            low = std::max(low, std::min(first, second));
            high = std::min(high, std::max(first, second));
        }
    }
    return clamp_to_unit(0.5 * (low + high));
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

/// True if box and triangle, projected along `axis` to a rectangle and a triangle, are separated by
/// a line through one of the triangle's edges.
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

/// Vector from the box to a point that is not inside of it, each coordinate rounded once.
Vec3 gap_to(const Box& box, const Vec3& point) noexcept
{
    return {excess(point.x(), box.half.x()), excess(point.y(), box.half.y()),
            excess(point.z(), box.half.z())};
}

/// Search for the nearest points, by the distances of the triangle's edges from the box, and of a
/// corner of the box from the face.
class BoxDistance
{
public:
    BoxDistance(const Box& box, const Triangle& triangle) noexcept
        : box_(box), triangle_(triangle), length_(local_length(box, triangle))
    {
        TACTUS_ASSERT(box.half.x() >= 0.0);
        TACTUS_ASSERT(box.half.y() >= 0.0);
        TACTUS_ASSERT(box.half.z() >= 0.0);
    }

    ClosestPoints find() noexcept
    {
        const std::optional<std::size_t> over_side = find_corner_over_a_side();
        if (const auto nearest = over_side ? over_side : find_nearest_corner())
        {
            decide_triangle_corner(*nearest);
            return found();
        }
        if (meet(box_, triangle_))
        {
            return find_shared_point();
        }
        see_edges();
        double upper = kInfinity;
        for (const double distance : edge_distance_)
        {
            upper = std::min(upper, distance + kFilterMargin * length_);
        }
        const FaceFilter face(triangle_, length_);
        const Vec3 corner = corner_towards(face.unit_normal());
        if (face.height_of(corner) - kFilterMargin * length_ <= upper)
        {
            decide_corner(corner);
        }
        for (std::size_t i = 0; i < 3; ++i)
        {
            if (edge_distance_[i] - kFilterMargin * length_ <= std::min(upper, best_.distance))
            {
                decide_edge(i);
            }
        }
        return found();
    }

private:
    [[nodiscard]] Segment edge(std::size_t i) const noexcept
    {
        return {triangle_[i], triangle_[(i + 1) % 3]};
    }

    /// Corner of the box that is farthest along `normal`, towards the triangle; the box's centre is
    /// the origin.
    [[nodiscard]] Vec3 corner_towards(const Vec3& normal) const noexcept
    {
        return farthest_corner(box_, normal.dot(triangle_[0]) < 0.0 ? Vec3(-normal) : normal);
    }

    [[nodiscard]] const ClosestPoints& found() noexcept
    {
        TACTUS_ASSERT(best_.distance < kInfinity);
        best_.distance_error = kernel_error(0.0, length_);
        return best_;
    }

    /// Finds the first corner of the triangle that is over a side of the box with both other
    /// corners no nearer to that side, so that it is the nearest point. Decided exactly.
    [[nodiscard]] std::optional<std::size_t> find_corner_over_a_side() const noexcept
    {
        for (Eigen::Index axis = 0; axis < 3; ++axis)
        {
            const auto [a, b, c] =
                std::array{triangle_[0][axis], triangle_[1][axis], triangle_[2][axis]};
            const bool is_above = a > box_.half[axis];
            const double nearest = is_above ? std::min({a, b, c}) : std::max({a, b, c});
            if (!(std::abs(nearest) > box_.half[axis]) || (nearest > 0.0) != is_above)
            {
                continue;
            }
            for (std::size_t i = 0; i < 3; ++i)
            {
                Vec3 beside = triangle_[i];
                beside[axis] = 0.0;
                if (triangle_[i][axis] == nearest && is_inside(box_, beside))
                {
                    return i;
                }
            }
        }
        return std::nullopt;
    }

    /// Finds the triangle's corner nearest to the box, if proven: both others are farther along the
    /// vector from the box to it, by more than rounding.
    [[nodiscard]] std::optional<std::size_t> find_nearest_corner() const noexcept
    {
        constexpr double kLeastSq = 1e-200;
        std::size_t nearest = 0;
        Vec3 gap = gap_to(box_, triangle_[0]);
        for (std::size_t i = 1; i < 3; ++i)
        {
            const Vec3 other = gap_to(box_, triangle_[i]);
            nearest = other.squaredNorm() < gap.squaredNorm() ? i : nearest;
            gap = nearest == i ? other : gap;
        }
        const double rounding_sq = kFilterMargin * kFilterMargin * gap.squaredNorm();
        const auto is_beyond = [&](std::size_t i)
        {
            const Vec3 way = triangle_[i] - triangle_[nearest];
            const double along = gap.dot(way);
            return along > 0.0 && along * along > rounding_sq * way.squaredNorm();
        };
        return gap.squaredNorm() > kLeastSq && is_beyond((nearest + 1) % 3) &&
                       is_beyond((nearest + 2) % 3)
                   ? std::optional(nearest)
                   : std::nullopt;
    }

    void decide_triangle_corner(std::size_t i) noexcept
    {
        const auto corner = to_triple<DoubleDouble>(triangle_[i]);
        const auto half = to_triple<DoubleDouble>(box_.half);
        keep_if_nearer(
            corner, {excess(corner.x, half.x), excess(corner.y, half.y), excess(corner.z, half.z)},
            static_cast<TriangleFeature>(i));
    }

    /// Finds a shared point of the box and a triangle that has no corner in it: a point of an edge
    /// that meets the box. If no edge does, the face cuts the diagonal of the box towards its side.
    [[nodiscard]] ClosestPoints find_shared_point() noexcept
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const Segment segment = edge(i);
            const double parameter = middle_inside(box_, segment);
            if (const Vec3 point = point_at(segment, parameter); is_inside(box_, point))
            {
                return meeting_at(point, TriangleFeature::interior, feature_of_edge(i, parameter));
            }
        }
        see_edges();
        for (std::size_t i = 0; i < 3; ++i)
        {
            if (edge_distance_[i] <= kFilterMargin * length_)
            {
                decide_edge(i);
            }
        }
        if (!(best_.distance > kTouching * length_))
        {
            return meeting_at(best_.on_triangle, TriangleFeature::interior, best_.feature);
        }
        const Vec3 normal = FaceFilter(triangle_, length_).unit_normal();
        const Vec3 corner = corner_towards(normal);
        const double height = normal.dot(corner);
        const double share = height == 0.0 ? 0.0 : normal.dot(triangle_[0]) / height;
        return meeting_at(corner * std::clamp(share, 0.0, 1.0), TriangleFeature::interior,
                          TriangleFeature::interior);
    }

    /// Computes the distances of the edges from the box, in double.
    void see_edges() noexcept
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const BoxApproach<double> at = SegmentAndBox<double>(edge(i), box_).approach();
            edge_parameter_[i] = at.parameter;
            edge_distance_[i] = std::sqrt(dot(at.gap, at.gap));
        }
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
        const auto at =
            SegmentAndBox<DoubleDouble>(segment, box_).approach_near(edge_parameter_[i]);
        keep_if_nearer(to_triple<DoubleDouble>(segment.from) +
                           at.parameter * difference<DoubleDouble>(segment.to, segment.from),
                       at.gap, feature_of_edge(i, to_double(at.parameter)));
    }

    /// Keeps these points if they are nearer than the best so far; ties keep the earlier ones.
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
    std::array<double, 3> edge_parameter_{};
    std::array<double, 3> edge_distance_{};
    DoubleDouble best_sq_{kInfinity};
    ClosestPoints best_{.distance = kInfinity};
};

} // namespace

bool meet(const Box& box, const Triangle& triangle) noexcept
{
    return has_corner_inside(box, triangle) ||
           (!is_beyond_a_side(box, triangle) && !is_on_one_side_of(triangle, box) &&
            !has_edge_between_along(0, box, triangle) &&
            !has_edge_between_along(1, box, triangle) && !has_edge_between_along(2, box, triangle));
}

ClosestPoints closest_points(const Box& box, const Triangle& triangle) noexcept
{
    for (std::size_t i = 0; i < 3; ++i)
    {
        if (is_inside(box, triangle[i]))
        {
            return meeting_at(triangle[i], TriangleFeature::interior,
                              static_cast<TriangleFeature>(i));
        }
    }
    return solve_in_range(
        std::array{box.half, triangle[0], triangle[1], triangle[2]},
        [](const auto& points) noexcept {
            return BoxDistance(Box{points[0]}, {points[1], points[2], points[3]}).find();
        });
}

} // namespace tactus
