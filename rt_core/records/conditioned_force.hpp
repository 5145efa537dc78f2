// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// What one tool's frame wants its device to do, and where the device was. World frame, SI.
struct ForceWish
{
    Vec3 force_n{0.0, 0.0, 0.0};    ///< On the hand.
    Vec3 position_m{0.0, 0.0, 0.0}; ///< Of the device, from this frame's sample.
    /// Of the wall that the force comes from; finite, >= 0, else ForceAction::refused. 0: it comes
    /// from no wall and its energy isn't judged.
    double stiffness_n_per_m{0.0};
    /// Between proxy and device. Where the force was cut to a limit before it came here, the spring
    /// holds more energy than the force tells; 0: take force / stiffness.
    double stretch_m{0.0};
    std::uint32_t elapsed_periods{1}; ///< Since the last wish; more after a stall. 0 counts as 1.
    /// The largest surface damping of what the tool touches, in N s/m: it lowers the stiffness cap.
    /// Finite, >= 0; left alone in the torque's.
    double surface_damping_n_s_per_m{0.0};
};

/// Force and torque that are one spring between proxy and hand. `torque` is in angles: N m for N,
/// rad for m; its position is how far the device has turned about the world's axes, summed up.
struct WrenchWish
{
    ForceWish force;
    ForceWish torque;
};

/// What acted on a force on its way to the device.
enum class ForceAction : std::uint8_t
{
    none = 0,
    refused = 1U << 0U,          ///< Force or stiffness was no usable number: the force is zero.
    stiffness_capped = 1U << 1U, ///< Stiffer than stiffness_cap_n_per_m(): scaled down to it.
    clamped = 1U << 2U,          ///< Longer than DeviceLimits::force_max_n.
    slew_limited = 1U << 3U,     ///< Grew faster than DeviceLimits::slew_max_n_per_s.
    damped = 1U << 4U,           ///< The passivity controller added damping.
    /// Energy not observed: the position was no number or jumped. Observed wrongly: the device's
    /// delay is longer than kForcesUnderWay tell.
    blind = 1U << 5U,
};

inline constexpr std::size_t kForceActions = 6;
static_assert(static_cast<std::uint32_t>(ForceAction::blind) == 1U << (kForceActions - 1));
/// In the order of ForceAction's bits.
inline constexpr std::array<const char*, kForceActions> kForceActionNames{
    "refused", "stiffness_capped", "clamped", "slew_limited", "damped", "blind"};

[[nodiscard]] constexpr ForceAction operator|(ForceAction a, ForceAction b) noexcept
{
    return static_cast<ForceAction>(static_cast<std::uint8_t>(a) | static_cast<std::uint8_t>(b));
}
constexpr ForceAction& operator|=(ForceAction& a, ForceAction b) noexcept
{
    return a = a | b;
}
[[nodiscard]] constexpr bool has_action(ForceAction set, ForceAction one) noexcept
{
    return (static_cast<std::uint8_t>(set) & static_cast<std::uint8_t>(one)) != 0;
}

/// The force for the device and how it came about.
struct ConditionedForce
{
    Vec3 force_n{0.0, 0.0, 0.0}; ///< Finite, at most DeviceLimits::force_max_n long.
    ForceAction actions{ForceAction::none};
    double stiffness_n_per_m{0.0}; ///< In use after the cap.
    double damping_n_s_per_m{0.0}; ///< That the passivity controller added.
    double work_j{0.0};            ///< Done on hand and device since the start.
    /// Energy that came from nowhere and is not lost yet: PassivityObserver::surplus_j().
    double surplus_j{0.0};
};

/// Force and torque for the device; `torque` in angles.
struct ConditionedWrench
{
    ConditionedForce force;
    ConditionedForce torque; ///< Nothing where the device makes none.
};

} // namespace tactus
