// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/force/external_force.hpp"
#include "rt_core/force/force_conditioner.hpp"

#include <cstdint>

namespace tactus::test
{

/// Input of a conditioner in one step, along one line.
struct CommandedForce
{
    Vec3 force_n{0.0, 0.0, 0.0};
    Vec3 position_m{0.0, 0.0, 0.0};
    double stiffness_n_per_m{0.0};
    double stretch_m{0.0};
    std::uint32_t elapsed_periods{1};
    double surface_damping_n_s_per_m{0.0};
    Vec3 carried_m{0.0, 0.0, 0.0};

    [[nodiscard]] SpringForce spring() const
    {
        SpringForce spring;
        spring.force_n = force_n;
        spring.stiffness_n_per_m = stiffness_n_per_m;
        spring.stretch_m = stretch_m;
        return spring;
    }
};

/// Input for a 6-DoF device: `torque` in angles.
struct CommandedWrench
{
    CommandedForce force;
    CommandedForce torque;
};

[[nodiscard]] inline SpringForce condition(ForceConditioner& sut, const CommandedForce& commanded)
{
    SpringForce spring = commanded.spring();
    sut.condition(spring, {commanded.position_m, commanded.elapsed_periods,
                           commanded.surface_damping_n_s_per_m, commanded.carried_m});
    return spring;
}

[[nodiscard]] inline ToolForce condition(WrenchConditioner& sut, const CommandedWrench& commanded)
{
    ToolForce force;
    force.push = commanded.force.spring();
    force.torque = commanded.torque.spring();
    ToolPeriod period;
    period.device_m = commanded.force.position_m;
    period.turned_rad = commanded.torque.position_m;
    period.elapsed_periods = commanded.force.elapsed_periods;
    period.surface_damping_n_s_per_m = commanded.force.surface_damping_n_s_per_m;
    period.carried_m = commanded.force.carried_m;
    period.carried_rad = commanded.torque.carried_m;
    sut.condition(force, period);
    return force;
}

/// The same input plus a spring of the program's own.
[[nodiscard]] inline CommandedForce with_spring(CommandedForce commanded, const Vec3& force_n,
                                                double stiffness_n_per_m)
{
    SpringForce both = commanded.spring();
    add_spring(both, force_n, stiffness_n_per_m);
    commanded.force_n = both.force_n;
    commanded.stiffness_n_per_m = both.stiffness_n_per_m;
    commanded.stretch_m = both.stretch_m;
    return commanded;
}

} // namespace tactus::test
