// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/similarity.hpp"

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Pose between `from` and `to`, at `share` of the motion. The rotation takes the shorter way; up
/// to 45 degrees its speed is even to a twentieth.
[[nodiscard]] Similarity between(const Similarity& from, const Similarity& to,
                                 double share) noexcept TACTUS_NONBLOCKING;

/// Largest displacement of an object's points within a sphere of the world when the object moves
/// from one pose to another.
[[nodiscard]] double way_in_sphere_m(const Similarity& from, const Similarity& to,
                                     const Vec3& center_m,
                                     double radius_m) noexcept TACTUS_NONBLOCKING;

/// Speed limit of objects that a tool may touch, so that their motion changes a force by at most
/// stiffness x speed per second.
struct ObjectSpeedLimit
{
    /// Time, in seconds. A limited object that lags by more than its way in this time counts as
    /// rate-limited, and forces of tools that it may touch fade. Objects are limited if they may
    /// touch a tool within this time.
    static constexpr double kPatience_s = 0.02;

    double speed_max_m_per_s{kInfinity}; ///< Largest speed of an object; above 0.

    [[nodiscard]] double most_m(double since_s) const noexcept
    {
        return speed_max_m_per_s * since_s;
    }
    /// Distance by which tool and object may approach each other within kPatience_s.
    [[nodiscard]] double soon_m(double tool_speed_m_per_s) const noexcept
    {
        return kPatience_s * (tool_speed_m_per_s + speed_max_m_per_s);
    }
    /// True if a displacement of `way_m` within `since_s` exceeds the speed limit.
    [[nodiscard]] bool is_too_fast(double way_m, double since_s) const noexcept
    {
        return way_m > most_m(since_s);
    }
    [[nodiscard]] bool exceeds_limit(double way_m, double since_s) const noexcept
    {
        return way_m > most_m(since_s + kPatience_s);
    }
    /// Returns the limited pose: from `from` towards `to` as far as the object's points in reach
    /// may move within `since_s`. `way_to_m(place)` is the largest displacement of these points to
    /// a pose. A rotation's displacement is not proportional to its share, so each step is checked.
    template <typename WayTo>
    [[nodiscard]] Similarity held(const Similarity& from, const Similarity& to, double since_s,
                                  const WayTo& way_to_m) const noexcept
    {
        constexpr int kRounds = 16;
        constexpr double kRounded = 1.0 + 1e-9;
        // The factor ends the loop for motions that are not proportional to their share.
        constexpr double kLess = 0.95;
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
