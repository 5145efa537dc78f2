// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/force_shading.hpp"

#include "rt_core/base/static_vector.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/triangle.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// Largest distance of a plane from the sphere's surface at which its face has a weight, as a share
/// of the width.
constexpr double kHighest = 0x1p-3;
/// Depth D at which half of a step at an edge remains, as a share of the width.
constexpr double kHalfDepth = 0x1p-4;
/// Weight added for unknown surface, where a near face as large as the width has a weight of 1.
constexpr double kUnknownWeight = 0.02;
/// Square of the least share of the width that must be known for a shading.
constexpr double kLeastWidth = 1e-4;
/// Cosines of the angles between a face and the touched surface up to which the face has its whole
/// weight (17 degrees), and from which it has none (25 degrees).
constexpr double kWholeCosine = 0.9563;
constexpr double kNoCosine = 0.9063;
/// Thinness below which a face is left out: square of twice its area over the fourth power of its
/// longest edge.
constexpr double kThinnest = 1e-20;
/// Largest tangent of the angle between the mean normal and the contact's normal.
constexpr double kSteepest = 0.5;

/// Value (1 - t)^2 of a weight at a share t of its range, and its derivative.
struct Bell
{
    double value{0.0};
    double slope{0.0};
};
Bell bell_of(double share) noexcept
{
    const double rest = std::max(0.0, 1.0 - share);
    return {rest * rest, -2.0 * rest};
}

/// Returns 0 below `from`, 1 above `to`, and between them a smooth step.
double smooth_step(double from, double to, double value) noexcept
{
    const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

} // namespace

/// If more than kMaxShadedFaces faces are near, the known range ends at the nearest one left out.
/// The faces are then much smaller than the width, and there is little to smooth.
ForceShading::ForceShading(double width_m, std::span<const PlacedSurface> surfaces,
                           double clear_m) noexcept
    : width_m_(width_m), known_m_(clear_m), surfaces_(surfaces)
{
    StaticVector<double, kMaxShadedFaces + 1> nearest;
    for (const PlacedSurface& placed : surfaces)
    {
        const LocalSurface& surface = *placed.surface;
        const double scale = placed.pose->scale;
        known_m_ = std::min(
            known_m_, std::max(surface.answer.certified_radius_m, surface.answer.lower_m) * scale);
        for (const double distance : surface.distances_m.first(surface.count))
        {
            const double distance_m = distance * scale;
            if (distance_m >= known_m_)
            {
                continue;
            }
            nearest.push_back(distance_m);
            std::ranges::push_heap(nearest);
            if (nearest.full())
            {
                std::ranges::pop_heap(nearest);
                known_m_ = nearest.pop_back();
            }
        }
    }
}

double ForceShading::reach_beyond_m(double radius_m, double width_m) noexcept
{
    return std::sqrt(radius_m * radius_m + width_m * width_m) - radius_m;
}

ForceShading::Felt ForceShading::at(const Place& place, double depth_m) const noexcept
{
    Felt felt;
    const double limit_m = kHalfDepth * width_m_;
    felt.raised_m = depth_m * depth_m / (depth_m + limit_m);
    felt.raise_m = felt.raised_m * place.normal;
    const double reach_m = std::min(place.radius_m + reach_beyond_m(place.radius_m, width_m_),
                                    known_m_ - place.moved_m);
    const double width_sq = reach_m * reach_m - place.radius_m * place.radius_m;
    if (!(reach_m > place.radius_m) || width_sq < kLeastWidth * width_m_ * width_m_)
    {
        return felt;
    }
    Sums all;
    for (const PlacedSurface& placed : surfaces_)
    {
        Sums sums;
        add(placed, place, reach_m, sums);
        all.weight += sums.weight;
        all.rise_m += sums.rise_m;
        all.normal += placed.pose->rotation * sums.normal;
        all.weight_slope += placed.pose->rotation * sums.weight_slope;
        all.sloping_rise += placed.pose->rotation * sums.sloping_rise;
        all.looks += sums.looks;
    }
    const double weight = all.weight + kUnknownWeight;
    const double rise_m = all.rise_m / weight;
    const Vec3 slope = (all.sloping_rise - all.normal - rise_m * all.weight_slope) / weight;
    Vec3 tilt = place.normal.dot(slope) * place.normal - slope;
    const double steepness = tilt.norm();
    tilt *= steepness > kSteepest ? kSteepest / steepness : 1.0;
    const double rest = 1.0 / (depth_m + limit_m);
    felt.raise_m += felt.raised_m * tilt;
    felt.push_m = std::max(-depth_m, depth_m * (depth_m + 2.0 * limit_m) * rest * rest * rise_m);
    felt.stiffening = 1.0 + 2.0 * std::abs(rise_m) / limit_m;
    felt.looks = all.looks;
    return felt;
}

