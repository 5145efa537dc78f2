// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "rt_core/records/safety.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Actions on a force on its way to the device.
enum class ForceAction : std::uint8_t
{
    none = 0,
    refused = 1U << 0U, ///< Force or stiffness was no usable number; the force became zero.
    /// Wall stiffer than the device's stable limit; the force was scaled down.
    stiffness_limited = 1U << 1U,
    clamped = 1U << 2U,        ///< Force longer than DeviceLimits::force_max_n; it was shortened.
    change_limited = 1U << 3U, ///< ChangeLimit slowed the change of the force.
    damped = 1U << 4U,         ///< The passivity controller added damping.
    /// Energy was not observed, as the position was no number or jumped. Or it was observed
    /// wrongly, as the device's delay is longer than kForcesUnderWay covers.
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

/// Force of a spring on a device, or its torque: then N m stands for N, and rad for m. World frame,
/// SI.
struct SpringForce
{
    Vec3 force_n{0.0, 0.0, 0.0}; ///< Force on the user's hand.
    /// Stiffness of the wall that makes the force; finite, >= 0, else ForceAction::refused. 0: the
    /// force comes from no wall, and its energy is not judged. After the conditioner: the limited
    /// stiffness.
    double stiffness_n_per_m{0.0};
    /// Distance between proxy and device; 0: use force / stiffness. A clamped force has a larger
    /// stretch than that, and its spring holds more energy.
    double stretch_m{0.0};
    ForceAction actions{ForceAction::none};
    double damping_n_s_per_m{0.0}; ///< Damping that the passivity controller added.
    double work_j{0.0};            ///< Work on user and device since the start.
    /// Observed energy that is not dissipated yet: PassivityObserver::observed_energy_j().
    double observed_energy_j{0.0};
};

/// Force and torque of one tool on their way from the frame to the device. Each stage of a
/// ForcePipeline changes the record; the result of the last stage is sent.
struct ToolForce
{
    SpringForce push;   ///< Force of surfaces and program.
    SpringForce torque; ///< Torque of surfaces and program; zero for a device without torques.
    Vec3 load_n{0.0, 0.0, 0.0};  ///< Force of the payload compensation, sent in addition.
    Vec3 load_nm{0.0, 0.0, 0.0}; ///< Torque of the payload compensation.
    double gripper_n{0.0};       ///< Gripper force of the program.
    double own_n{0.0};           ///< Norm of the program's ExternalForce.
    double twist_rad{0.0};       ///< Angle between device and proxy in contact; 0 otherwise.
    SafetyState state{SafetyState::reset};
    ForceOff causes{ForceOff::none}; ///< Causes for which less than the frame's force is sent.
    bool has_changed{false};         ///< True if state or causes differ from the last frame's.
};

} // namespace tactus
