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

/// What acted on a force on its way to the device.
enum class ForceAction : std::uint8_t
{
    none = 0,
    refused = 1U << 0U,          ///< Force or stiffness was no usable number: the force is zero.
    stiffness_capped = 1U << 1U, ///< Stiffer than stiffness_cap_n_per_m(): scaled down to it.
    clamped = 1U << 2U,          ///< Longer than DeviceLimits::force_max_n.
    change_limited = 1U << 3U,   ///< It wanted to change faster than ChangeLimit lets it.
    damped = 1U << 4U,           ///< The passivity controller added damping.
    /// Energy not observed: the position was no number or jumped. Observed wrongly: the device's
    /// delay is longer than kForcesUnderWay tell.
    blind = 1U << 5U,
};

inline constexpr std::size_t kForceActions = 6;
static_assert(static_cast<std::uint32_t>(ForceAction::blind) == 1U << (kForceActions - 1));
/// In the order of ForceAction's bits.
inline constexpr std::array<const char*, kForceActions> kForceActionNames{
    "refused", "stiffness_capped", "clamped", "change_limited", "damped", "blind"};

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

/// The force of a spring on a hand, or in angles its torque: N m for N, rad for m. World frame, SI.
struct SpringForce
{
    Vec3 force_n{0.0, 0.0, 0.0}; ///< On the hand.
    /// Of the wall that the force comes from; finite, >= 0, else ForceAction::refused. 0: it comes
    /// from no wall and its energy isn't judged. Behind the conditioner: in use after the cap.
    double stiffness_n_per_m{0.0};
    /// Between proxy and device. Where the force was cut to a limit before it came here, the spring
    /// holds more energy than the force tells; 0: take force / stiffness.
    double stretch_m{0.0};
    ForceAction actions{ForceAction::none};
    double damping_n_s_per_m{0.0}; ///< That the passivity controller added.
    double work_j{0.0};            ///< Done on hand and device since the start.
    /// Energy that came from nowhere and is not lost yet: PassivityObserver::surplus_j().
    double surplus_j{0.0};
};

/// Force and torque of one tool on their way from the frame to the device: each stage of a
/// ForcePipeline changes it, and what it is behind the last one is sent.
struct ToolForce
{
    SpringForce push;            ///< Of surfaces and program.
    SpringForce turn;            ///< Their torque, in angles. Nothing where none is made.
    Vec3 load_n{0.0, 0.0, 0.0};  ///< What carries a load, sent beside that: its force,
    Vec3 load_nm{0.0, 0.0, 0.0}; ///< and its torque.
    double gripper_n{0.0};       ///< Of the program.
    double own_n{0.0};           ///< How much force the program wanted: OwnForce.
    double twist_rad{0.0};       ///< Between device and proxy, in contact.
    SafetyState state{SafetyState::reset};
    ForceOff causes{ForceOff::none}; ///< Why less than the frame's goes out.
    bool has_changed{false};         ///< State or causes are others than in the frame before.
};

} // namespace tactus
