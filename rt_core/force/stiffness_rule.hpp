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
    /// 2 (b - B) / (T + 2 t): a sampled wall gives away at most K (T/2 + t) v^2 + B v^2 of power,
    /// the device loses b v^2 (Colgate and Schenkel 1997; with the delay t Diolaiti et al. 2006).
    double sampling_n_per_m{0.0};
    /// 2 (f - B q / T) / q: a position that is wrong by up to half a quantum q gives away at most
    /// (K q / 2 + B q / T) |v|. The device loses f |v| (Abbott and Okamura 2005, Diolaiti et al.
    /// 2006). Infinite if friction f or quantum is 0.
    double quantisation_n_per_m{0.0};
    double device_n_per_m{0.0}; ///< DeviceLimits::stiffness_max_n_per_m.
    /// The largest usable stiffness: 0.9 x the first two, and no more than the third.
    double cap_n_per_m{0.0};
};

/// The rule of docs/stability.md for a wall with stiffness and, per object, surface damping B: its
/// force is K x depth + B x (difference of two positions) / period. If B alone is too much, all
/// limits are 0: take less B.
///
/// The delay's part is exact for whole periods. For fractions the energy may be up to 8 % more than
/// T/2 + t gives, which the factor 0.9 covers.
/// - `device` has no fault.
/// - `period_s` > 0: the one that the loop runs at, not the device's best.
/// - `surface_damping_n_s_per_m` finite; its sign doesn't count.
[[nodiscard]] StiffnessLimits
stiffness_limits(const DeviceLimits& device, double period_s,
                 double surface_damping_n_s_per_m = 0.0) noexcept TACTUS_NONBLOCKING;

/// stiffness_limits().cap_n_per_m, with which callers limit a wall's stiffness.
[[nodiscard]] double
stiffness_limit(const DeviceLimits& device, double period_s,
                double surface_damping_n_s_per_m = 0.0) noexcept TACTUS_NONBLOCKING;

/// The rotation of a device that produces torques, as a device of the same law: kg m^2 for kg, N m
/// s/rad for N s/m, N m for N, rad for m. So all statements about K hold for a rotational spring,
/// in N m/rad. The result has no rotation itself.
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

/// Null, or one line that names the value out of its range.
[[nodiscard]] const char* find_fault(const DeviceLimits& device) noexcept TACTUS_NONBLOCKING;
[[nodiscard]] const char* find_fault(const RotationLimits& turn) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
