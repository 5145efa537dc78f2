// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/haptic_device.hpp"
#include "platform/machine/time.hpp"
#include "rt_core/base/mailbox.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>

namespace tactus::hrtc
{

/// Device that a program moves: its reading is the newest pose of hold(). The program passes the
/// force on by itself, so a brake has nothing to do but to be released.
class HeldDevice final : public HapticDevice
{
public:
    explicit HeldDevice(const DeviceLimits& limits);

    /// Any thread but the haptic one: sets the pose, as of `time` on the clock of the loop. The
    /// rotation must have length 1 to kRotationTolerance.
    void hold(const std::array<double, 3>& position_m, const std::array<double, 4>& rotation,
              MonotonicTime time);
    /// Between frames of a stepped loop: the last pose holds at `time`, too.
    void keep_until(MonotonicTime time);

    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
    [[nodiscard]] DeviceSample read() noexcept override;
    void write(const Wrench& wrench) noexcept override;
    void brake() noexcept override { is_braked_.store(true); }
    void release_brake() noexcept override { is_braked_.store(false); }
    [[nodiscard]] DeviceStatus status() const noexcept override;

private:
    struct Held
    {
        std::array<double, 3> position_m{};
        std::array<double, 4> rotation{};
        std::int64_t time_ns{0};
    };

    DeviceInfo info_;
    std::mutex writers_; ///< Guards held_ and the writer's side of mailbox_.
    Held held_;
    bool is_held_{false};
    Mailbox<Held> mailbox_;
    DeviceSample sample_;
    DeviceStatus status_;
    std::atomic<bool> is_braked_{false};
};

} // namespace tactus::hrtc
