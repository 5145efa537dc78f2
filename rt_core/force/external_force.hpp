// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/force_limiter.hpp"
#include "rt_core/records/tool_force.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

/// External force of a program on the user's hand besides that of surfaces: guidance, a spring to a
/// point, a gripper that closes. World frame, SI. Haptic thread.
struct ExternalForce
{
    Vec3 force_n{0.0, 0.0, 0.0};
    Vec3 torque_nm{0.0, 0.0, 0.0};
    /// Stiffness, if the force is a spring. 0: it is no spring, and its work on the user is energy
    /// without a source, which the passivity controller damps in contact.
    double stiffness_n_per_m{0.0};
    double stiffness_nm_per_rad{0.0}; ///< Stiffness of the torque; 0: it is no spring.
    double gripper_n{0.0};            ///< Force on the gripper; above 0 it opens the gripper.
};

/// Spring from the tool at `place_m` to `point_m`, with a limited force. Stiffness and largest
/// force must be finite and not negative.
[[nodiscard]] inline ExternalForce spring_to(const Vec3& point_m, const Vec3& place_m,
                                             double stiffness_n_per_m, double force_max_n) noexcept
{
    ExternalForce spring;
    spring.force_n = clamp_norm(stiffness_n_per_m * (point_m - place_m), force_max_n);
    spring.stiffness_n_per_m = stiffness_n_per_m;
    return spring;
}

/// Adds a second spring to `wall`: forces and stiffnesses add, and the stretch is set so that the
/// sum holds the energy of both. A second spring without force changes nothing.
inline void add_spring(SpringForce& wall, const Vec3& force_n, double stiffness_n_per_m) noexcept
{
    if (force_n == Vec3(0.0, 0.0, 0.0))
    {
        return;
    }
    const auto energy_j = [](double force, double stiffness, double stretch_m)
    {
        const double least_m = stiffness > 0.0 ? force / stiffness : 0.0;
        return stiffness > 0.0 ? force * (std::max(stretch_m, least_m) - 0.5 * least_m) : 0.0;
    };
    const double wall_n = wall.force_n.norm();
    const double held_j = energy_j(wall_n, wall.stiffness_n_per_m, wall.stretch_m) +
                          energy_j(force_n.norm(), stiffness_n_per_m, 0.0);
    wall.force_n += force_n;
    wall.stiffness_n_per_m = stiffness_n_per_m + (wall_n > 0.0 ? wall.stiffness_n_per_m : 0.0);
    const double sum_n = wall.force_n.norm();
    if (sum_n > 0.0 && wall.stiffness_n_per_m > 0.0)
    {
        wall.stretch_m = held_j / sum_n + 0.5 * sum_n / wall.stiffness_n_per_m;
    }
}

/// Adds the program's force `own` to the force of the surfaces, for the WrenchConditioner.
inline void add_external(ToolForce& force, const ExternalForce& own) noexcept
{
    add_spring(force.push, own.force_n, own.stiffness_n_per_m);
    add_spring(force.torque, own.torque_nm, own.stiffness_nm_per_rad);
    force.own_n = own.force_n.norm();
}

} // namespace tactus
