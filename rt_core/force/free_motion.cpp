// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/free_motion.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Largest share of a proven distance that a motion may use, and share of the radius that it leaves
/// as room to come back.
constexpr double kMostOfDistance = 0.9;
constexpr double kKeptOfRadius = 0.5;
/// Distance, as a share of the radius, below which free motion is scarce.
constexpr double kScarce = 0.1;
/// Distance of a slab, as a share of the core's radius, below which its direction is not trusted.
constexpr double kLeastSlab = 1e-5;

/// Part of an exact distance that a motion may use. The less distance is left, the smaller the
/// share used: the distance of a wedged tool shrinks like one over the number of frames and never
/// reaches zero.
double free_of(double distance_m, double radius_m) noexcept
{
    const double scarcity = std::min(1.0, distance_m / (kScarce * radius_m));
    const double beyond_m = std::max(distance_m - kKeptOfRadius * radius_m,
                                     (1.0 - kKeptOfRadius) * scarcity * distance_m);
    return std::min(beyond_m, kMostOfDistance * distance_m);
}

double share_within(double length_m, double free_m) noexcept
{
    return length_m > free_m ? std::max(0.0, free_m) / length_m : 1.0;
}

} // namespace

FreeMotion::FreeMotion(std::span<const PlacedSurface> surfaces, double clear_m,
                       double radius_m) noexcept
    : surfaces_(surfaces)
    , radius_m_(radius_m)
    , elsewhere_m_(std::min(clear_m - radius_m, kMostOfDistance * clear_m))
    , free_m_(elsewhere_m_)
    , is_clear_(clear_m > 0.0)
{
    for (const PlacedSurface& placed : surfaces)
    {
        const bool is_near_known = is_known(placed.surface->answer.kind);
        free_m_ = std::min(free_m_, free_of(placed));
        is_clear_ = is_clear_ && placed.lower_m > 0.0;
        is_crossed_ = is_crossed_ || (is_near_known && !(placed.lower_m > 0.0));
        is_scarce_ = is_scarce_ || (is_near_known && placed.lower_m < kScarce * radius_m);
    }
}

double FreeMotion::free_of(const PlacedSurface& placed) const noexcept
{
    const double lower_m = placed.lower_m;
    return is_known(placed.surface->answer.kind)
               ? tactus::free_of(lower_m, radius_m_)
               : std::min(lower_m - radius_m_, kMostOfDistance * lower_m);
}

double FreeMotion::share_of(const RigidWay& way) const noexcept
{
    double share = share_within(way.length_m(), elsewhere_m_);
    for (const PlacedSurface& placed : surfaces_)
    {
        share = std::min(share, share_of(way, placed));
    }
    return share;
}

double FreeMotion::share_of(const RigidWay& way, const PlacedSurface& placed) const noexcept
{
    const double by_length = share_within(way.length_m(), free_of(placed));
    const DistanceAnswer& answer = placed.surface->answer;
    const TouchReport& touches = *placed.touches;
    if (by_length == 1.0 || !is_known(answer.kind))
    {
        return by_length;
    }
    const double known_m =
        std::min(touches.covered_m, answer.certified_radius_m * placed.pose->scale);
    // Slab distances lack the rounding of the transforms and the errors that are already subtracted
    // from lower_m.
    const double off_m = std::max(0.0, answer.lower_m * placed.pose->scale - placed.lower_m) +
                         answer.tolerated_m * placed.pose->scale;
    const double turn_m = way.rotation_rad.norm() * way.core_radius_m;
    double share =
        std::min(share_within(turn_m, free_of(placed)),
                 share_within(way.length_m(), tactus::free_of(known_m - off_m, radius_m_)));
    for (const ContactSlab& slab : touches.slabs)
    {
        const double distance_m = slab.distance_m - off_m;
        if (distance_m < kLeastSlab * way.core_radius_m)
        {
            return by_length;
        }
        share = std::min(share, share_within(way.approach_m(slab.normal, slab.spread),
                                             tactus::free_of(distance_m, radius_m_)));
    }
    return std::max(share, by_length);
}

} // namespace tactus
