// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/records/device_limits.hpp"

namespace tactus
{

/// Limits of a wall's stiffness on one device at one rate, by cause. N/m.
struct StiffnessLimits
{
    /// Limit by sampling: 2 (b - B) / (T + 2 t), with the device's damping b and delay t and the
    /// period T. A sampled wall gives away at most K (T/2 + t) v^2 + B v^2 of power, and the device
    /// loses b v^2 (Colgate and Schenkel 1997; with delay Diolaiti et al. 2006).
    double sampling_n_per_m{0.0};
    /// Limit by quantisation: 2 (f - B q / T) / q, with the device's friction f and quantum q. A
    /// position that is wrong by up to q / 2 gives away at most (K q / 2 + B q / T) |v|, and the
    /// device loses f |v| (Abbott and Okamura 2005, Diolaiti et al. 2006). Infinite if f or q is 0.
    double quantisation_n_per_m{0.0};
    double device_n_per_m{0.0}; ///< DeviceLimits::stiffness_max_n_per_m.
    /// Largest usable stiffness: 0.9 x the lower one of the first two, and at most the third.
    double limit_n_per_m{0.0};
};

/// Rule of docs/stability.md for a wall with stiffness K and an object's surface damping B: its
/// force is K x depth + B x (difference of two positions) / period. If B alone is too large, all
/// limits are 0.
///
/// The part of the delay t is exact for whole periods. Fractions may give up to 8 % more energy
/// than T/2 + t, which the factor 0.9 covers.
/// - `device` has no fault.
/// - `period_s` > 0: the period of the loop.
/// - `surface_damping_n_s_per_m` is finite; its sign doesn't count.
[[nodiscard]] StiffnessLimits
stiffness_limits(const DeviceLimits& device, double period_s,
                 double surface_damping_n_s_per_m = 0.0) noexcept TACTUS_NONBLOCKING;

/// Returns stiffness_limits().limit_n_per_m, the limit in use for walls.
[[nodiscard]] double
stiffness_limit(const DeviceLimits& device, double period_s,
                double surface_damping_n_s_per_m = 0.0) noexcept TACTUS_NONBLOCKING;

/// Rotation of a device that produces torques, as a device with the same law: kg m^2 stands for kg,
/// N m for N, rad for m. Stiffnesses are N m/rad. The result has no rotation itself.
[[nodiscard]] inline DeviceLimits rotational_limits_of(const DeviceLimits& device) noexcept
{
    const RotationLimits& turn = device.rotation;
    return {.mass_kg = turn.inertia_kg_m2,
            .damping_n_s_per_m = turn.damping_nm_s_per_rad,
            .friction_n = turn.friction_nm,
            .quantum_m = turn.quantum_rad,
            .delay_s = device.delay_s,
            .force_max_n = turn.torque_max_nm,
            .slew_max_n_per_s = turn.slew_max_nm_per_s,
            .stiffness_max_n_per_m = turn.stiffness_max_nm_per_rad,
            .added_damping_max_n_s_per_m = turn.added_damping_max_nm_s_per_rad};
}

/// Returns null, or one line that names the first value out of range.
[[nodiscard]] const char* find_fault(const DeviceLimits& device) noexcept TACTUS_NONBLOCKING;
[[nodiscard]] const char* find_fault(const RotationLimits& turn) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
