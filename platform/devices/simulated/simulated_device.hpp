// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/brake_latch.hpp"
#include "platform/devices/haptic_device.hpp"
#include "platform/devices/simulated/device_classes.hpp"
#include "platform/devices/simulated/hand_and_device.hpp"
#include "platform/devices/simulated/hand_motion.hpp"
#include "platform/devices/simulated/hand_turn.hpp"
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
    /// What it is and what it says of itself; device_classes.hpp has others.
    DeviceLimits device{kDeskClass};
    /// Fingers with a stylus: lighter than a whole hand, on the default device damped to two thirds
    /// of critical.
    HandLimb hand{.mass_kg = 0.05, .damping_n_s_per_m = 6.0};
    /// HandTurnOptions::wrist. With the default device damped likewise.
    HandLimb wrist{.mass_kg = 5e-5,
                   .stiffness_n_per_m = 0.5,
                   .damping_n_s_per_m = 0.012,
                   .grip_stiffness_n_per_m = 5.0,
                   .grip_damping_n_s_per_m = 0.004};
    double brake_damping_n_s_per_m{10.0};    ///< Added while the brake is on; finite, not negative.
    double brake_damping_nm_s_per_rad{0.01}; ///< Likewise.
    ToolLoad load;                           ///< Hangs on it; without inertia.
    double gripper_force_max_n{8.0};         ///< Of a hand that holds a gripper.
    Vec3 workspace_centre_world_m{Vec3::Zero()};
    double workspace_radius_m{1.0};
    double speed_max_m_per_s{10.0}; ///< No hand is faster. Finite and above zero.
    /// Lent; it outlives the device. Null: a reading is one period, however late it comes. With it
    /// a reading integrates as many periods as went by, under the force that was held meanwhile.
    const Clock* clock{nullptr};
    /// Its own watchdog: so long after a write the force ends. None: the force is held for ever.
    /// Above zero, and only with a clock.
    std::optional<Duration> watchdog;
};

/// A device in a hand that feels the written force and torque: HandAndDevice and HandTurn, with
/// mass, damping, friction, delay, reach, and steps of what is measured. A device whose rotation
/// isn't measured doesn't turn. The gripper and buttons follow the hand at once. Each reading
/// integrates one period, by frame index and never by wall time: the same hand and the same forces
/// give the same positions, bit for bit, however late the readings come. With a clock it lives in
/// that clock's time instead: what it does when nobody reads or writes for a while can be seen.
///
/// It measures its velocities without steps, as by a tachometer.
class SimulatedDevice final : public HapticDevice
{
public:
    /// Refuses a rate out of [kRateMinHz, kRateMaxHz], other values out of range, what
    /// HandAndDevice refuses, and a hand that starts outside the workspace. Before the loop; a null
    /// hand is a bug (asserted).
    [[nodiscard]] static Result<std::unique_ptr<SimulatedDevice>, Refusal>
    create(const SimulatedDeviceOptions& options, std::unique_ptr<HandMotion> hand);

    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
    /// The first reading is the hand's start; each later one is a period on.
    [[nodiscard]] DeviceSample read() noexcept override;
    void write(const Wrench& wrench) noexcept override;
    void brake() noexcept override;
    void brake_softly() noexcept override;
    void release_brake() noexcept override;
    [[nodiscard]] DeviceStatus status() const noexcept override;

    /// What it makes of the last write now: that force, which the hand feels after the delay, or
    /// none after the brake or the watchdog. Haptic thread, or another one while that hangs.
    [[nodiscard]] Vec3 felt_force_world_n() const noexcept;
    /// Likewise.
    [[nodiscard]] Wrench felt_wrench() const noexcept;

private:
    SimulatedDevice(const SimulatedDeviceOptions& options, const HandAndDevice& body,
                    const std::optional<HandTurn>& turn, std::unique_ptr<HandMotion> hand);

    [[nodiscard]] std::uint64_t periods_due() const noexcept;
    [[nodiscard]] Duration period_at(std::uint64_t index) const noexcept;
    [[nodiscard]] MonotonicTime now() const noexcept;
    [[nodiscard]] bool is_watched_out(MonotonicTime time) const noexcept;
    [[nodiscard]] Wrench wrench_at(MonotonicTime time) const noexcept;
    void integrate_one_period(bool braked, const Wrench& wrench) noexcept;

    SimulatedDeviceOptions options_;
    DeviceInfo info_;
    std::unique_ptr<HandMotion> hand_;
    HandAndDevice body_;
    std::optional<HandTurn> turn_; ///< None: it doesn't turn.
    Wrench wrench_;                ///< The last write.
    DeviceStatus status_;
    std::uint64_t periods_{0}; ///< Integrated so far.
    MonotonicTime start_;      ///< Of the first reading.
    MonotonicTime written_;    ///< The last write.
    /// Of the last reading: without a clock that is the time. Relaxed: who brakes needs no other.
    std::atomic<std::int64_t> read_at_ns_{0};
    BrakeLatch brake_; ///< The one field that other threads write.
};

} // namespace tactus
