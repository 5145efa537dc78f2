// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/stiffness_rule.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/value_range.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

StiffnessLimits stiffness_limits(const DeviceLimits& device, double period_s,
                                 double surface_damping_n_s_per_m) noexcept
{
    TACTUS_ASSERT(find_fault(device) == nullptr);
    TACTUS_ASSERT(period_s > 0.0);
    const double damping = std::abs(surface_damping_n_s_per_m);
    StiffnessLimits limits;
    limits.sampling_n_per_m = std::max(0.0, 2.0 * (device.damping_n_s_per_m - damping) /
                                                (period_s + 2.0 * device.delay_s));
    const double noise_n = damping * device.quantum_m / period_s;
    limits.quantisation_n_per_m =
        device.friction_n > 0.0 && device.quantum_m > 0.0
            ? std::max(0.0, 2.0 * (device.friction_n - noise_n) / device.quantum_m)
            : kInfinity;
    limits.device_n_per_m = device.stiffness_max_n_per_m;
    const double passive = std::min(limits.sampling_n_per_m, limits.quantisation_n_per_m);
    limits.limit_n_per_m = std::min(kStiffnessMargin * passive, limits.device_n_per_m);
    return limits;
}

double stiffness_limit(const DeviceLimits& device, double period_s,
                       double surface_damping_n_s_per_m) noexcept
{
    return stiffness_limits(device, period_s, surface_damping_n_s_per_m).limit_n_per_m;
}

const char* find_fault(const DeviceLimits& device) noexcept
{
    if (!is_positive(device.mass_kg))
    {
        return "device: mass_kg must be finite and > 0";
    }
    if (!is_not_negative(device.damping_n_s_per_m))
    {
        return "device: damping_n_s_per_m must be finite and >= 0";
    }
    if (!is_not_negative(device.friction_n))
    {
        return "device: friction_n must be finite and >= 0";
    }
    if (!is_not_negative(device.quantum_m))
    {
        return "device: quantum_m must be finite and >= 0";
    }
    if (!is_not_negative(device.delay_s))
    {
        return "device: delay_s must be finite and >= 0";
    }
    if (!is_positive(device.force_max_n))
    {
        return "device: force_max_n must be finite and > 0";
    }
    if (!is_positive(device.slew_max_n_per_s))
    {
        return "device: slew_max_n_per_s must be finite and > 0";
    }
    if (!is_positive(device.stiffness_max_n_per_m))
    {
        return "device: stiffness_max_n_per_m must be finite and > 0";
    }
    if (!is_not_negative(device.added_damping_max_n_s_per_m))
    {
        return "device: added_damping_max_n_s_per_m must be finite and >= 0";
    }
    return find_fault(device.rotation);
}

const char* find_fault(const RotationLimits& turn) noexcept
{
    if (!is_not_negative(turn.torque_max_nm))
    {
        return "device: torque_max_nm must be finite and >= 0";
    }
    if (turn.torque_max_nm > 0.0 && !turn.is_measured)
    {
        return "device: a device with torque must measure its rotation";
    }
    const bool turns = turn.torque_max_nm > 0.0;
    const auto is_good = [turns](double value)
    { return turns ? is_positive(value) : is_not_negative(value); };
    if (!is_good(turn.inertia_kg_m2))
    {
        return "device: inertia_kg_m2 must be finite and > 0, or 0 without a torque";
    }
    if (!is_not_negative(turn.damping_nm_s_per_rad) || !is_not_negative(turn.friction_nm) ||
        !is_not_negative(turn.quantum_rad))
    {
        return "device: damping_nm_s_per_rad, friction_nm and quantum_rad must be finite and >= 0";
    }
    if (!is_good(turn.slew_max_nm_per_s) || !is_good(turn.stiffness_max_nm_per_rad))
    {
        return "device: slew_max_nm_per_s and stiffness_max_nm_per_rad must be finite and > 0, or "
               "0 without a torque";
    }
    if (!is_not_negative(turn.added_damping_max_nm_s_per_rad))
    {
        return "device: added_damping_max_nm_s_per_rad must be finite and >= 0";
    }
    return nullptr;
}

} // namespace tactus
