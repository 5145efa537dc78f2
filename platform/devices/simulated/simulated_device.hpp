// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/brake_latch.hpp"
#include "platform/devices/haptic_device.hpp"
#include "platform/devices/simulated/device_classes.hpp"
#include "platform/devices/simulated/operator_and_device.hpp"
#include "platform/devices/simulated/operator_motion.hpp"
#include "platform/devices/simulated/operator_rotation.hpp"
#include "platform/machine/clock.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/device_limits.hpp"
#include "rt_core/records/tool_load.hpp"
#include "transport/base/refusal.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>

namespace tactus
{

/// A relaxed hand holding a small desktop device.
struct SimulatedDeviceOptions
{
    static constexpr std::int64_t kRateMinHz = 100;
    static constexpr std::int64_t kRateMaxHz = 10'000;

    std::int64_t rate_hz{1'000};
    /// Device and its reported limits; device_classes.hpp has others.
    DeviceLimits device{kDeskClass};
    /// Fingers with a stylus: lighter than a whole hand, on the default device damped to two thirds
    /// of critical.
    OperatorLimb hand{.mass_kg = 0.05, .damping_n_s_per_m = 6.0};
    /// Wrist of OperatorRotationOptions, damped to two thirds of critical on the default device.
    OperatorLimb wrist{.mass_kg = 5e-5,
                       .stiffness_n_per_m = 0.5,
                       .damping_n_s_per_m = 0.012,
                       .grip_stiffness_n_per_m = 5.0,
                       .grip_damping_n_s_per_m = 0.004};
    double brake_damping_n_s_per_m{10.0}; ///< Damping while the brake is on; finite, not negative.
    /// Rotational damping while the brake is on; finite, not negative.
    double brake_damping_nm_s_per_rad{0.01};
    ToolLoad load;                   ///< Payload on the device; without inertia.
    double gripper_force_max_n{8.0}; ///< Gripper force of a hand that holds a gripper.
    Vec3 workspace_centre_world_m{Vec3::Zero()};
    double workspace_radius_m{1.0};
    double speed_max_m_per_s{10.0}; ///< Largest speed of a hand. Finite and above zero.
    /// Clock, borrowed; it outlives the device. Null: a reading is one period, however late. With a
    /// clock a reading integrates the elapsed periods under the force held meanwhile.
    const Clock* clock{nullptr};
    /// Time after a write until the device's watchdog ends the force; above zero, and only with a
    /// clock. None: the force is held without limit.
    std::optional<Duration> watchdog;
};

/// A device in a hand that feels the written force and torque: OperatorAndDevice and
/// OperatorRotation, with mass, damping, friction, delay, reach, and quantised measurements. A
/// device that does not measure rotation does not rotate. The gripper and buttons follow the hand
/// at once. Each reading integrates one period by frame index: the same hand and forces give the
/// same positions, bit for bit, however late the readings are. With a clock it follows that clock's
/// time instead: a pause in reading or writing shows in its motion.
///
/// It measures its velocities without quantisation, as by a tachometer.
class SimulatedDevice final : public HapticDevice
{
public:
    /// Refuses a rate out of [kRateMinHz, kRateMaxHz], other values out of range, the faults that
    /// OperatorAndDevice refuses, and a hand that starts outside the workspace. Call before the
    /// loop; a null hand is a bug (asserted).
    [[nodiscard]] static Result<std::unique_ptr<SimulatedDevice>, Refusal>
    create(const SimulatedDeviceOptions& options, std::unique_ptr<OperatorMotion> hand);

    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
    /// The first reading is the hand's start; each later one is a period on.
    [[nodiscard]] DeviceSample read() noexcept override;
    void write(const Wrench& wrench) noexcept override;
    void brake() noexcept override;
    void brake_softly() noexcept override;
    void release_brake() noexcept override;
    [[nodiscard]] DeviceStatus status() const noexcept override;

    /// Present force of the last write, which the hand feels after the delay; zero after the brake
    /// or the watchdog. Haptic thread, or another one while that hangs.
    [[nodiscard]] Vec3 felt_force_world_n() const noexcept;
    /// Present wrench, like felt_force_world_n().
    [[nodiscard]] Wrench felt_wrench() const noexcept;

private:
    SimulatedDevice(const SimulatedDeviceOptions& options, const OperatorAndDevice& body,
                    const std::optional<OperatorRotation>& turn,
                    std::unique_ptr<OperatorMotion> hand);

    [[nodiscard]] std::uint64_t periods_due() const noexcept;
    [[nodiscard]] Duration period_at(std::uint64_t index) const noexcept;
    [[nodiscard]] MonotonicTime now() const noexcept;
    [[nodiscard]] bool is_watched_out(MonotonicTime time) const noexcept;
    [[nodiscard]] Wrench wrench_at(MonotonicTime time) const noexcept;
    void integrate_one_period(bool braked, const Wrench& wrench) noexcept;

    SimulatedDeviceOptions options_;
    DeviceInfo info_;
    std::unique_ptr<OperatorMotion> hand_;
    OperatorAndDevice body_;
    std::optional<OperatorRotation> turn_; ///< None: the device doesn't rotate.
    Wrench wrench_;                        ///< Last write.
    DeviceStatus status_;
    std::uint64_t periods_{0}; ///< Number of integrated periods.
    MonotonicTime start_;      ///< Time of the first reading.
    MonotonicTime written_;    ///< Time of the last write.
    /// Time of the last reading, which is now() without a clock. Relaxed: a braking thread needs no
    /// other data.
    std::atomic<std::int64_t> read_at_ns_{0};
    BrakeLatch brake_; ///< The one field that other threads write.
};

} // namespace tactus
