// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "rt_core/records/safety.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Actions on a force on its way to the device.
enum class ForceAction : std::uint8_t
{
    none = 0,
    refused = 1U << 0U, ///< Force or stiffness was no usable number: zero force.
    /// Stiffer than stiffness_limit_n_per_m(): scaled down to it.
    stiffness_limited = 1U << 1U,
    clamped = 1U << 2U,        ///< Longer than DeviceLimits::force_max_n.
    change_limited = 1U << 3U, ///< Faster change than ChangeLimit allows.
    damped = 1U << 4U,         ///< The passivity controller added damping.
    /// Energy not observed: the position was no number or jumped. Or observed wrongly: the device's
    /// delay is longer than kForcesUnderWay covers.
    blind = 1U << 5U,
};

inline constexpr std::size_t kForceActions = 6;
static_assert(static_cast<std::uint32_t>(ForceAction::blind) == 1U << (kForceActions - 1));
/// Names of the actions, in the order of ForceAction's bits.
inline constexpr std::array<const char*, kForceActions> kForceActionNames{
    "refused", "stiffness_limited", "clamped", "change_limited", "damped", "blind"};

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

/// The force of a spring on a device, or in angles its torque: N m for N, rad for m. World frame,
/// SI.
struct SpringForce
{
    Vec3 force_n{0.0, 0.0, 0.0}; ///< Force on the user's hand.
    /// Stiffness of the wall that the force comes from; finite, >= 0, else ForceAction::refused. 0:
    /// the force comes from no wall, and its energy is not judged. After the conditioner: the
    /// limited stiffness in use.
    double stiffness_n_per_m{0.0};
    /// Distance between proxy and device. If the force was clamped before, the spring holds more
    /// energy than the force shows; 0: use force / stiffness.
    double stretch_m{0.0};
    ForceAction actions{ForceAction::none};
    double damping_n_s_per_m{0.0}; ///< Added by the passivity controller.
    double work_j{0.0};            ///< Work on user and device since the start.
    /// Observed energy that is not dissipated yet: PassivityObserver::observed_energy_j().
    double observed_energy_j{0.0};
};

/// Force and torque of one tool on their way from the frame to the device. Each stage of a
/// ForcePipeline changes the record; the result of the last stage is sent.
struct ToolForce
{
    SpringForce push;            ///< Force of surfaces and program.
    SpringForce turn;            ///< Their torque, in angles. Nothing without torques.
    Vec3 load_n{0.0, 0.0, 0.0};  ///< Payload compensation, sent in addition: force.
    Vec3 load_nm{0.0, 0.0, 0.0}; ///< Payload compensation: torque.
    double gripper_n{0.0};       ///< Gripper force of the program.
    double own_n{0.0};           ///< Force that the program commanded: ExternalForce.
    double twist_rad{0.0};       ///< Angle between device and proxy, in contact.
    SafetyState state{SafetyState::reset};
    ForceOff causes{ForceOff::none}; ///< Causes for which less than the frame's force is sent.
    bool has_changed{false};         ///< State or causes differ from the last frame's.
};

} // namespace tactus
