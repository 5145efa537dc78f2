// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/operator_and_device.hpp"
#include "rt_core/force/force_pipeline.hpp"

#include <cstdint>
#include <functional>

namespace tactus::test
{

/// A hand presses a device into a wall that fills x < 0, or taps on it.
struct WallTrial
{
    DeviceLimits device;
    OperatorLimb hand;
    double period_s{1e-3};
    double stiffness_n_per_m{1'000.0};
    double surface_damping_n_s_per_m{0.0};
    std::uint32_t wall_delay_periods{0}; ///< Delay of the wall's own force, which makes it active.
    /// True if the wall's force is conditioned.
    bool is_conditioned{true};
    bool controls_passivity{true};
    /// True if a ForcePipeline at full gain follows the conditioner.
    bool is_piped{false};
    /// Stiffness that the wall reports to the conditioner; 0: the true one.
    double claimed_stiffness_n_per_m{0.0};
    double duration_s{2.0};
    Vec3 start_m{0.01, 0.0, 0.0};
    std::function<double(double time_s)> target_x_m; ///< Position that the hand aims at.
};

/// Measurements, of the true motion unless stated otherwise.
struct WallFigures
{
    double swing_m{0.0};       ///< Peak to peak in the last 0.5 s.
    double force_swing_n{0.0}; ///< Peak to peak of the force in the last 0.5 s.
    double deepest_m{0.0};     ///< Greatest depth in the wall.
    double work_j{0.0};        ///< Work of the motors by the simulation's own account.
    /// Greatest value of the work at any time: the energy that the wall generated.
    double largest_work_j{0.0};
    /// Greatest difference between the conditioner's work and the simulation's at the same time.
    double observer_error_j{0.0};
    double observed_energy_max_j{0.0};
    double damping_max_n_s_per_m{0.0};
    std::uint32_t held_periods{0}; ///< Periods in which ChangeLimit acted.
    std::uint32_t contacts{0};
    /// Greatest excess of a contact, from its first sample in the wall to its first outside: work
    /// of the motors minus the losses by the device's damping and friction, minus K (v T + q)^2 / 2
    /// and the quantisation's share (K q / 2 - f) x way if positive. docs/internals/passivity.md
    /// claims at most 0.
    double worst_excess_j{-1.0};
    double largest_contact_j{-1.0}; ///< Greatest work minus losses of a contact.
};

[[nodiscard]] WallFigures run_wall_trial(const WallTrial& trial);

/// Target of a press: moves to `depth_m` behind the wall's surface within 0.3 s and stays there.
[[nodiscard]] std::function<double(double)> press(double from_m, double depth_m);
/// Target of taps: oscillates between `from_m` and -`from_m` at this frequency.
[[nodiscard]] std::function<double(double)> tap(double from_m, double frequency_hz);

} // namespace tactus::test
