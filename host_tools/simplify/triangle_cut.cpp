// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/triangle_cut.hpp"

#include "host_tools/mesh/mesh_places.hpp"

#include <cstddef>

namespace tactus
{

namespace
{

struct PartCorner
{
    TrianglePoint at;
    std::uint32_t point{0};
};

/// Part of a triangle on one side of a cut, with three or four corners.
using Polygon = StaticVector<PartCorner, 4>;

std::uint32_t between(std::uint32_t from, std::uint32_t to, double t) noexcept
{
    const double start = from;
    return static_cast<std::uint32_t>(start + t * (static_cast<double>(to) - start) + 0.5);
}

TrianglePoint between(const TrianglePoint& from, const TrianglePoint& to, double t) noexcept
{
    return {between(from.x, to.x, t), between(from.y, to.y, t)};
}

void append_fan(const Polygon& polygon, std::uint32_t generation, CutParts& parts)
{
    for (std::size_t i = 2; i < polygon.size(); ++i)
    {
        const PartCorner& a = polygon[0];
        const PartCorner& b = polygon[i - 1];
        const PartCorner& c = polygon[i];
        parts.push_back({{a.at, b.at, c.at}, {a.point, b.point, c.point}, generation});
    }
}

} // namespace

Vec3 TriangleFrame::point(const TrianglePoint& at) const noexcept
{
    constexpr double kUnit = 1.0 / TrianglePoint::kOne;
    return origin + (at.x * kUnit) * side_x + (at.y * kUnit) * side_y;
}

double TriangleFrame::rounding() const noexcept
{
    return (side_x.norm() + side_y.norm()) / TrianglePoint::kOne;
}

TriangleFrame frame_of(const QuantisedMesh& mesh, std::uint32_t triangle) noexcept
{
    const auto& corners = mesh.faces[triangle];
    const Vec3 origin = grid_point(mesh, corners[0]);
    return {origin, grid_point(mesh, corners[1]) - origin, grid_point(mesh, corners[2]) - origin};
}

CutParts cut(const Part& part, const TriangleFrame& frame, const CutPlane& plane,
             PointColumns& points)
{
    std::array<double, 3> height{};
    bool above = false;
    bool below = false;
    for (std::size_t i = 0; i < 3; ++i)
    {
        height[i] = plane.normal.dot(points[part.points[i]] - plane.start);
        above = above || height[i] > 0;
        below = below || height[i] < 0;
    }
    if (!above || !below)
    {
        return {};
    }
    bool on_half_plane = false;
    const auto note_crossing = [&](const Vec3& point)
    { on_half_plane = on_half_plane || plane.along.dot(point - plane.start) > 0; };
    const std::size_t points_before = points.size();
    Polygon upper;
    Polygon lower;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const std::size_t j = (i + 1) % 3;
        const PartCorner corner{part.at[i], part.points[i]};
        if (height[i] >= 0)
        {
            upper.push_back(corner);
        }
        if (height[i] <= 0)
        {
            lower.push_back(corner);
        }
        if (height[i] == 0)
        {
            note_crossing(points[corner.point]);
        }
        if ((height[i] > 0 && height[j] < 0) || (height[i] < 0 && height[j] > 0))
        {
            const double t = height[i] / (height[i] - height[j]);
            const TrianglePoint at = between(part.at[i], part.at[j], t);
            const PartCorner crossing{at, static_cast<std::uint32_t>(points.size())};
            points.push_back(frame.point(at));
            note_crossing(points[crossing.point]);
            upper.push_back(crossing);
            lower.push_back(crossing);
        }
    }
    CutParts parts;
    if (on_half_plane)
    {
        append_fan(upper, part.generation + 1, parts);
        append_fan(lower, part.generation + 1, parts);
    }
    else
    {
        points.truncate(points_before);
    }
    return parts;
}

} // namespace tactus
