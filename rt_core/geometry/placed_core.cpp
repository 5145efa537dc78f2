// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/placed_core.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/box_triangle.hpp"
#include "rt_core/geometry/closest_features.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/math/rounding.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// Returns an orthonormal frame whose first axis is along `way`; any frame if `way` is zero.
Mat3 frame_along(const Vec3& way) noexcept
{
    const double length = way.norm();
    if (!(length > 0.0))
    {
        return Mat3::Identity();
    }
    const Vec3 first = way / length;
    // The second axis is perpendicular to the coordinate axis along which `way` is least.
    const Vec3 size(std::abs(first.x()), std::abs(first.y()), std::abs(first.z()));
    const int least = size.x() <= size.y() && size.x() <= size.z() ? 0
                      : size.y() <= size.z()                       ? 1
                                                                   : 2;
    Vec3 other(0.0, 0.0, 0.0);
    other[least] = 1.0;
    const Vec3 second = first.cross(other).normalized();
    Mat3 axes;
    axes.col(0) = first;
    axes.col(1) = second;
    axes.col(2) = first.cross(second);
    return axes;
}

/// Vector from a box with half extents `half` to a point, each coordinate rounded once.
Vec3 gap_from(const Vec3& half, const Vec3& point) noexcept
{
    return {excess(point.x(), half.x()), excess(point.y(), half.y()), excess(point.z(), half.z())};
}

/// Function object instead of a function, which would be called through a pointer.
constexpr auto squared_length = [](const Vec3& v) noexcept { return v.squaredNorm(); };

CornersAtCore::Row beyond_sq(const std::array<CornersAtCore::Row, 3>& place,
                             const Vec3& half) noexcept
{
    CornersAtCore::Row sum{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double end = half[static_cast<Eigen::Index>(axis)];
        for (std::size_t i = 0; i < sum.size(); ++i)
        {
            const double beyond = std::abs(place[axis][i]) - end;
            const double gap = 0.5 * (beyond + std::abs(beyond)); // max(beyond, 0) without a
                                                                  // branch.
            sum[i] += gap * gap;
        }
    }
    return sum;
}

/// Bound on the rounding of products with a rotation, relative to the largest coordinate.
constexpr double kRotationRounding = 4e-15;

} // namespace

PlacedCore::PlacedCore(const ToolCore& core, const Similarity& place) noexcept
    : center_(place.translation_m), axes_(place.rotation), scale_(place.scale)
{
    TACTUS_ASSERT(place.scale > 0.0);
    if (const auto* segment = std::get_if<Segment>(&core))
    {
        const Segment placed{place.local_to_world(segment->from),
                             place.local_to_world(segment->to)};
        const Vec3 half_way = 0.5 * (placed.to - placed.from);
        core_ = placed;
        center_ = placed.from + half_way;
        axes_ = frame_along(half_way);
        half_ = Vec3(half_way.norm(), 0.0, 0.0);
    }
    else if (const auto* box = std::get_if<Box>(&core))
    {
        half_ = place.scale * box->half;
        core_ = Box{half_};
    }
    else if (const auto* mesh = std::get_if<MeshCore>(&core))
    {
        center_ = place.local_to_world(mesh->origin_m + 0.5 * mesh->extent_m);
        half_ = 0.5 * place.scale * kRoundedUp * mesh->extent_m;
        core_ = Box{half_};
        is_mesh_ = true;
    }
    else if (const auto* hull = std::get_if<Hull>(&core))
    {
        core_ = *hull;
        surround(hull->body(), place);
    }
    else if (const auto* body = std::get_if<ConvexBody>(&core))
    {
        core_ = *body;
        surround(*body, place);
    }
    radius_ = half_.norm() * kRoundedUp;
    if (is_convex_body())
    {
        radius_ = std::min(radius_, body().radius);
    }
}

/// Sets the bounding box of a convex body, in the body's own axes and round its centre.
void PlacedCore::surround(const ConvexBody& body, const Similarity& place) noexcept
{
    center_ = place.local_to_world(body.center);
    for (int axis = 0; axis < 3; ++axis)
    {
        Vec3 along(0.0, 0.0, 0.0);
        along[axis] = 1.0;
        const double above = body.support(body.context, along)[axis];
        const double below = -body.support(body.context, -along)[axis];
        half_[axis] = place.scale * (std::max({above, below, 0.0}) + kSupportError * body.radius) *
                      kRoundedUp;
    }
}

/// The core in its own frame as a convex body.
ConvexBody PlacedCore::own_body() const noexcept
{
    TACTUS_ASSERT(is_convex_body());
    const auto* hull = std::get_if<Hull>(&core_);
    return hull != nullptr ? hull->body() : *std::get_if<ConvexBody>(&core_);
}

ConvexBody PlacedCore::body() const noexcept
{
    return {&placed_support, this, center_, own_body().radius * scale_ * kRoundedUp};
}