/// Adds the faces of one object, in the object's frame but in metres of the world.
void ForceShading::add(const PlacedSurface& placed, const Place& place, double reach_m,
                       Sums& sums) const noexcept
{
    const LocalSurface& surface = *placed.surface;
    const double scale = placed.pose->scale;
    const Vec3 center = to_model(*placed.pose, place.center_m);
    const Vec3 normal = placed.pose->rotation.transpose() * place.normal;
    const double reach_sq = reach_m * reach_m;
    const double bell_sq = reach_sq - place.radius_m * place.radius_m;
    const double highest_m = kHighest * width_m_;
    for (std::uint32_t i = 0; i < surface.count; ++i)
    {
        if (surface.distances_m[i] * scale - place.moved_m >= reach_m)
        {
            continue;
        }
        ++sums.looks;
        const Triangle corners = to_triangle(surface.triangles[i].corners_m);
        const Vec3 edge = corners[1] - corners[0];
        const Vec3 other = corners[2] - corners[0];
        const Vec3 across = edge.cross(other);
        const double across_sq = across.squaredNorm();
        const double longest_sq = std::max(edge.squaredNorm(), other.squaredNorm());
        if (!(across_sq > kThinnest * longest_sq * longest_sq))
        {
            continue;
        }
        const double length = std::sqrt(across_sq);
        const double side = across.dot(normal) < 0.0 ? -1.0 : 1.0;
        const Vec3 up = side / length * across;
        const double facing = smooth_step(kNoCosine, kWholeCosine, up.dot(normal));
        const double rise_m = place.radius_m - scale * up.dot(center - corners[0]);
        if (!(facing > 0.0) || !(std::abs(rise_m) < highest_m))
        {
            continue;
        }
        SeenTriangle seen; // NOLINT(cppcoreguidelines-pro-type-member-init): the kernel fills it.
        placed.kernels->see_triangle(center.data(), corners[0].data(), seen);
        const ClosestPoint closest = closest_point_seen(center, corners, seen);
        const double distance_sq = closest.distance_sq * scale * scale;
        if (distance_sq >= reach_sq)
        {
            continue;
        }
        const double area = std::min(1.0, 0.5 * length * scale * scale / bell_sq);
        // Share of the reach: 0 at a touched face, 1 at the end of the reach.
        const double far = (distance_sq - place.radius_m * place.radius_m) / bell_sq;
        const Bell near = bell_of(far);
        const double share = rise_m / highest_m;
        const double fifth = share * share * share * share * share;
        const Bell flat = bell_of(fifth * share);
        const double weight = area * facing * near.value * flat.value;
        const Vec3 by_distance = near.slope * 2.0 * scale / bell_sq * -closest.gap;
        const Vec3 by_rise = flat.slope * 6.0 * fifth / highest_m * -up;
        const Vec3 weight_slope = area * facing * (flat.value * by_distance + near.value * by_rise);
        sums.weight += weight;
        sums.rise_m += weight * rise_m;
        sums.normal += weight * up;
        sums.weight_slope += weight_slope;
        sums.sloping_rise += rise_m * weight_slope;
    }
}

} // namespace tactus
