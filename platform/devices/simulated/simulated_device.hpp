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

/// Options of a simulated device. The defaults are a relaxed hand that holds a small desktop
/// device.
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
    /// Wrist in the units of OperatorRotationOptions, damped to two thirds of critical on the
    /// default device.
    OperatorLimb wrist{.mass_kg = 5e-5,
                       .stiffness_n_per_m = 0.5,
                       .damping_n_s_per_m = 0.012,
                       .grip_stiffness_n_per_m = 5.0,
                       .grip_damping_n_s_per_m = 0.004};
    double brake_damping_n_s_per_m{10.0}; ///< Damping while the brake is on; finite, not negative.
    /// Rotational damping while the brake is on; finite, not negative.
    double brake_damping_nm_s_per_rad{0.01};
    ToolLoad load;                   ///< Payload on the device; only its weight acts.
    double gripper_force_max_n{8.0}; ///< Largest gripper force if the hand holds a gripper.
    Vec3 workspace_centre_world_m{Vec3::Zero()};
    double workspace_radius_m{1.0};
    double speed_max_m_per_s{10.0}; ///< Reported largest speed; finite and above zero.
    /// Clock, borrowed; must outlive the device. Null: each reading integrates one period, however
    /// late. With a clock it integrates the elapsed periods, from one up to those of a second,
    /// under the force held meanwhile.
    const Clock* clock{nullptr};
    /// Time after a write until the device's watchdog ends the force; above zero, and only with a
    /// clock. None: the force is held without limit.
    std::optional<Duration> watchdog;
};

/// A device in a hand that feels the written force and torque. OperatorAndDevice and
/// OperatorRotation simulate mass, damping, friction, delay, reach, and quantised measurements. A
/// device that does not measure rotation does not rotate. The gripper and buttons follow the hand
/// at once. Each reading integrates one period by frame index: the same hand and forces give the
/// same positions, bit for bit, however late the readings are. With a clock the device follows that
/// clock's time instead: a pause in reading or writing shows in its motion.
///
/// The velocities are measured without quantisation, as by a tachometer.
class SimulatedDevice final : public HapticDevice
{
public:
    /// Refuses a rate out of [kRateMinHz, kRateMaxHz], other values out of range, the faults that
    /// OperatorAndDevice refuses, and a hand that starts outside the workspace. Call before the
    /// loop; a null hand is a bug (asserted).
    [[nodiscard]] static Result<std::unique_ptr<SimulatedDevice>, Refusal>
    create(const SimulatedDeviceOptions& options, std::unique_ptr<OperatorMotion> motion);

    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
    /// The first reading is at the hand's start. Each later one is a period later, or more with a
    /// clock.
    [[nodiscard]] DeviceSample read() noexcept override;
    void write(const Wrench& wrench) noexcept override;
    void brake() noexcept override;
    void brake_softly() noexcept override;
    void release_brake() noexcept override;
    [[nodiscard]] DeviceStatus status() const noexcept override;

    /// Force that the last write still makes now: less during a fade, zero after the brake or the
    /// watchdog. The hand feels it after the delay. Haptic thread, or another one while that hangs.
    [[nodiscard]] Vec3 felt_force_world_n() const noexcept;
    /// Present wrench, like felt_force_world_n().
    [[nodiscard]] Wrench felt_wrench() const noexcept;

private:
    SimulatedDevice(const SimulatedDeviceOptions& options, const OperatorAndDevice& body,
                    const std::optional<OperatorRotation>& rotation,
                    std::unique_ptr<OperatorMotion> motion);

    [[nodiscard]] std::uint64_t periods_due() const noexcept;
    [[nodiscard]] Duration period_at(std::uint64_t index) const noexcept;
    [[nodiscard]] MonotonicTime now() const noexcept;
    [[nodiscard]] bool is_watched_out(MonotonicTime time) const noexcept;
    [[nodiscard]] Wrench wrench_at(MonotonicTime time) const noexcept;
    void integrate_one_period(bool braked, const Wrench& wrench) noexcept;

    SimulatedDeviceOptions options_;
    DeviceInfo info_;
    std::unique_ptr<OperatorMotion> motion_;
    OperatorAndDevice body_;
    std::optional<OperatorRotation> rotation_; ///< None: the device doesn't rotate.
    Wrench wrench_;                            ///< Last write.
    DeviceStatus status_;
    std::uint64_t periods_{0}; ///< Number of integrated periods.
    MonotonicTime start_;      ///< Time of the first reading.
    MonotonicTime written_;    ///< Time of the last write.
    /// Time of the last reading, which is now() without a clock. Relaxed: a braking thread needs no
    /// other data.
    std::atomic<std::int64_t> read_at_ns_{0};
    BrakeLatch brake_; ///< Only this field is written by other threads, too.
};

} // namespace tactus
