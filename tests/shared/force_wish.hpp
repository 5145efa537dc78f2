// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/force/force_conditioner.hpp"
#include "rt_core/force/own_force.hpp"

#include <cstdint>

namespace tactus::test
{

/// Input of a conditioner in one step, along one line.
struct ForceWish
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
struct WrenchWish
{
    ForceWish force;
    ForceWish torque;
};

[[nodiscard]] inline SpringForce condition(ForceConditioner& sut, const ForceWish& wish)
{
    SpringForce spring = wish.spring();
    sut.condition(spring, {wish.position_m, wish.elapsed_periods, wish.surface_damping_n_s_per_m,
                           wish.carried_m});
    return spring;
}

[[nodiscard]] inline ToolForce condition(WrenchConditioner& sut, const WrenchWish& wish)
{
    ToolForce force;
    force.push = wish.force.spring();
    force.turn = wish.torque.spring();
    ToolPeriod period;
    period.hand_m = wish.force.position_m;
    period.turned_rad = wish.torque.position_m;
    period.elapsed_periods = wish.force.elapsed_periods;
    period.surface_damping_n_s_per_m = wish.force.surface_damping_n_s_per_m;
    period.carried_m = wish.force.carried_m;
    period.carried_rad = wish.torque.carried_m;
    sut.condition(force, period);
    return force;
}

/// The same input plus a spring of the program's own.
[[nodiscard]] inline ForceWish with_spring(ForceWish wish, const Vec3& force_n,
                                           double stiffness_n_per_m)
{
    SpringForce both = wish.spring();
    add_spring(both, force_n, stiffness_n_per_m);
    wish.force_n = both.force_n;
    wish.stiffness_n_per_m = both.stiffness_n_per_m;
    wish.stretch_m = both.stretch_m;
    return wish;
}

} // namespace tactus::test
