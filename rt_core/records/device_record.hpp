// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <cstdint>
#include <optional>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Position and rotation at which the user holds the device. World frame.
struct DevicePose
{
    Vec3 position_m{0.0, 0.0, 0.0};
    Mat3 rotation{Mat3::Identity()};
};

/// Data exchanged between one tool and its device in a frame, in addition to the frame's ToolState;
/// for recordings. World frame, SI.
struct DeviceRecord
{
    bool connected{true};
    bool deadman_held{true};
    /// Device pose while a clutch separates tool and device. If empty, ToolState has the device
    /// pose.
    std::optional<DevicePose> pose;
    std::optional<Vec3> velocity_m_per_s;
    std::optional<Vec3> angular_velocity_rad_per_s;
    std::uint32_t buttons{0};
    std::optional<double> gripper_m;
    bool measures_rotation{false}; ///< False: the ToolState's rotation is not the device's.
    /// Force, torque and gripper force sent to the device, without payload compensation.
    Vec3 sent_n{0.0, 0.0, 0.0};
    Vec3 sent_nm{0.0, 0.0, 0.0};
    double sent_gripper_n{0.0};
};

} // namespace tactus