Vec3 PlacedCore::placed_support(const void* core, const Vec3& direction) noexcept
{
    const auto& placed = *static_cast<const PlacedCore*>(core);
    const ConvexBody own = placed.own_body();
    const Vec3 farthest = own.support(own.context, placed.axes_.transpose() * direction);
    return placed.scale_ * (placed.axes_ * farthest);
}

/// Computes whole rows, which the compiler vectorises.
CornersAtCore::Row heights_along(const Vec3& axis, const std::array<CornerRow, 3>& corners,
                                 const Vec3& center) noexcept
{
    CornersAtCore::Row heights{};
    for (std::size_t i = 0; i < 3; ++i)
    {
        const CornerRow& row = corners[i];
        const double share = axis[static_cast<Eigen::Index>(i)];
        const double middle = center[static_cast<Eigen::Index>(i)];
        for (std::size_t k = 0; k < row.size(); ++k)
        {
            heights[k] += share * (static_cast<double>(row[k]) - middle);
        }
    }
    return heights;
}

/// Error of the middle of two bounds, as a share of the upper one: two roundings.
constexpr double kMiddleRounding = 2.5e-16;

ClosestPoints to_closest_points(const GjkAnswer& answer) noexcept
{
    ClosestPoints result;
    result.on_shape = answer.on_body;
    result.on_triangle = answer.on_triangle;
    result.gap = answer.gap;
    result.distance = 0.5 * (answer.lower + answer.upper);
    result.distance_error = 0.5 * (answer.upper - answer.lower) + kMiddleRounding * answer.upper;
    result.meet = answer.upper <= 2.0 * answer.rounding && !(answer.lower > 0.0);
    result.feature = answer.feature;
    return result;
}

ClosestPoints PlacedCore::closest(const Triangle& triangle) const noexcept
{
    TACTUS_ASSERT(!is_mesh());
    if (const auto* segment = std::get_if<Segment>(&core_))
    {
        return closest_points(*segment, triangle);
    }
    if (std::holds_alternative<Box>(core_))
    {
        return closest_to_box(triangle);
    }
    if (is_convex_body())
    {
        Vec3 direction(0.0, 0.0, 0.0);
        return to_closest_points(gjk_distance(body(), triangle, direction));
    }
    const ClosestPoint nearest = closest_point_on_triangle(center_, triangle);
    ClosestPoints result;
    result.on_shape = center_;
    result.on_triangle = nearest.point;
    result.gap = nearest.gap;
    result.distance = std::sqrt(nearest.distance_sq);
    result.distance_error = nearest.distance_error;
    result.meet = nearest.distance_sq == 0.0;
    result.feature = nearest.feature;
    return result;
}

ClosestPoints PlacedCore::closest_to_box(const Triangle& triangle) const noexcept
{
    const Triangle near = to_box_frame(triangle);
    ClosestPoints result = closest_points(Box{half_}, near);
    result.on_shape = center_ + axes_ * result.on_shape;
    result.on_triangle = center_ + axes_ * result.on_triangle;
    result.gap = axes_ * result.gap;
    // The result holds for the rotated triangle, so that triangle's rounding is added.
    result.distance_error += rounding_of(near);
    return result;
}

Triangle PlacedCore::to_box_frame(const Triangle& triangle) const noexcept
{
    return {axes_.transpose() * (triangle[0] - center_),
            axes_.transpose() * (triangle[1] - center_),
            axes_.transpose() * (triangle[2] - center_)};
}

double PlacedCore::rounding_of(const Triangle& in_box_frame) const noexcept
{
    return kRotationRounding * (largest_coordinate(in_box_frame) + half_.norm());
}

CoreBounds PlacedCore::bounds(const Triangle& triangle) const noexcept
{
    const Triangle near = to_box_frame(triangle);
    return bounds(near,
                  {gap_from(half_, near[0]).squaredNorm(), gap_from(half_, near[1]).squaredNorm(),
                   gap_from(half_, near[2]).squaredNorm()},
                  kInfinity);
}

void PlacedCore::measure_corners(const std::array<CornerRow, 3>& corners,
                                 CornersAtCore& seen) const noexcept
{
    for (std::size_t i = 0; i < 3; ++i)
    {
        seen.place[i] = heights_along(axes_.col(static_cast<Eigen::Index>(i)), corners, center_);
    }
    seen.beyond_sq = beyond_sq(seen.place, half_);
}

CoreBounds PlacedCore::bounds(const CornersAtCore& seen,
                              const std::array<std::uint8_t, 3>& triangle,
                              double limit) const noexcept
{
    const auto corner = [&seen](std::size_t i)
    { return Vec3(seen.place[0][i], seen.place[1][i], seen.place[2][i]); };
    const auto [a, b, c] = triangle;
    return bounds({corner(a), corner(b), corner(c)},
                  {seen.beyond_sq[a], seen.beyond_sq[b], seen.beyond_sq[c]}, limit);
}

