// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/landing_sites.hpp"

#include "platform/devices/simulated/motion_maths.hpp"

#include <algorithm>
#include <array>

namespace tactus
{

namespace
{

/// Clearances in diagonals: height of the gate above the extreme plane, and radius of the orbit
/// around the box.
constexpr double kGateHeightDiag = 0.06;
constexpr double kOrbitRadiusDiag = 0.55;
constexpr double kInwardDiag = 0.05;

struct Bounds
{
    Vec3 low;
    Vec3 high;
};

Bounds bounds_of(std::span<const Vec3> points) noexcept
{
    Bounds bounds{points.front(), points.front()};
    for (const Vec3& point : points)
    {
        bounds.low = bounds.low.cwiseMin(point);
        bounds.high = bounds.high.cwiseMax(point);
    }
    return bounds;
}

/// Axis numbers, the shortest extent first; equal ones keep their order.
std::array<int, 3> axes_by_extent(const Bounds& bounds) noexcept
{
    const Vec3 extent = bounds.high - bounds.low;
    std::array<int, 3> axes{0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return extent[a] < extent[b]; });
    return axes;
}

/// First of the farthest anchors along `direction`.
Vec3 extreme_anchor(std::span<const Vec3> anchors, const Vec3& direction) noexcept
{
    return *std::max_element(anchors.begin(), anchors.end(),
                             [&](const Vec3& a, const Vec3& b)
                             { return a.dot(direction) < b.dot(direction); });
}

/// Step from the anchor towards the centre, within the plane perpendicular to `direction`. Its
/// length is `length_m`, at most half of the distance.
Vec3 inward_step(const Vec3& anchor, const Vec3& centre, const Vec3& direction, double length_m)
{
    const Vec3 across = part_across(centre - anchor, direction);
    const double distance_m = across.norm();
    return distance_m > 0.0 ? Vec3(across * (std::min(length_m, distance_m / 2) / distance_m))
                            : Vec3(Vec3::Zero());
}

} // namespace

Vec3 centre_of(std::span<const Vec3> anchors_world_m) noexcept
{
    const Bounds bounds = bounds_of(anchors_world_m);
    return (bounds.low + bounds.high) / 2.0;
}

std::vector<LandingSite> find_landing_sites(std::span<const Vec3> anchors_world_m,
                                            double diagonal_m, double tool_radius_m,
                                            std::size_t turned)
{
    const Bounds bounds = bounds_of(anchors_world_m);
    const Vec3 centre = centre_of(anchors_world_m);
    std::vector<LandingSite> sites;
    const auto add_site = [&](const Vec3& aim, const Vec3& direction, const Vec3& shift)
    {
        const double height_m = tool_radius_m + kGateHeightDiag * diagonal_m;
        const Vec3 from_centre = aim + shift + direction * height_m - centre;
        const double orbit_m =
            std::max(kOrbitRadiusDiag * diagonal_m + 2.0 * tool_radius_m, from_centre.norm());
        sites.push_back({aim + shift, centre + from_centre.normalized() * orbit_m, orbit_m});
    };
    for (const int axis : axes_by_extent(bounds))
    {
        for (const double sign : {1.0, -1.0})
        {
            const Vec3 direction = Vec3::Unit(axis) * sign;
            const Vec3 anchor = extreme_anchor(anchors_world_m, direction);
            add_site(anchor, direction,
                     inward_step(anchor, centre, direction, kInwardDiag * diagonal_m));
            add_site(anchor, direction, Vec3::Zero());
        }
    }
    const auto first = static_cast<std::ptrdiff_t>(2 * turned % sites.size());
    std::rotate(sites.begin(), sites.begin() + first, sites.end());
    return sites;
}

} // namespace tactus
