// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/rotation.hpp"
#include "rt_core/records/device_record.hpp"

#include <cstdint>
#include <optional>

namespace tactus::hrtc
{

/// A button that decouples the tool from the device: while it is held the tool stays and the device
/// moves freely; once it is released the tool follows the device again, from its present pose. So a
/// small workspace reaches far. Haptic thread.
class Clutch
{
public:
    /// Number of the button. None: no clutch, and the tool has the device's pose.
    explicit Clutch(std::optional<std::uint32_t> button) noexcept : button_(button) {}

    /// Pose of the tool for this device pose. Both rotations are orthonormal to kRotationTolerance.
    [[nodiscard]] DevicePose tool_at(const DevicePose& hand, std::uint32_t buttons) noexcept
    {
        const bool was_held = is_held_;
        is_held_ = button_ && ((buttons >> *button_) & 1U) != 0;
        if (!is_held_ && was_held)
        {
            offset_m_ = tool_.position_m - hand.position_m;
            turn_ = orthonormalised(hand.rotation.transpose() * tool_.rotation);
        }
        has_parted_ = has_parted_ || is_held_;
        if (!is_held_ || !has_tool_)
        {
            tool_ = moved(hand);
        }
        has_tool_ = true;
        return tool_;
    }

    [[nodiscard]] bool is_held() const noexcept { return is_held_; }
    /// True once device and tool have been decoupled.
    [[nodiscard]] bool has_parted() const noexcept { return has_parted_; }

private:
    [[nodiscard]] DevicePose moved(const DevicePose& hand) const noexcept
    {
        return has_parted_ ? DevicePose{hand.position_m + offset_m_, hand.rotation * turn_} : hand;
    }

    std::optional<std::uint32_t> button_;
    bool is_held_{false};
    bool has_parted_{false};
    Vec3 offset_m_{0.0, 0.0, 0.0}; ///< Offset from device to tool, in the world.
    Mat3 turn_{Mat3::Identity()};  ///< Rotation of the tool in the device's frame.
    DevicePose tool_;              ///< Last pose.
    bool has_tool_{false};
};

} // namespace tactus::hrtc