/// Bounds the distance by separating planes: across each axis of the box, and across the vector
/// from the box to the nearest corner. The box is on one side of such a plane, and the triangle at
/// least as far as its nearest corner along it.
CoreBounds PlacedCore::bounds(const Triangle& near, const std::array<double, 3>& beyond_sq,
                              double limit) const noexcept
{
    const double farthest = std::sqrt(std::max({beyond_sq[0], beyond_sq[1], beyond_sq[2]}));
    const double rounding = 2.0 * kRotationRounding * (farthest + 2.0 * half_.norm());
    double apart_sq = 0.0;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
        const double low = std::min({near[0][axis], near[1][axis], near[2][axis]});
        const double high = std::max({near[0][axis], near[1][axis], near[2][axis]});
        const double gap = std::max(std::max(low, -high) - half_[axis], 0.0);
        apart_sq += gap * gap;
    }
    CoreBounds found;
    found.lower = std::sqrt(apart_sq) - rounding;
    if (found.lower > limit)
    {
        return found;
    }
    const auto* const nearest = std::ranges::min_element(beyond_sq);
    const Vec3 way = gap_from(half_, near[static_cast<std::size_t>(nearest - beyond_sq.begin())]);
    const double upper = std::sqrt(*nearest);
    if (upper > 0.0)
    {
        found.lower = std::max(found.lower, apart_along(way, near) / upper - rounding);
    }
    found.upper = is_convex_body() ? kInfinity : upper + rounding;
    found.meet = way == Vec3(0.0, 0.0, 0.0) && std::holds_alternative<Box>(core_);
    return found;
}

/// Separation of triangle and box along `way`, times the length of `way`.
double PlacedCore::apart_along(const Vec3& way, const Triangle& near) const noexcept
{
    return std::min({way.dot(near[0]), way.dot(near[1]), way.dot(near[2])}) -
           way.cwiseAbs().dot(half_);
}

CoreSeparation PlacedCore::separation(const Triangle& triangle) const noexcept
{
    const Triangle near = to_box_frame(triangle);
    const std::array<Vec3, 3> ways{gap_from(half_, near[0]), gap_from(half_, near[1]),
                                   gap_from(half_, near[2])};
    const Vec3& way = *std::ranges::min_element(ways, {}, squared_length);
    const double length = way.norm();
    return length > 0.0 ? CoreSeparation{axes_ * (-way / length),
                                         apart_along(way, near) / length - 2.0 * rounding_of(near)}
                        : CoreSeparation{};
}

CoreCover PlacedCore::cover(double enough) const noexcept
{
    std::array<int, 3> count{1, 1, 1};
    Vec3 cell = half_;
    while (count[0] * count[1] * count[2] * 2 <= static_cast<int>(kMaxCoverSpheres) &&
           cell.norm() > enough)
    {
        const int longest = cell.x() >= cell.y() && cell.x() >= cell.z() ? 0
                            : cell.y() >= cell.z()                       ? 1
                                                                         : 2;
        count[static_cast<std::size_t>(longest)] *= 2;
        cell[longest] *= 0.5;
    }
    CoreCover spheres;
    for (int x = 0; x < count[0]; ++x)
    {
        for (int y = 0; y < count[1]; ++y)
        {
            for (int z = 0; z < count[2]; ++z)
            {
                const Vec3 at(2 * x + 1 - count[0], 2 * y + 1 - count[1], 2 * z + 1 - count[2]);
                spheres.push_back(
                    {center_ + axes_ * at.cwiseProduct(cell), cell.norm() * kRoundedUp});
            }
        }
    }
    return spheres;
}

CoreCorners PlacedCore::corners() const noexcept
{
    CoreCorners corners;
    if (const auto* segment = std::get_if<Segment>(&core_))
    {
        corners.push_back(segment->from);
        corners.push_back(segment->to);
    }
    else if (std::holds_alternative<Box>(core_) && !is_mesh_)
    {
        for (const double x : {-half_.x(), half_.x()})
        {
            for (const double y : {-half_.y(), half_.y()})
            {
                corners.push_back(center_ + axes_ * Vec3(x, y, -half_.z()));
                corners.push_back(center_ + axes_ * Vec3(x, y, half_.z()));
            }
        }
    }
    else if (const auto* hull = std::get_if<Hull>(&core_))
    {
        const Vec3 middle = hull->body().center;
        for (const Vec3& vertex : hull->vertices())
        {
            corners.push_back(center_ + scale_ * (axes_ * (vertex - middle)));
        }
    }
    return corners;
}

double PlacedCore::motion_since(const PlacedCore& before) const noexcept
{
    // A point of the box is the centre plus a constant share of each half axis, so the motions of
    // these add up.
    double motion = (center_ - before.center_).norm();
    for (int axis = 0; axis < 3; ++axis)
    {
        motion +=
            (half_[axis] * axes_.col(axis) - before.half_[axis] * before.axes_.col(axis)).norm();
    }
    return motion * kWidened;
}

} // namespace tactus
