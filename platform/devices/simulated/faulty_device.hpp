// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/wrapped_device.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace tactus
{

/// Faults of a device's readings. docs/simulated-device.md describes the controller's response to
/// each.
enum class DeviceFaultKind : std::uint8_t
{
    jitter,  ///< The position is off by up to kJitter_m on each axis, random in each reading.
    dropout, ///< The reading is not valid, with the last valid pose, velocities and time.
    /// The encoders stand still: position and rotation are the last ones and velocities 0, while
    /// time advances. The first reading afterwards has the whole displacement, with the velocity of
    /// that displacement in one period.
    stuck,
    nan,       ///< Pose, velocities and gripper are NaN but marked valid.
    time_jump, ///< The readings' time is ahead by kTimeJump, and falls back afterwards.
    /// The device does not answer and makes no force; idle afterwards, until the next write.
    disconnect,
};

/// A fault from reading `begin_frame`, counted from 0, for `frames` readings.
struct DeviceFault
{
    DeviceFaultKind kind{DeviceFaultKind::dropout};
    std::uint64_t begin_frame{0};
    std::uint64_t frames{0};

    [[nodiscard]] bool holds_at(std::uint64_t frame) const noexcept
    {
        return frame >= begin_frame && frame - begin_frame < frames;
    }
};

/// A device whose readings go wrong on a schedule. Simultaneous faults act in the order given. The
/// same device, faults and seed give the same readings. Threads as in HapticDevice.
class FaultyDevice final : public WrappedDevice
{
public:
    static constexpr double kJitter_m = 1e-4;
    static constexpr Duration kTimeJump = milliseconds(1'000);

    FaultyDevice(std::unique_ptr<HapticDevice> device, std::vector<DeviceFault> faults,
                 std::uint64_t seed = 1);

    [[nodiscard]] DeviceSample read() noexcept override;
    void write(const Wrench& wrench) noexcept override;

private:
    void spoil(DeviceFaultKind kind, DeviceSample& sample) noexcept;
    void shake(DeviceSample& sample) const noexcept;
    void leap(DeviceSample& sample) const noexcept;
    void drop_force() noexcept;

    std::vector<DeviceFault> faults_;
    std::uint64_t seed_;
    DeviceSample last_;    ///< Last valid sample returned.
    bool is_away_{false};  ///< True if disconnected at the last reading.
    bool is_stuck_{false}; ///< True if stuck at the last reading.
};

} // namespace tactus
