// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/brake_latch.hpp"
#include "platform/devices/device_frame.hpp"
#include "platform/devices/haptic_device.hpp"
#include "platform/machine/clock.hpp"
#include "platform/machine/rt_thread.hpp"
#include "rt_core/base/mailbox.hpp"

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

namespace tactus
{

/// Times after which a device counts as disconnected and a force as expired.
struct RemoteTimes
{
    static constexpr Duration kMin{1'000'000};
    static constexpr Duration kMax{60'000'000'000};

    /// Time without a sample until it is not connected, equal to the longest that a frame uses an
    /// old one.
    Duration silence{milliseconds(20)};
    /// Time after a write until the force ends: the watchdog against a haptic thread that hangs.
    Duration force_hold{milliseconds(20)};
};

/// Options of an I/O thread: below the haptic thread's priority, above all others; it runs without
/// real-time rights, too.
[[nodiscard]] RtThreadOptions io_thread_options();

/// Empty if both are in [RemoteTimes::kMin, RemoteTimes::kMax]; otherwise one line.
[[nodiscard]] std::string find_bad_time(const RemoteTimes& times);

/// The I/O thread's reading of a device, in the device's coordinates.
struct DeviceReading
{
    Vec3 position_m{Vec3::Zero()};
    std::optional<Vec3> velocity_m_per_s;
    MonotonicTime time;    ///< Time of the position, on the controller's clock.
    MonotonicTime arrival; ///< Time of its arrival.
    bool valid{false};     ///< False: the position is ignored; the last good one stays.
    bool deadman_held{true};
    std::optional<Quaternion> rotation; ///< Rotation as a unit quaternion.
    std::optional<Vec3> angular_velocity_rad_per_s;
    std::uint32_t buttons{0};
    std::optional<double> gripper_m;
};

/// Present command for the device, in its own coordinates.
struct DeviceCommand
{
    Vec3 force_n{Vec3::Zero()}; ///< Zero in all states except `force`, like those below.
    Vec3 torque_nm{Vec3::Zero()};
    double gripper_force_n{0.0};
    DeviceState state{DeviceState::idle};
    MonotonicTime written; ///< Time of the write, which distinguishes writes.
};

/// The haptic thread's half of a device whose other half waits for a network or a bus. That half
/// has its own I/O thread, with a mailbox in each direction. So read(), write(), release_brake()
/// and status() make no system call, and cost some 100 ns and two clock readings at most.
///
///     haptic thread                                I/O thread
///     read()   <-- mailbox of readings    <-- publish(), detach()
///     write()  --> mailbox of commands    --> command()
///
/// A device that returns is a new attachment, even if it is the same device: a force written for an
/// earlier attachment is never sent to it, and status() is `idle` until the next write.
class RemoteDevice : public HapticDevice
{
public:
    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
    /// Newest reading. Without a new one since the last call the last again, with its time.
    [[nodiscard]] DeviceSample read() noexcept override;
    void write(const Wrench& wrench) noexcept override;
    /// The I/O thread brakes in its next cycle; subclasses may act earlier.
    void brake() noexcept override;
    /// The I/O thread fades the force.
    void brake_softly() noexcept override;
    void release_brake() noexcept override;
    [[nodiscard]] DeviceStatus status() const noexcept override;

protected:
    /// `device` describes itself in its own coordinates. `clock` is borrowed and outlives this.
    RemoteDevice(const DeviceInfo& device, const DeviceFrame& frame, const RemoteTimes& times,
                 const Clock& clock);

    /// I/O thread. `is_new`: the device was not connected before this reading.
    void publish(const DeviceReading& reading, bool is_new) noexcept;
    /// I/O thread: the device is gone, even if the last reading is new.
    void detach() noexcept;
    /// I/O thread, just before it sends.
    [[nodiscard]] DeviceCommand command() noexcept;
    [[nodiscard]] const Clock& clock() const noexcept { return clock_; }

private:
    struct Reading
    {
        DeviceSample sample; ///< Sample in the world; frame and connected are set by read().
        MonotonicTime arrival;
        std::uint64_t attachment{0}; ///< Number of the attachment, from 1; 0: there was none.
        bool attached{false};
    };
    struct Command
    {
        Wrench wrench;
        MonotonicTime written;
        std::uint64_t attachment{0}; ///< Attachment at the write.
        /// Number of brakes released before; a force from before is void.
        std::uint64_t release{0};
        DeviceState state{DeviceState::idle};
    };

    [[nodiscard]] bool makes_force(const Command& command, std::uint64_t attachment,
                                   MonotonicTime now) const noexcept;

    const DeviceInfo info_;
    const DeviceFrame frame_;
    const RemoteTimes times_;
    const Clock& clock_;

    Mailbox<Reading> readings_; ///< Mailbox written by the I/O thread.
    Mailbox<Command> commands_; ///< Mailbox written by the haptic thread.
    BrakeLatch brake_;
    std::atomic<std::uint64_t> releases_{0}; ///< Sequentially consistent: it is rare.

    // Used by the haptic thread.
    Reading reading_;
    bool connected_{false}; ///< State at the last read.
    Command written_;
    DeviceStatus status_;

    // Used by the I/O thread.
    Reading published_;
    Command taken_;
};

} // namespace tactus
