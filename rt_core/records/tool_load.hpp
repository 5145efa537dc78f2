// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

namespace tactus
{

inline constexpr double kGravity_m_per_s2 = 9.80665;

/// Payload of a device. Usable on any thread: a plain value.
struct ToolLoad
{
    double mass_kg{0.0};             ///< Mass of the payload; 0: no payload.
    Vec3 centre_m{0.0, 0.0, 0.0};    ///< Centre of mass, in the tool's frame.
    Vec3 down_world{0.0, 0.0, -1.0}; ///< Direction of gravity in the world; unit length.

    [[nodiscard]] double weight_n() const noexcept { return mass_kg * kGravity_m_per_s2; }
    /// Largest torque about the device's position, with the centre of mass level with it.
    [[nodiscard]] double torque_max_nm() const noexcept { return weight_n() * centre_m.norm(); }
};

} // namespace tactus
