// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/similarity.hpp"

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Part of the way from one place to another; the rotation by the short way round, at a speed that
/// is even to a twentieth up to 45 degrees.
[[nodiscard]] Similarity between(const Similarity& from, const Similarity& to,
                                 double share) noexcept TACTUS_NONBLOCKING;

/// How far an object that goes from one place to another moves any of its points in a ball of the
/// world, at most.
[[nodiscard]] double way_in_ball_m(const Similarity& from, const Similarity& to,
                                   const Vec3& center_m,
                                   double radius_m) noexcept TACTUS_NONBLOCKING;

/// How fast an object that a tool may touch is believed to move at most: a force
/// can't change faster by that than by stiffness x speed.
struct BelievedSpeed
{
    /// An object that is behind by more than it may go in this time outruns its belief: the force
    /// of what it may touch has to go. What may touch within this time is limited, too.
    static constexpr double kPatience_s = 0.02;

    double speed_max_m_per_s{kInfinity}; ///< Above 0.

    [[nodiscard]] double most_m(double since_s) const noexcept
    {
        return speed_max_m_per_s * since_s;
    }
    /// How far tool and object may come towards each other before they may touch unforeseen.
    [[nodiscard]] double soon_m(double tool_speed_m_per_s) const noexcept
    {
        return kPatience_s * (tool_speed_m_per_s + speed_max_m_per_s);
    }
    /// Of a way that its points in reach would go within `since_s`.
    [[nodiscard]] bool is_too_fast(double way_m, double since_s) const noexcept
    {
        return way_m > most_m(since_s);
    }
    [[nodiscard]] bool outruns(double way_m, double since_s) const noexcept
    {
        return way_m > most_m(since_s + kPatience_s);
    }
    /// Where it is carried in that time: as far towards `to` as its points in reach may go, whose
    /// way to a place is `way_to_m(place)`. That of a turn is not even: what it makes of a share of
    /// the way is looked at, too.
    template <typename WayTo>
    [[nodiscard]] Similarity held(const Similarity& from, const Similarity& to, double since_s,
                                  const WayTo& way_to_m) const noexcept
    {
        constexpr int kRounds = 16;
        constexpr double kRounded = 1.0 + 1e-9;
        constexpr double kLess = 0.95; // Of a way that isn't even, so that there is an end.
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
