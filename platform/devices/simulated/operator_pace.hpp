// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <cmath>

namespace tactus
{

/// Speeds of the simulated operators, proportional to the model's diagonal, so that models of every
/// size are treated alike.
struct OperatorPace
{
    /// Distance from the surface, in diagonals, below which an approach slows down.
    static constexpr double kSlowDown_diag = 0.1;

    double flight_m_per_s;
    double approach_m_per_s;
    double lift_m_per_s;
    double retreat_m_per_s;
    /// Speed at the touch, at most 0.3 m/s, at which 0.1 kg strikes a wall of 500 N/m with 2 N.
    double touch_m_per_s;
    double acceleration_m_per_s2;

    explicit OperatorPace(double diagonal_m) noexcept
        : flight_m_per_s(2.0 * diagonal_m)
        , approach_m_per_s(1.6 * diagonal_m)
        , lift_m_per_s(diagonal_m)
        , retreat_m_per_s(1.5 * diagonal_m)
        , touch_m_per_s(std::min(0.3 * diagonal_m, 0.3))
        , acceleration_m_per_s2(40.0 * diagonal_m)
    {
    }

    /// Returns the smaller of `speed_m_per_s` and the speed from which the hand stops within
    /// `distance_m` at 60 % of its deceleration.
    [[nodiscard]] double stoppable(double speed_m_per_s, double distance_m) const noexcept
    {
        constexpr double kBrakingShare = 0.6;
        const double braking = kBrakingShare * acceleration_m_per_s2;
        return std::min(speed_m_per_s, std::sqrt(2.0 * braking * distance_m));
    }

    /// Speed at `gap_m` from the surface. Falls from `fast_m_per_s` to touch_m_per_s over the last
    /// `zone_m`.
    [[nodiscard]] double slowing(double fast_m_per_s, double gap_m, double zone_m) const noexcept
    {
        return touch_m_per_s + (fast_m_per_s - touch_m_per_s) * smoothstep(gap_m / zone_m);
    }

    /// Smooth step: 0 up to 0, 1 from 1 on, zero slope at both.
    [[nodiscard]] static double smoothstep(double x) noexcept
    {
        const double t = std::clamp(x, 0.0, 1.0);
        return t * t * (3.0 - 2.0 * t);
    }
};

} // namespace tactus
