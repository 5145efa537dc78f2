// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/haptic_device.hpp"
#include "platform/loop/tool_port.hpp"
#include "platform/machine/time.hpp"
#include "platform/world/world_parts.hpp"
#include "rt_core/base/mailbox.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

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

/// True while the calling thread is in a callback or device of a program: calls of the World that
/// may wait are refused there.
[[nodiscard]] bool is_in_callback() noexcept;

/// Marks the calling thread as in a callback or device of a program.
class CallbackScope
{
public:
    CallbackScope() noexcept;
    CallbackScope(const CallbackScope&) = delete;
    CallbackScope& operator=(const CallbackScope&) = delete;
    ~CallbackScope();
};

/// Device of a program's own class, which the program may keep, too.
class SharedDevice final : public HapticDevice
{
public:
    explicit SharedDevice(std::shared_ptr<HapticDevice> device) : device_(std::move(device)) {}

    [[nodiscard]] const DeviceInfo& info() const noexcept override { return device_->info(); }
    [[nodiscard]] DeviceSample read() noexcept override;
    void write(const Wrench& wrench) noexcept override;
    void brake() noexcept override;
    void brake_softly() noexcept override;
    void release_brake() noexcept override;
    [[nodiscard]] DeviceStatus status() const noexcept override;

private:
    std::shared_ptr<HapticDevice> device_;
};

/// External force from a program's callback. Its throws and long calls are counted.
class CallbackForce final : public ExternalForceSource
{
public:
    /// Calls longer than `longest` are counted as overruns.
    CallbackForce(HandForce force, Duration longest) : force_(std::move(force)), longest_(longest)
    {
    }

    [[nodiscard]] ExternalForce next(const DeviceSample& sample, const ToolState& tool,
                                     const ToolOutput& output) noexcept override;

    [[nodiscard]] std::uint64_t throws() const noexcept
    {
        return throws_.load(std::memory_order_relaxed);
    }
    [[nodiscard]] std::uint64_t overruns() const noexcept
    {
        return overruns_.load(std::memory_order_relaxed);
    }

private:
    HandForce force_;
    Duration longest_;
    std::atomic<std::uint64_t> throws_{0};   ///< Relaxed: for display only.
    std::atomic<std::uint64_t> overruns_{0}; ///< Relaxed: for display only.
};

} // namespace tactus::hrtc
