// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <cstdint>
#include <optional>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Where a hand holds its device. World frame.
struct HandPlace
{
    Vec3 position_m{0.0, 0.0, 0.0};
    Mat3 rotation{Mat3::Identity()};
};

/// What passed between one tool and its device in a frame, beside the ToolState that the frame got:
/// for recordings. World frame, SI.
struct DeviceRecord
{
    bool connected{true};
    bool deadman_held{true};
    /// Where a clutch has parted tool and hand: ToolState has the tool's place.
    std::optional<HandPlace> hand;
    std::optional<Vec3> velocity_m_per_s;
    std::optional<Vec3> angular_velocity_rad_per_s;
    std::uint32_t buttons{0};
    std::optional<double> gripper_m;
    bool measures_rotation{false}; ///< Else the ToolState's rotation is none of the device's.
    /// To the device, as what follows; beside what carries a load.
    Vec3 sent_n{0.0, 0.0, 0.0};
    Vec3 sent_nm{0.0, 0.0, 0.0};
    double sent_gripper_n{0.0};
};

} // namespace tactus
