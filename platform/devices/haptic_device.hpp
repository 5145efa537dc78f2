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

/// Capabilities of a device. SI units, right-handed world frame; the device applies the
/// device-to-world transform, so device coordinates are never visible outside.
struct DeviceInfo
{
    std::string name;
    DeviceLimits limits; ///< Limits; the device itself clamps larger forces.
    std::array<double, 3> workspace_centre_world_m{};
    double workspace_radius_m{0.0}; ///< Radius of the workspace around that centre.
    double speed_max_m_per_s{0.0};  ///< Largest speed of a held device; faster: not held.
    std::int64_t rate_min_hz{0};    ///< Loop rates, both included.
    std::int64_t rate_max_hz{0};
    /// Gripper force in either direction; 0: no gripper with a motor.
    double gripper_force_max_n{0.0};

    [[nodiscard]] bool operator==(const DeviceInfo&) const = default;
};

/// One reading. `position_world_m` is the device position, which may be deep inside a model while
/// the proxy stays on the surface.
struct DeviceSample
{
    std::array<double, 3> position_world_m{};
    /// Velocity; none if not measured.
    std::optional<std::array<double, 3>> velocity_world_m_per_s;
    /// Time of the position, never before the last one; a simulated device counts frames x period
    /// from zero.
    MonotonicTime time;
    /// Number of the reading, from 0. A simulated device's motion depends only on it.
    std::uint64_t frame{0};
    /// False if the device had no trustworthy position; the others are then the last good ones.
    bool valid{false};
    bool connected{true}; ///< False: the device does not answer; then nothing is valid.
    /// False: a switch or sensor reports that it is not held. Always true without one.
    bool deadman_held{true};
    /// Rotation of the handle, as a quaternion x, y, z, w of length 1 to kRotationTolerance. None
    /// if not measured.
    std::optional<std::array<double, 4>> rotation_world;
    /// Angular velocity; none if not measured.
    std::optional<std::array<double, 3>> angular_velocity_world_rad_per_s;
    std::uint32_t buttons{0};        ///< Bit n is set while button n is pressed.
    std::optional<double> gripper_m; ///< Opening of the gripper; none without a gripper.
};

/// Number of buttons in DeviceSample.
inline constexpr std::uint32_t kButtons = 32;

/// Wrench of a device on the user, in the world's axes. A device without a torque renders the force
/// alone.
struct Wrench
{
    std::array<double, 3> force_world_n{};
    std::array<double, 3> torque_world_nm{}; ///< Torque about the device's position.
    double gripper_force_n{0.0};             ///< Force above 0 opens the gripper.

    [[nodiscard]] bool operator==(const Wrench&) const = default;
};

enum class DeviceState
{
    idle,  ///< No force: none was written yet, or the device's watchdog ended the last one.
    force, ///< The last written force is held until the next write, or the device's watchdog.
    brake  ///< Writes are ignored; the device damps its motion.
};

struct DeviceStatus
{
    DeviceState state{DeviceState::idle};
    double force_left{0.0};  ///< Fraction of the last written force while it brakes, 0 to 1.
    std::uint64_t frames{0}; ///< Number of readings.
    std::uint64_t forces_clamped{0}; ///< Writes beyond the device's limits.
    std::uint64_t forces_refused{0}; ///< Writes that were not finite; zero was written instead.
};

/// Duration of the fade of a soft brake, equal to that of ForceFader.
inline constexpr Duration kBrakeFade = milliseconds(50);

/// A device that the haptic thread reads and writes once a period. read(), write(), release_brake()
/// and status() belong to that thread; they never block, allocate or throw. brake() and
/// brake_softly() may be called from any thread at any time.
class HapticDevice
{
public:
    virtual ~HapticDevice() = default;

    /// Capabilities, constant over the device's life; any thread.
    [[nodiscard]] virtual const DeviceInfo& info() const noexcept = 0;

    /// Newest reading; without a new one the last again, with its time.
    [[nodiscard]] virtual DeviceSample read() noexcept = 0;

    /// Sets the wrench on the user, held until the next write. A device with a watchdog ends it if
    /// no write comes for too long, and is idle then. Force and torque are scaled by one factor to
    /// the device's limits, the gripper's force by another. If any value is not finite, the wrench
    /// is zero.
    virtual void write(const Wrench& wrench) noexcept = 0;

    /// Ends the force at once and damps the motion, even if the haptic thread hangs. It latches
    /// until release_brake(); braking again has no effect.
    virtual void brake() noexcept = 0;

    /// Brakes like brake(), but the force falls linearly over kBrakeFade. A device that can't do so
    /// brakes at once. brake() ends the fade.
    virtual void brake_softly() noexcept { brake(); }

    /// The next write takes effect again; until then the force is zero, or continues to fade.
    virtual void release_brake() noexcept = 0;

    [[nodiscard]] virtual DeviceStatus status() const noexcept = 0;

protected:
    HapticDevice() = default;
    HapticDevice(const HapticDevice&) = default;
    HapticDevice& operator=(const HapticDevice&) = default;
};

} // namespace tactus
