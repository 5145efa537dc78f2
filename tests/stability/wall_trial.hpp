// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/hand_and_device.hpp"
#include "rt_core/force/force_pipeline.hpp"

#include <cstdint>
#include <functional>

namespace tactus::test
{

/// A hand presses a device into a wall that fills x < 0, or taps on it.
struct WallTrial
{
    DeviceLimits device;
    HandLimb hand;
    double period_s{1e-3};
    double stiffness_n_per_m{1'000.0};
    double surface_damping_n_s_per_m{0.0};
    std::uint32_t wall_delay_periods{0}; ///< Of the wall's own force: makes it active.
    /// False: the wall's force goes out as it is.
    bool is_conditioned{true};
    bool controls_passivity{true};
    /// With all stages of a ForcePipeline behind the conditioner, too, whose gain is whole.
    bool is_piped{false};
    /// What the wall says of itself to the conditioner; 0: the truth.
    double claimed_stiffness_n_per_m{0.0};
    double duration_s{2.0};
    Vec3 start_m{0.01, 0.0, 0.0};
    std::function<double(double time_s)> target_x_m; ///< Where the hand wants to be.
};

/// What was seen, of the true motion where not said otherwise.
struct WallFigures
{
    double swing_m{0.0};        ///< Peak to peak in the last 0.5 s.
    double force_swing_n{0.0};  ///< Likewise, of the force.
    double deepest_m{0.0};      ///< Into the wall.
    double work_j{0.0};         ///< By the motors, from the simulation's own ledger.
    double largest_work_j{0.0}; ///< Its largest value at any time: what the wall gave away.
    /// Largest difference between the conditioner's work and the simulation's at the same time.
    double observer_error_j{0.0};
    double surplus_max_j{0.0};
    double damping_max_n_s_per_m{0.0};
    std::uint32_t held_periods{0}; ///< In which ChangeLimit acted.
    std::uint32_t contacts{0};
    /// Of each contact from its first sample in the wall to its first outside: work of the motors
    /// less what the device's damping and friction have lost, less K (v T + q)^2 / 2 and the
    /// quantisation's share (K q / 2 - f) x way where it is positive. The largest; at most 0 is
    /// what docs/stability.md claims.
    double worst_excess_j{-1.0};
    double largest_contact_j{-1.0}; ///< Work less losses of a contact, the largest.
};

[[nodiscard]] WallFigures run_wall_trial(const WallTrial& trial);

/// Presses: comes down to `depth_m` behind the wall's surface within 0.3 s and stays there.
[[nodiscard]] std::function<double(double)> press(double from_m, double depth_m);
/// Taps: swings between `from_m` and -`from_m` at this frequency.
[[nodiscard]] std::function<double(double)> tap(double from_m, double frequency_hz);

} // namespace tactus::test
