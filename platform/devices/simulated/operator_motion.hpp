// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <cstdint>
#include <optional>

// One thread, the one that reads the device: the haptic thread. No call waits or allocates.
namespace tactus
{

/// Input of a hand's next decision: the device's state and force.
struct OperatorSense
{
    std::uint64_t frame{0}; ///< Number of the decision, from 1; frame 0 is the start.
    Vec3 device_world_m{Vec3::Zero()};
    Vec3 force_world_n{Vec3::Zero()};       ///< Force on the hand.
    Mat3 device_rotation{Mat3::Identity()}; ///< Rotation of the device in the world.
    Vec3 torque_world_nm{Vec3::Zero()};     ///< Torque on the hand.
};

/// State of a hand besides its position.
struct OperatorGrip
{
    /// Rotation of the wrist, in the world; orthonormal to rounding.
    Mat3 rotation{Mat3::Identity()};
    std::uint32_t buttons{0};        ///< Bit n is set while the hand presses button n.
    std::optional<double> gripper_m; ///< Opening of the gripper; none without one.
};

/// Motion of a simulated operator: the target to which the hand pulls the device through its own
/// compliance (OperatorAndDevice). Depends on its OperatorSense inputs alone, never on a clock.
class OperatorMotion
{
public:
    virtual ~OperatorMotion() = default;

    /// Initial position of hand and device.
    [[nodiscard]] virtual Vec3 start_world_m() const noexcept = 0;

    /// Position of the hand at the end of this frame. Called once a frame; allocates nothing.
    [[nodiscard]] virtual Vec3 next_world_m(const OperatorSense& sense) noexcept = 0;

    /// Grip at the end of the frame of the last next_world_m(); before the first call, the initial
    /// grip. Allocates nothing.
    [[nodiscard]] virtual OperatorGrip grip() const noexcept { return {}; }

protected:
    OperatorMotion() = default;
    OperatorMotion(const OperatorMotion&) = default;
    OperatorMotion& operator=(const OperatorMotion&) = default;
};

} // namespace tactus
