// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/similarity.hpp"

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Pose between two others at `share` of the motion; the rotation takes the short way round, at a
/// speed that is even to a twentieth up to 45 degrees.
[[nodiscard]] Similarity between(const Similarity& from, const Similarity& to,
                                 double share) noexcept TACTUS_NONBLOCKING;

/// Largest displacement of an object's points within a sphere of the world when the object moves
/// from one pose to another.
[[nodiscard]] double way_in_sphere_m(const Similarity& from, const Similarity& to,
                                     const Vec3& center_m,
                                     double radius_m) noexcept TACTUS_NONBLOCKING;

/// Speed limit of objects that a tool may touch: their motion changes a force no faster than
/// stiffness x speed.
struct ObjectSpeedLimit
{
    /// An object that lags by more than the limit allows in this time is rate-limited: forces of
    /// tools that it may touch must fade. Objects that may touch within this time are limited, too.
    static constexpr double kPatience_s = 0.02;

    double speed_max_m_per_s{kInfinity}; ///< Above 0.

    [[nodiscard]] double most_m(double since_s) const noexcept
    {
        return speed_max_m_per_s * since_s;
    }
    /// Distance by which tool and object may approach each other within kPatience_s.
    [[nodiscard]] double soon_m(double tool_speed_m_per_s) const noexcept
    {
        return kPatience_s * (tool_speed_m_per_s + speed_max_m_per_s);
    }
    /// True if points in reach would exceed the limit with a displacement of `way_m` within
    /// `since_s`.
    [[nodiscard]] bool is_too_fast(double way_m, double since_s) const noexcept
    {
        return way_m > most_m(since_s);
    }
    [[nodiscard]] bool exceeds_limit(double way_m, double since_s) const noexcept
    {
        return way_m > most_m(since_s + kPatience_s);
    }
    /// Limited pose: as far from `from` towards `to` as the object's points in reach may move
    /// within `since_s`; `way_to_m(place)` is their displacement to a pose. A rotation's
    /// displacement is not proportional to the share of the motion, so it is checked after each
    /// step.
    template <typename WayTo>
    [[nodiscard]] Similarity held(const Similarity& from, const Similarity& to, double since_s,
                                  const WayTo& way_to_m) const noexcept
    {
        constexpr int kRounds = 16;
        constexpr double kRounded = 1.0 + 1e-9;
        constexpr double kLess = 0.95; // Ends the loop for motions that are not proportional.
        Similarity place = to;
        double share = 1.0;
        for (int round = 0; round < kRounds; ++round)
        {
            const double way_m = way_to_m(place);
            if (!is_too_fast(way_m, since_s * kRounded))
            {
                return place;
            }
            share *= (round == 0 ? 1.0 : kLess) * most_m(since_s) / way_m;
            place = between(from, to, share);
        }
        return from;
    }
};

} // namespace tactus
