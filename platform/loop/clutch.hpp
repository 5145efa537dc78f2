// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/rotation.hpp"
#include "rt_core/records/device_record.hpp"

#include <cstdint>
#include <optional>

namespace tactus::hrtc
{

/// Button that decouples the tool from the device. While it is held the tool stays and the device
/// moves freely; after its release the tool follows the device again, from the tool's present pose.
/// So a small workspace reaches far. Haptic thread.
class Clutch
{
public:
    /// `button`: number of the button; none: no clutch, and the tool has the device's pose.
    explicit Clutch(std::optional<std::uint32_t> button) noexcept : button_(button) {}

    /// Pose of the tool for this device pose and these buttons, one bit a button. Both rotations
    /// are orthonormal to kRotationTolerance.
    [[nodiscard]] DevicePose tool_at(const DevicePose& device, std::uint32_t buttons) noexcept
    {
        const bool was_held = is_held_;
        is_held_ = button_ && ((buttons >> *button_) & 1U) != 0;
        if (!is_held_ && was_held)
        {
            offset_m_ = tool_.position_m - device.position_m;
            rotation_ = orthonormalised(device.rotation.transpose() * tool_.rotation);
        }
        has_parted_ = has_parted_ || is_held_;
        if (!is_held_ || !has_tool_)
        {
            tool_ = moved(device);
        }
        has_tool_ = true;
        return tool_;
    }

    [[nodiscard]] bool is_held() const noexcept { return is_held_; }
    /// True once the button has been held; device and tool poses differ from then on.
    [[nodiscard]] bool has_parted() const noexcept { return has_parted_; }

private:
    [[nodiscard]] DevicePose moved(const DevicePose& device) const noexcept
    {
        return has_parted_ ? DevicePose{device.position_m + offset_m_, device.rotation * rotation_}
                           : device;
    }

    std::optional<std::uint32_t> button_;
    bool is_held_{false};
    bool has_parted_{false};
    Vec3 offset_m_{0.0, 0.0, 0.0};    ///< Offset from device to tool, in the world.
    Mat3 rotation_{Mat3::Identity()}; ///< Rotation of the tool in the device's frame.
    DevicePose tool_;                 ///< Pose that tool_at() returned last.
    bool has_tool_{false};
};

} // namespace tactus::hrtc
