// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <cstdint>
#include <optional>

// One thread, the one that reads the device: the haptic thread. No call waits or allocates.
namespace tactus
{

/// What a hand knows when it decides where to go next: where the device is and what it pushes with.
struct HandSense
{
    std::uint64_t frame{0}; ///< Counts the decisions, from 1: frame 0 is the start itself.
    Vec3 device_world_m{Vec3::Zero()};
    Vec3 force_world_n{Vec3::Zero()};       ///< On the hand.
    Mat3 device_rotation{Mat3::Identity()}; ///< In the world.
    Vec3 torque_world_nm{Vec3::Zero()};     ///< On the hand.
};

/// What a hand does besides being somewhere.
struct HandGrip
{
    Mat3 rotation{Mat3::Identity()}; ///< Of the wrist, in the world; orthonormal to rounding.
    std::uint32_t buttons{0};        ///< Bit n is set while it presses button n.
    std::optional<double> gripper_m; ///< How far it opens the gripper, if it has one.
};

/// The human end of a simulated device: a place that the hand pulls the device towards through its
/// own springiness. Depends on the senses alone, never on a clock.
class HandMotion
{
public:
    virtual ~HandMotion() = default;

    /// Where the hand and the device rest before the first frame.
    [[nodiscard]] virtual Vec3 start_world_m() const noexcept = 0;

    /// Where the hand is at the end of this frame. Called once a frame; allocates nothing.
    [[nodiscard]] virtual Vec3 next_world_m(const HandSense& sense) noexcept = 0;

    /// The rest, at the end of the frame that next_world_m() has decided on last; before the first
    /// one as it rests at the start. Allocates nothing.
    [[nodiscard]] virtual HandGrip grip() const noexcept { return {}; }

protected:
    HandMotion() = default;
    HandMotion(const HandMotion&) = default;
    HandMotion& operator=(const HandMotion&) = default;
};

} // namespace tactus
