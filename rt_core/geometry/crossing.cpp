// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/crossing.hpp"

#include "rt_core/math/orientation.hpp"

#include <algorithm>
#include <span>

namespace tactus
{

// Two closed triangles meet exactly if an edge of one meets the other, even if one is a segment or
// a point. This reduces each test to a segment p q and a triangle, and that to fewer dimensions:
//
//   p, q not both in the plane   the line p q pierces it once; inside or not: three volumes
//   both in the plane            seen along an axis that keeps the triangle's area: in the plane,
//                                p in the triangle, or p q meets an edge
//   the triangle has no area     p q meets one of its edges; in space two segments meet only if
//                                they lie in one plane, and then the same along an axis; and if
//                                all four ends are on one line, if their boxes overlap.

namespace
{

std::array<int, 3> sides_of_plane(const Triangle& face, const Triangle& points) noexcept
{
    const PlaneSides plane(face[0], face[1], face[2]);
    return {plane.side_of(points[0]), plane.side_of(points[1]), plane.side_of(points[2])};
}

bool are_all_on_one_side(const std::array<int, 3>& sides) noexcept
{
    return sides[0] != 0 && sides[0] == sides[1] && sides[0] == sides[2];
}

/// True if the sides are not of both signs; zeros count as either sign.
bool do_not_differ(const std::array<int, 3>& sides) noexcept
{
    const auto [least, most] = std::minmax({sides[0], sides[1], sides[2]});
    return least * most >= 0;
}

bool do_boxes_overlap(std::span<const Vec3> first, std::span<const Vec3> second) noexcept
{
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
        const auto extent = [axis](std::span<const Vec3> points)
        {
            std::array<double, 2> ends{points[0][axis], points[0][axis]};
            for (const Vec3& point : points.subspan(1))
            {
                ends = {std::min(ends[0], point[axis]), std::max(ends[1], point[axis])};
            }
            return ends;
        };
        const auto [low, high] = extent(first);
        const auto [other_low, other_high] = extent(second);
        if (high < other_low || other_high < low)
        {
            return false;
        }
    }
    return true;
}

/// Sides of the ends of two segments, each relative to the line of the other segment.
struct SegmentSides
{
    std::array<int, 2> of_second;
    std::array<int, 2> of_first;

    [[nodiscard]] bool are_all_zero() const noexcept
    {
        return of_second[0] == 0 && of_second[1] == 0 && of_first[0] == 0 && of_first[1] == 0;
    }
    [[nodiscard]] bool cross() const noexcept
    {
        return of_second[0] * of_second[1] <= 0 && of_first[0] * of_first[1] <= 0;
    }
};

SegmentSides see_along(std::size_t axis, const Segment& first, const Segment& second) noexcept
{
    const Vec2 p = seen_along(axis, first.from);
    const Vec2 q = seen_along(axis, first.to);
    const Vec2 a = seen_along(axis, second.from);
    const Vec2 b = seen_along(axis, second.to);
    return {{side_of_line(p, q, a), side_of_line(p, q, b)},
            {side_of_line(a, b, p), side_of_line(a, b, q)}};
}

/// True if two segments in one plane meet. `axis` is one along which areas in that plane stay; any
/// axis if all ends are on one line.
bool do_segments_meet_along(std::size_t axis, const Segment& first, const Segment& second) noexcept
{
    const SegmentSides sides = see_along(axis, first, second);
    return sides.are_all_zero() ? do_boxes_overlap(std::array{first.from, first.to},
                                                   std::array{second.from, second.to})
                                : sides.cross();
}

bool do_segments_meet(const Segment& first, const Segment& second) noexcept
{
    if (side_of_plane(first.from, first.to, second.from, second.to) != 0)
    {
        return false;
    }
    std::size_t axis = 0;
    while (axis < 2 && see_along(axis, first, second).are_all_zero())
    {
        ++axis;
    }
    return do_segments_meet_along(axis, first, second);
}

template <typename SegmentsMeet>
bool meets_an_edge(const Segment& segment, const Triangle& triangle,
                   SegmentsMeet segments_meet) noexcept
{
    return segments_meet(segment, Segment{triangle[0], triangle[1]}) ||
           segments_meet(segment, Segment{triangle[1], triangle[2]}) ||
           segments_meet(segment, Segment{triangle[2], triangle[0]});
}

/// True if the point is in the triangle; both are projected along an axis that keeps the triangle's
/// area.
bool is_inside_along(std::size_t axis, const Vec3& point, const Triangle& triangle) noexcept
{
    const Vec2 p = seen_along(axis, point);
    const std::array<Vec2, 3> corner{seen_along(axis, triangle[0]), seen_along(axis, triangle[1]),
                                     seen_along(axis, triangle[2])};
    return do_not_differ({side_of_line(corner[0], corner[1], p),
                          side_of_line(corner[1], corner[2], p),
                          side_of_line(corner[2], corner[0], p)});
}

bool meet_in_plane(const Segment& segment, const Triangle& triangle) noexcept
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        if (area_sign_along(axis, triangle) != 0)
        {
            return is_inside_along(axis, segment.from, triangle) ||
                   meets_an_edge(segment, triangle,
                                 [axis](const Segment& a, const Segment& b)
                                 { return do_segments_meet_along(axis, a, b); });
        }
    }
    return meets_an_edge(segment, triangle,
                         [](const Segment& a, const Segment& b) { return do_segments_meet(a, b); });
}

