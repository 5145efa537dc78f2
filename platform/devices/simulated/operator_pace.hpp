// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

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

/// Schedule of the scripted operator. Times are shares of the run, so that short runs have all
/// phases. Flight and retreat together take less than a tenth of a run of 3 s.
struct OperatorSchedule
{
    double flight_s;
    std::uint64_t first_lift_frame;
    std::uint64_t lift_spacing_frames;
    std::uint32_t lifts;
    std::uint64_t retreat_frame;

    OperatorSchedule(double run_s, double period_s, bool lifts_off) noexcept
        : flight_s(std::clamp(0.04 * run_s, 0.1, 1.0))
        , first_lift_frame(frames_in(0.3 * run_s, period_s))
        , lifts(std::max(kLiftsMin, static_cast<std::uint32_t>(std::min(run_s / 2.5, 1e6))))
        , retreat_frame(frames_in(run_s - std::clamp(0.03 * run_s, 0.1, 0.5), period_s))
    {
        lift_spacing_frames = frames_in(0.5 * run_s / lifts, period_s) + 1;
        lifts = lifts_off ? lifts : 0;
    }

    [[nodiscard]] bool lift_is_due(std::uint64_t frame, std::uint32_t lifts_done) const noexcept
    {
        return lifts_done < lifts && frame >= first_lift_frame + lifts_done * lift_spacing_frames;
    }

    /// Number of frames; 0 for a negative time.
    [[nodiscard]] static std::uint64_t frames_in(double seconds, double period_s) noexcept
    {
        return static_cast<std::uint64_t>(std::max(seconds, 0.0) / period_s);
    }

private:
    static constexpr std::uint32_t kLiftsMin = 3;
};

} // namespace tactus
