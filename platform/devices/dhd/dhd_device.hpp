// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/dhd/dhd_library.hpp"
#include "platform/devices/remote/remote_device.hpp"
#include "platform/machine/rt_thread.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace tactus
{

struct DhdDeviceOptions
{
    static constexpr int kIndexMax = 63;
    static constexpr Duration kPeriodMin = microseconds(100);
    static constexpr Duration kPeriodMax = milliseconds(10);

    std::string library; ///< Path of libdhd.so; empty: where the system's loader finds it.
    int index{0};        ///< Which of the devices that are plugged in, up to kIndexMax.
    /// What the device is, in its own coordinates: the SDK doesn't tell. An empty name becomes the
    /// SDK's; what the device hasn't, a wrist or a gripper or motors there, is taken off. The
    /// default is small and weak enough for any of the maker's devices, and assumes their usual
    /// delay (docs/dhd-device.md); measure yours.
    DeviceInfo info{default_info()};
    /// The button, 0 to 15, that says that somebody holds it; none: somebody always does.
    std::optional<int> deadman_button;
    /// Of the I/O thread's turns, in [kPeriodMin, kPeriodMax]; the SDK's calls may make them
    /// longer.
    Duration period{microseconds(250)};
    RemoteTimes times;
    DeviceFrame frame;
    RtThreadOptions thread{io_thread_options()}; ///< The I/O thread.
    const Clock* clock{nullptr};                 ///< Lent; it outlives the device. Not null.

    [[nodiscard]] static DeviceInfo default_info();
};

/// One of Force Dimension's devices, by its maker's SDK, which is loaded at run time. All of its
/// calls wait for the device's bus, some 100 us each, so they belong to the I/O thread. A device
/// that doesn't answer any more is closed and looked for again ten times a second.
///
/// brake() is acted on in the I/O thread's next turn: it sets zero force, then the device's own
/// brakes. While a call into the SDK hangs nobody can do so; the device's own electronics must end
/// the force then. Its watchdog is set to the time of a force's hold, as far as device and SDK have
/// one; it ends the force of a program that has died, too.
class DhdDevice final : public RemoteDevice
{
public:
    /// Loads the SDK, opens the device and starts the I/O thread; waits for the bus. Refuses
    /// options out of range, a missing SDK or device, an `info` beyond the ranges of DeviceLimits
    /// and what RtThread::start() refuses. A null clock is a bug (asserted).
    [[nodiscard]] static Result<std::unique_ptr<DhdDevice>, Refusal>
    create(const DhdDeviceOptions& options);

    DhdDevice(const DhdDevice&) = delete;
    DhdDevice& operator=(const DhdDevice&) = delete;
    /// Takes the force away and closes the device.
    ~DhdDevice() override;

    [[nodiscard]] const RtThreadReport& thread_report() const noexcept { return thread_->report(); }

private:
    static constexpr Duration kReopen = milliseconds(100);

    DhdDevice(DhdLibrary library, char id, const DeviceInfo& info, const DhdDeviceOptions& options);

    void run() noexcept;
    [[nodiscard]] bool turn() noexcept;
    [[nodiscard]] bool publish_reading() noexcept;
    void read_wrist_and_gripper(DeviceReading& reading) const noexcept;
    [[nodiscard]] bool set_force(const DeviceCommand& command) const noexcept;
    [[nodiscard]] bool obey(const DeviceCommand& command) noexcept;
    [[nodiscard]] bool is_held() const noexcept;
    void lose() noexcept;
    void find_again() noexcept;

    const DhdLibrary library_;
    const char index_;
    const std::optional<int> deadman_button_;
    const bool has_wrist_;
    const bool has_gripper_;
    const Duration period_;
    const std::uint8_t watchdog_steps_; ///< Of the device's own watchdog.
    std::atomic<bool> is_stopped_{false};

    // The I/O thread's.
    char id_;
    bool is_open_{true};
    bool is_new_{true};        ///< Nothing was read since it was opened.
    bool makes_forces_{false}; ///< Brakes are off, forces enabled.
    MonotonicTime obeyed_;     ///< When the device was last told a force.

    std::optional<RtThread> thread_; ///< Ends before anything that it uses.
};

} // namespace tactus
