// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <cstdint>

namespace tactus
{

/// Change of a tool's goal since the last frame.
enum class GoalChange : std::uint8_t
{
    none,  ///< No sample was taken: the goal is the last one.
    first, ///< The goal is that of the first sample.
    /// The goal is farther from the last one than a user can move.
    jump,
    motion, ///< The device moved the goal.
};

/// Place of the tool at the device pose. World frame, SI.
struct ProxyGoal
{
    Vec3 position_m{0.0, 0.0, 0.0};
    Vec3 velocity_m_per_s{0.0, 0.0, 0.0};
    double elapsed_s{0.0};           ///< Time since the last frame.
    Mat3 rotation{Mat3::Identity()}; ///< Rotation of the tool's frame; orthonormal to rounding.
    GoalChange change{GoalChange::none};
    Vec3 spin_rad_per_s{0.0, 0.0, 0.0}; ///< Angular velocity of the goal, about the world's axes.

    [[nodiscard]] bool operator==(const ProxyGoal&) const = default;
};

} // namespace tactus
