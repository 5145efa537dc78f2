// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/zone.hpp"

#include <algorithm>
#include <array>

namespace tactus
{

namespace
{

/// True if the direction separates the triangle from a box around the origin. The zero direction
/// separates nothing.
bool is_separated(const Triangle& triangle, const Vec3& half, const Vec3& direction)
{
    const double a = direction.dot(triangle[0]);
    const double b = direction.dot(triangle[1]);
    const double c = direction.dot(triangle[2]);
    const double reach = half.dot(direction.cwiseAbs());
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
}

bool touches_zone(const SphereZone& sphere, const Triangle& triangle)
{
    return closest_point_on_triangle(sphere.center_m, triangle).distance_sq <=
           sphere.radius_m * sphere.radius_m;
}

/// Two convex bodies are apart if and only if a normal of a face of either, or a direction across
/// an edge of each, separates them.
bool touches_zone(const BoxZone& box, const Triangle& triangle)
{
    const Vec3 half = 0.5 * (box.high_m - box.low_m);
    const Vec3 center = box.low_m + half;
    const Triangle here{triangle[0] - center, triangle[1] - center, triangle[2] - center};
    const std::array<Vec3, 3> edges{here[1] - here[0], here[2] - here[1], here[0] - here[2]};
    if (is_separated(here, half, edges[0].cross(edges[1])))
    {
        return false;
    }
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
        const Vec3 unit = Vec3::Unit(axis);
        if (is_separated(here, half, unit) ||
            std::any_of(edges.begin(), edges.end(),
                        [&](const Vec3& edge)
                        { return is_separated(here, half, unit.cross(edge)); }))
        {
            return false;
        }
    }
    return true;
}

Zone moved_zone(const SphereZone& sphere, const Vec3& origin_m, double margin_m)
{
    return SphereZone{sphere.center_m - origin_m, sphere.radius_m + margin_m};
}

Zone moved_zone(const BoxZone& box, const Vec3& origin_m, double margin_m)
{
    const Vec3 margin = Vec3::Constant(margin_m);
    return BoxZone{box.low_m - origin_m - margin, box.high_m - origin_m + margin};
}

} // namespace

Zone moved_and_grown(const Zone& zone, const Vec3& origin_m, double margin_m)
{
    return std::visit([&](const auto& one) { return moved_zone(one, origin_m, margin_m); }, zone);
}

bool touches(const Zone& zone, const Triangle& triangle)
{
    return std::visit([&](const auto& one) { return touches_zone(one, triangle); }, zone);
}

} // namespace tactus
