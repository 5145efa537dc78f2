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

/// When a device counts as gone and when a force as forgotten.
struct RemoteTimes
{
    static constexpr Duration kMin{1'000'000};
    static constexpr Duration kMax{60'000'000'000};

    /// So long without a sample it isn't connected. As long as a frame goes on with an old one.
    Duration silence{milliseconds(20)};
    /// So long after a write the force ends: the watchdog against a haptic thread that hangs.
    Duration force_hold{milliseconds(20)};
};

/// Of an I/O thread: below the haptic thread's priority, above everything else; it runs without
/// real-time rights, too.
[[nodiscard]] RtThreadOptions io_thread_options();

/// Empty when both are in [RemoteTimes::kMin, RemoteTimes::kMax]; else one line.
[[nodiscard]] std::string find_bad_time(const RemoteTimes& times);

/// What the I/O thread has of a device, in the device's coordinates.
struct DeviceReading
{
    Vec3 position_m{Vec3::Zero()};
    std::optional<Vec3> velocity_m_per_s;
    MonotonicTime time;    ///< When the position was taken, on the controller's clock.
    MonotonicTime arrival; ///< When it was here.
    bool valid{false};     ///< False: the place counts for nothing; the last good one stays.
    bool deadman_held{true};
    std::optional<Quaternion> rotation; ///< A unit quaternion.
    std::optional<Vec3> angular_velocity_rad_per_s;
    std::uint32_t buttons{0};
    std::optional<double> gripper_m;
};

/// What the device has to do now, in its own coordinates.
struct DeviceCommand
{
    Vec3 force_n{Vec3::Zero()}; ///< Zero in all states but `force`, as what follows.
    Vec3 torque_nm{Vec3::Zero()};
    double gripper_force_n{0.0};
    DeviceState state{DeviceState::idle};
    MonotonicTime written; ///< Tells one write from the next.
};

/// The haptic thread's half of a device whose other half waits: for a network, for a bus. That one
/// has a thread of its own, the I/O thread, and a mailbox leads each way. So read(), write(),
/// release_brake() and status() make no system call, and cost some 100 ns and two looks at the
/// clock at most.
///
///     haptic thread                                I/O thread
///     read()   <-- mailbox of readings    <-- publish(), detach()
///     write()  --> mailbox of commands    --> command()
///
/// A device that was gone is another attachment when it is back, even if it is the same: a force
/// that was written for the one before it is never sent to it, and status() says `idle` until the
/// next write.
class RemoteDevice : public HapticDevice
{
public:
    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
    /// The newest reading. When none has come since the last call that one again, with its time.
    [[nodiscard]] DeviceSample read() noexcept override;
    void write(const Wrench& wrench) noexcept override;
    /// The I/O thread acts on it in its next turn; what is done before that, a subclass says.
    void brake() noexcept override;
    /// The I/O thread fades the force.
    void brake_softly() noexcept override;
    void release_brake() noexcept override;
    [[nodiscard]] DeviceStatus status() const noexcept override;

protected:
    /// `device` describes itself in its own coordinates. `clock` is lent and outlives this.
    RemoteDevice(const DeviceInfo& device, const DeviceFrame& frame, const RemoteTimes& times,
                 const Clock& clock);

    /// I/O thread. `is_new`: the device wasn't there before this reading.
    void publish(const DeviceReading& reading, bool is_new) noexcept;
    /// I/O thread: the device is known to be gone, however new the last reading is.
    void detach() noexcept;
    /// I/O thread, just before it sends.
    [[nodiscard]] DeviceCommand command() noexcept;
    [[nodiscard]] const Clock& clock() const noexcept { return clock_; }

private:
    struct Reading
    {
        DeviceSample sample; ///< In the world; frame and connected are read()'s.
        MonotonicTime arrival;
        std::uint64_t attachment{0}; ///< Counts them from 1; 0: there was none.
        bool attached{false};
    };
    struct Command
    {
        Wrench wrench;
        MonotonicTime written;
        std::uint64_t attachment{0}; ///< The one that it was written for.
        std::uint64_t release{0};    ///< Brakes released before; a force from before is void.
        DeviceState state{DeviceState::idle};
    };

    [[nodiscard]] bool makes_force(const Command& command, std::uint64_t attachment,
                                   MonotonicTime now) const noexcept;

    const DeviceInfo info_;
    const DeviceFrame frame_;
    const RemoteTimes times_;
    const Clock& clock_;

    Mailbox<Reading> readings_; ///< Written by the I/O thread.
    Mailbox<Command> commands_; ///< Written by the haptic thread.
    BrakeLatch brake_;
    std::atomic<std::uint64_t> releases_{0}; ///< Sequentially consistent: it is rare.

    // The haptic thread's.
    Reading reading_;
    bool connected_{false}; ///< At the last read.
    Command written_;
    DeviceStatus status_;

    // The I/O thread's.
    Reading published_;
    Command taken_;
};

} // namespace tactus
