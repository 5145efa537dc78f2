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

/// Choice and description of a device of the DHD library.
struct DhdDeviceOptions
{
    static constexpr int kIndexMax = 63;
    static constexpr Duration kPeriodMin = microseconds(100);
    static constexpr Duration kPeriodMax = milliseconds(10);

    std::string library; ///< Path of libdhd.so; empty: found by the system's loader.
    int index{0};        ///< Index among the connected devices, up to kIndexMax.
    /// Description of the device in its own coordinates, since the SDK reports no limits. An empty
    /// name becomes the SDK's; a wrist, a gripper or motors that the device lacks are removed. The
    /// default limits suit all devices of the maker and assume the usual delay
    /// (docs/dhd-device.md); measure yours.
    DeviceInfo info{default_info()};
    /// Button, 0 to 15, that is pressed while the device is held; none: the device always counts as
    /// held.
    std::optional<int> deadman_button;
    /// Period of the I/O thread, in [kPeriodMin, kPeriodMax]; the SDK's calls may prolong it.
    Duration period{microseconds(250)};
    RemoteTimes times;
    DeviceFrame frame;
    RtThreadOptions thread{io_thread_options()}; ///< Options of the I/O thread.
    const Clock* clock{nullptr};                 ///< Borrowed; must outlive the device. Not null.

    [[nodiscard]] static DeviceInfo default_info();
};

/// A device of Force Dimension, driven by the maker's SDK, which is loaded at run time. Each SDK
/// call waits about 100 us for the device's bus, so only the I/O thread calls the SDK during the
/// loop. A device that stops answering is closed, and opened again as soon as it is found.
///
/// brake() takes effect in the I/O thread's next cycle: it sets zero force, then the device's own
/// brakes. While a call into the SDK hangs, only the device's own electronics can end the force. If
/// device and SDK have a watchdog, it is set to RemoteTimes::force_hold, 32 ms at most. It also
/// ends the force of a program that has died.
class DhdDevice final : public RemoteDevice
{
public:
    /// Loads the SDK, opens the device and starts the I/O thread; waits for the bus. Refuses
    /// options out of range, a missing SDK or device, an `info` with a fault (find_fault()) and all
    /// that RtThread::start() refuses. A null clock is a bug (asserted).
    [[nodiscard]] static Result<std::unique_ptr<DhdDevice>, Refusal>
    create(const DhdDeviceOptions& options);

    DhdDevice(const DhdDevice&) = delete;
    DhdDevice& operator=(const DhdDevice&) = delete;
    /// Ends the force and closes the device.
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
    /// Time of the device's own watchdog, in steps of 125 us.
    const std::uint8_t watchdog_steps_;
    std::atomic<bool> is_stopped_{false};

    // Used by the I/O thread.
    char id_;
    bool is_open_{true};
    bool is_new_{true};        ///< True if nothing was read since the device was opened.
    bool makes_forces_{false}; ///< True if brakes are off and forces enabled.
    MonotonicTime obeyed_;     ///< Time of the last command sent.

    /// Last member: the thread ends before all that it uses.
    std::optional<RtThread> thread_;
};

} // namespace tactus
