// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"
#include "rt_core/records/device_limits.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace tactus
{

/// What a device can do. SI units, right-handed world frame; the device-to-world transform is
/// applied inside the device, so nobody else ever sees device coordinates.
struct DeviceInfo
{
    std::string name;
    DeviceLimits limits; ///< A device clamps longer forces than the largest by itself.
    std::array<double, 3> workspace_centre_world_m{};
    double workspace_radius_m{0.0}; ///< It reaches no point farther from that centre.
    double speed_max_m_per_s{0.0};  ///< Faster motion means that nobody holds it.
    std::int64_t rate_min_hz{0};    ///< Of the loop, both included.
    std::int64_t rate_max_hz{0};
    double gripper_force_max_n{0.0}; ///< Either way; 0: it has no gripper that makes a force.

    [[nodiscard]] bool operator==(const DeviceInfo&) const = default;
};

/// One reading. `position_world_m` is where the hand has moved the device, which may be deep inside
/// a model while the proxy stays on the surface.
struct DeviceSample
{
    std::array<double, 3> position_world_m{};
    /// None when the device does not measure it.
    std::optional<std::array<double, 3>> velocity_world_m_per_s;
    /// When the position was taken, never before the last one; a simulated device counts frames x
    /// period from zero.
    MonotonicTime time;
    /// Counts the readings, from 0. A simulated device's motion depends on it and nothing else.
    std::uint64_t frame{0};
    /// False when the device had no trustworthy position; the others are then the last good ones.
    bool valid{false};
    bool connected{true};    ///< False: the device does not answer; then nothing is valid.
    bool deadman_held{true}; ///< False: its switch or sensor says that nobody holds it. Without one
                             ///< always true.
    /// Of what the hand holds, as a quaternion x, y, z, w of length 1 to kRotationTolerance. None
    /// when it isn't measured.
    std::optional<std::array<double, 4>> rotation_world;
    /// None when the device does not measure it.
    std::optional<std::array<double, 3>> angular_velocity_world_rad_per_s;
    std::uint32_t buttons{0};        ///< Bit n is set while button n is pressed.
    std::optional<double> gripper_m; ///< How far it is open; none when there is none.
};

/// Of which DeviceSample tells.
inline constexpr std::uint32_t kButtons = 32;

/// What a device is to do to the hand, along the world's axes. A device without a torque takes the
/// force alone.
struct Wrench
{
    std::array<double, 3> force_world_n{};
    std::array<double, 3> torque_world_nm{}; ///< About the device's position.
    double gripper_force_n{0.0};             ///< Above 0 it opens the gripper.

    [[nodiscard]] bool operator==(const Wrench&) const = default;
};

enum class DeviceState
{
    idle,  ///< It makes no force: none was written yet, or its own watchdog ended the last one.
    force, ///< The last written force is held until the next write, or its own watchdog.
    brake  ///< Writes are ignored; the device damps its motion.
};

struct DeviceStatus
{
    DeviceState state{DeviceState::idle};
    double force_left{0.0};          ///< While it brakes: of the last written force, 0 to 1.
    std::uint64_t frames{0};         ///< Read so far.
    std::uint64_t forces_clamped{0}; ///< Writes beyond what the device makes.
    std::uint64_t forces_refused{0}; ///< Writes that were not finite; zero was written instead.
};

/// So long a force takes to fade where the brake is soft, as the SafeState's does.
inline constexpr Duration kBrakeFade = milliseconds(50);

/// A device that is read and written once a period by the haptic thread. read(), write(),
/// release_brake() and status() belong to that thread; they never block, allocate or throw.
/// brake() and brake_softly() may be called from any thread at any time.
class HapticDevice
{
public:
    virtual ~HapticDevice() = default;

    /// Constant over the device's life; any thread.
    [[nodiscard]] virtual const DeviceInfo& info() const noexcept = 0;

    /// The newest reading; without a new one the last again, with its time.
    [[nodiscard]] virtual DeviceSample read() noexcept = 0;

    /// What to do to the hand, held until the next write. A device with a watchdog of its own ends
    /// it when no write comes for too long, and is idle then. It shortens force and torque by one
    /// factor to what it makes of both, and the gripper's force by one of its own; where anything
    /// is not finite it makes nothing.
    virtual void write(const Wrench& wrench) noexcept = 0;

    /// Takes the force away at once and damps the motion, whatever the haptic thread is doing or
    /// failing to do. It latches until release_brake(); braking again changes nothing.
    virtual void brake() noexcept = 0;

    /// Likewise, but the force falls in a straight line over kBrakeFade. A device that can't do so
    /// by itself brakes at once. brake() ends it.
    virtual void brake_softly() noexcept { brake(); }

    /// The next write counts again; until it comes the force is zero, or goes on fading.
    virtual void release_brake() noexcept = 0;

    [[nodiscard]] virtual DeviceStatus status() const noexcept = 0;

protected:
    HapticDevice() = default;
    HapticDevice(const HapticDevice&) = default;
    HapticDevice& operator=(const HapticDevice&) = default;
};

} // namespace tactus
