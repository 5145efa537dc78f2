// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/brake_latch.hpp"
#include "platform/devices/device_frame.hpp"
#include "platform/devices/haptic_device.hpp"
#include "platform/devices/remote/remote_values.hpp"
#include "platform/machine/clock.hpp"
#include "rt_core/base/mailbox.hpp"

#include <atomic>
#include <cstdint>
#include <optional>

namespace tactus
{

/// The I/O thread's reading of a device, in the device's coordinates.
struct DeviceReading
{
    Vec3 position_m{Vec3::Zero()};
    std::optional<Vec3> velocity_m_per_s;
    MonotonicTime time;    ///< Time of the position, on the controller's clock.
    MonotonicTime arrival; ///< Time of the reading's arrival, on the same clock.
    bool valid{false};     ///< False: pose, velocities, gripper and time are ignored.
    bool deadman_held{true};
    std::optional<Quaternion> rotation; ///< Rotation as a unit quaternion.
    std::optional<Vec3> angular_velocity_rad_per_s;
    std::uint32_t buttons{0};
    std::optional<double> gripper_m;
};

/// Present command for the device, in its own coordinates.
struct DeviceCommand
{
    /// Force, torque and gripper force are zero in all states except `force`.
    Vec3 force_n{Vec3::Zero()};
    Vec3 torque_nm{Vec3::Zero()};
    double gripper_force_n{0.0};
    DeviceState state{DeviceState::idle};
    MonotonicTime written; ///< Time of the write; the present time during a fade.
};

/// Base of devices that wait for a network or a bus. A subclass waits on an I/O thread of its own;
/// two mailboxes connect it to the haptic thread. So read(), write(), release_brake() and status()
/// make no system call, and cost about 100 ns and two clock readings at most.
///
///     haptic thread                                I/O thread
///     read()   <-- mailbox of readings    <-- publish(), detach()
///     write()  --> mailbox of commands    --> command()
///
/// Each reconnection is a new attachment, even of the same device. A force written for an earlier
/// attachment is never sent to the device, and status() is `idle` until the next write.
class RemoteDevice : public HapticDevice
{
public:
    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
    /// Newest reading; without a new one the last reading again, with its time.
    [[nodiscard]] DeviceSample read() noexcept override;
    void write(const Wrench& wrench) noexcept override;
    /// Takes effect in the I/O thread's next cycle; subclasses may act earlier.
    void brake() noexcept override;
    /// The I/O thread lowers the force over kBrakeFade.
    void brake_softly() noexcept override;
    void release_brake() noexcept override;
    [[nodiscard]] DeviceStatus status() const noexcept override;

protected:
    /// `device`: description in the device's own coordinates. `clock`: borrowed, must outlive this
    /// object.
    RemoteDevice(const DeviceInfo& device, const DeviceFrame& frame, const RemoteTimes& times,
                 const Clock& clock);

    /// I/O thread: passes a reading to read(). `is_new`: the reading begins a new attachment.
    void publish(const DeviceReading& reading, bool is_new) noexcept;
    /// I/O thread: ends the attachment, even if the last reading is new.
    void detach() noexcept;
    /// I/O thread: command for the device now. Call just before sending.
    [[nodiscard]] DeviceCommand command() noexcept;
    [[nodiscard]] const Clock& clock() const noexcept { return clock_; }

private:
    struct Reading
    {
        DeviceSample sample; ///< Sample in the world; frame and connected are set by read().
        MonotonicTime arrival;
        std::uint64_t attachment{0}; ///< Number of the attachment, from 1; 0: none yet.
        bool attached{false};
    };
    struct Command
    {
        Wrench wrench;
        MonotonicTime written;
        std::uint64_t attachment{0}; ///< Number of the attachment at the write.
        /// Value of `releases_` at the write; a later release voids the force.
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
    std::atomic<std::uint64_t> releases_{0}; ///< Number of releases; sequentially consistent.

    // Used by the haptic thread.
    Reading reading_;
    bool connected_{false}; ///< Connection state at the last read().
    Command written_;
    DeviceStatus status_;

    // Used by the I/O thread.
    Reading published_;
    Command taken_;
};

} // namespace tactus
