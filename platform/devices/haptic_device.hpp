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
    DeviceLimits limits; ///< Limits, in the world; the device clamps larger forces.
    std::array<double, 3> workspace_centre_world_m{};
    double workspace_radius_m{0.0}; ///< Radius of the workspace around its centre.
    double speed_max_m_per_s{0.0};  ///< Largest speed of a held device; above it the force fades.
    std::int64_t rate_min_hz{0};    ///< Lowest and highest supported loop rate.
    std::int64_t rate_max_hz{0};
    /// Gripper force in either direction; 0: no gripper with a motor.
    double gripper_force_max_n{0.0};

    [[nodiscard]] bool operator==(const DeviceInfo&) const = default;
};

/// One reading of a device. `position_world_m` is the device position, which may be deep inside a
/// model while the proxy stays on the surface.
struct DeviceSample
{
    std::array<double, 3> position_world_m{};
    /// Velocity; none if not measured.
    std::optional<std::array<double, 3>> velocity_world_m_per_s;
    /// Time of the position, never before that of the last reading. A simulated device counts
    /// integrated periods from 0.
    MonotonicTime time;
    /// Number of the reading, from 0. A simulated device without a clock moves by this number
    /// alone.
    std::uint64_t frame{0};
    /// False if the device had no trustworthy position. Pose, velocities and time are then the last
    /// valid ones.
    bool valid{false};
    bool connected{true}; ///< False: the device does not answer; `valid` is false, too.
    /// False: a switch or sensor reports that no hand holds the device. Always true without one.
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

/// Wrench of a device on the user, along the world's axes. A device without torque motors renders
/// the force alone.
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
    force, ///< The last written force is held until the next write or the watchdog.
    brake  ///< Writes are ignored; the device damps its motion.
};

/// State and counts of a device since its start.
struct DeviceStatus
{
    DeviceState state{DeviceState::idle};
    double force_left{0.0};          ///< Fraction of the last written force during a brake, 0 to 1.
    std::uint64_t frames{0};         ///< Number of readings.
    std::uint64_t forces_clamped{0}; ///< Number of writes beyond the device's limits.
    std::uint64_t forces_refused{0}; ///< Number of non-finite writes; each rendered zero.
};

/// Duration of the fade of brake_softly(). Must equal kFadeTime_s, that of ForceFader (asserted).
inline constexpr Duration kBrakeFade = milliseconds(50);

/// A device that the haptic thread reads and writes once a period. read(), write(), release_brake()
/// and status() are called by that thread only; they never block, allocate or throw. brake() and
/// brake_softly() may be called from any thread at any time.
class HapticDevice
{
public:
    virtual ~HapticDevice() = default;

    /// Capabilities, constant over the device's life; any thread.
    [[nodiscard]] virtual const DeviceInfo& info() const noexcept = 0;

    /// Returns the newest reading; if there is no new one, the last reading again, with its time.
    [[nodiscard]] virtual DeviceSample read() noexcept = 0;

    /// Sets the wrench on the user, which is held until the next write. A device with a watchdog
    /// ends the wrench and becomes idle if writes stop. One factor scales force and torque to the
    /// device's limits; the gripper's force is clamped on its own. If any value is not finite, the
    /// wrench is zero.
    virtual void write(const Wrench& wrench) noexcept = 0;

    /// Ends the force at once and damps the motion, even if the haptic thread hangs. The brake
    /// holds until release_brake(); a second call has no effect.
    virtual void brake() noexcept = 0;

    /// Brakes like brake(), but the force falls linearly over kBrakeFade; brake() ends that fade. A
    /// device without a fade brakes at once.
    virtual void brake_softly() noexcept { brake(); }

    /// Lets the next write take effect again. Until that write the force is zero, or a fade
    /// continues.
    virtual void release_brake() noexcept = 0;

    [[nodiscard]] virtual DeviceStatus status() const noexcept = 0;

protected:
    HapticDevice() = default;
    HapticDevice(const HapticDevice&) = default;
    HapticDevice& operator=(const HapticDevice&) = default;
};

} // namespace tactus