/// `from` and `to`: sides of the triangle's plane on which the ends lie.
bool meets_from_sides(const Segment& segment, int from, int to, const Triangle& triangle) noexcept
{
    if (from * to > 0)
    {
        return false;
    }
    return from == 0 && to == 0 ? meet_in_plane(segment, triangle)
                                : do_not_differ(sides_of_edges(segment.from, segment.to, triangle));
}

/// True if an edge of `triangle` meets `other`. `sides` are the sides of the plane of `other` on
/// which the triangle's corners lie.
bool does_an_edge_meet(const Triangle& triangle, const std::array<int, 3>& sides,
                       const Triangle& other) noexcept
{
    for (std::size_t i = 0; i < 3; ++i)
    {
        const std::size_t next = (i + 1) % 3;
        if (meets_from_sides({triangle[i], triangle[next]}, sides[i], sides[next], other))
        {
            return true;
        }
    }
    return false;
}

/// Feature of the triangle that holds a point in it; an edge with a side of 0 holds the point.
TriangleFeature feature_of_zeros(const std::array<int, 3>& sides) noexcept
{
    for (std::size_t i = 0; i < 3; ++i)
    {
        if (sides[i] == 0)
        {
            // Corner i is on edges i - 1 and i.
            return sides[(i + 1) % 3] == 0   ? static_cast<TriangleFeature>((i + 1) % 3)
                   : sides[(i + 2) % 3] == 0 ? static_cast<TriangleFeature>(i)
                                             : static_cast<TriangleFeature>(3 + i);
        }
    }
    return TriangleFeature::interior;
}

/// `from` and `to`: sides of the triangle's plane on which the ends lie.
std::optional<Piercing> find_piercing_from_sides(const Segment& segment, int from, int to,
                                                 const Triangle& triangle) noexcept
{
    if (from * to > 0 || (from == 0 && to == 0))
    {
        return std::nullopt;
    }
    const std::array<int, 3> sides = sides_of_edges(segment.from, segment.to, triangle);
    if (!do_not_differ(sides))
    {
        return std::nullopt;
    }
    const PlaneVolumes plane(triangle[0], triangle[1], triangle[2]);
    const double from_volume = plane.volume(segment.from);
    const double to_volume = plane.volume(segment.to);
    // Both volumes may vanish for coordinates out of range.
    const double share = from_volume == to_volume ? 0.0 : from_volume / (from_volume - to_volume);
    return Piercing{share, feature_of_zeros(sides)};
}

/// Finds the first edge of `triangle` that pierces `other`.
std::optional<EdgePiercing> find_piercing_edge(const Triangle& triangle,
                                               const Triangle& other) noexcept
{
    const std::array<int, 3> sides = sides_of_plane(other, triangle);
    for (std::size_t i = 0; i < 3; ++i)
    {
        const std::size_t next = (i + 1) % 3;
        if (const auto piercing = find_piercing_from_sides({triangle[i], triangle[next]}, sides[i],
                                                           sides[next], other))
        {
            return EdgePiercing{&triangle, i, *piercing};
        }
    }
    return std::nullopt;
}

} // namespace

bool meet(const Segment& segment, const Triangle& triangle) noexcept
{
    if (!do_boxes_overlap(std::array{segment.from, segment.to}, triangle))
    {
        return false;
    }
    const PlaneSides plane(triangle[0], triangle[1], triangle[2]);
    return meets_from_sides(segment, plane.side_of(segment.from), plane.side_of(segment.to),
                            triangle);
}

bool meet(const Triangle& first, const Triangle& second) noexcept
{
    if (!do_boxes_overlap(first, second))
    {
        return false;
    }
    const std::array<int, 3> first_sides = sides_of_plane(second, first);
    if (are_all_on_one_side(first_sides))
    {
        return false;
    }
    const std::array<int, 3> second_sides = sides_of_plane(first, second);
    return !are_all_on_one_side(second_sides) && (does_an_edge_meet(first, first_sides, second) ||
                                                  does_an_edge_meet(second, second_sides, first));
}

std::optional<Piercing> find_piercing(const Segment& segment, const Triangle& triangle) noexcept
{
    const PlaneSides plane(triangle[0], triangle[1], triangle[2]);
    return find_piercing_from_sides(segment, plane.side_of(segment.from), plane.side_of(segment.to),
                                    triangle);
}

std::optional<EdgePiercing> find_edge_piercing(const Triangle& first,
                                               const Triangle& second) noexcept
{
    const auto of_first = find_piercing_edge(first, second);
    return of_first ? of_first : find_piercing_edge(second, first);
}

} // namespace tactus
