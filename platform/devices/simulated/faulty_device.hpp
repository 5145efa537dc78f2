// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/wrapped_device.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace tactus
{

/// What goes wrong with a device's readings. docs/simulated-device.md says what the controller
/// makes of each.
enum class DeviceFaultKind : std::uint8_t
{
    jitter,  ///< The position is wrong by up to kJitter_m on each axis, anew in each reading.
    dropout, ///< Nothing trustworthy: not valid, with what was good last.
    /// The encoders stand still: the last position and rotation, velocity 0, while time goes on. In
    /// the first reading afterwards the whole way is there, and the velocity that it makes in one
    /// period.
    stuck,
    nan,        ///< Place, velocities, gripper are no numbers, and it says they were valid.
    time_jump,  ///< The readings' time is ahead by kTimeJump, and falls back afterwards.
    disconnect, ///< It does not answer and makes no force; idle afterwards, until the next write.
};

/// From reading `begin_frame`, which counts from 0, for `frames` readings.
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

/// A device as it is, but for readings that go wrong on a schedule. Faults at the same time act in
/// the order given. The same device, faults and seed give the same readings. Threads as the device.
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
    DeviceSample last_;    ///< The last valid one that was given out.
    bool is_away_{false};  ///< Disconnected, as of the last reading.
    bool is_stuck_{false}; ///< Likewise.
};

} // namespace tactus
