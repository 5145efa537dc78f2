// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/device_limits.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

/// The moving part of a hand, its arm and its grip. The values are those of a relaxed hand; all
/// are finite and not negative.
struct HandLimb
{
    double mass_kg{0.1};
    double stiffness_n_per_m{200.0}; ///< Between the hand and where it wants to be.
    double damping_n_s_per_m{4.0};   ///< Likewise.
    /// Between the hand and the device; with both 0 the device is let go.
    double grip_stiffness_n_per_m{2'000.0};
    double grip_damping_n_s_per_m{4.0};
};

struct HandAndDeviceOptions
{
    DeviceLimits device;
    HandLimb hand;
    double period_s{1e-3};
    Vec3 start_world_m{0.0, 0.0, 0.0}; ///< Where hand and device rest at first.
    Vec3 workspace_centre_world_m{0.0, 0.0, 0.0};
    double workspace_radius_m{1.0};
};

/// Where energy went since the start, in joules. All but the works are never negative.
struct HandAndDeviceEnergy
{
    double force_work_j{0.0};   ///< Done by the device's motors.
    double target_work_j{0.0};  ///< Done by the hand's will, through arm spring and damper.
    double viscous_loss_j{0.0}; ///< In the device's damping and its brake.
    double friction_loss_j{0.0};
    double hand_loss_j{0.0}; ///< In the dampers of arm and grip.
    double stop_loss_j{0.0}; ///< At the end of the reach.
};

/// A hand that holds a device, as two point masses:
///
///     target --[ spring, damper ]-- hand --[ grip: spring, damper ]-- device <-- held force
///     (given)                                                           |
///                                                       damper and Coulomb friction
///                                                       against the ground
///
/// The device holds each force from DeviceLimits::delay_s after it was given until the next one is
/// due, cut to force_max_n. Its position is measured in steps of the quantum on each axis. Friction
/// holds it still while no more than the friction pulls. It ends at the workspace's sphere without
/// bounce.
///
/// Each period is integrated in kSubSteps equal steps by the implicit midpoint rule: it changes the
/// energy of the linear part by exactly the work that was done and lost, so that a model of what
/// feeds a limit cycle feeds none itself. The same forces and targets give the same bits; time
/// counts in periods. Allocates nothing. One thread, the one that reads the device.
class HandAndDevice
{
public:
    static constexpr std::uint32_t kSubSteps = 20;       ///< Delays count in whole ones.
    static constexpr std::uint32_t kDelayMaxPeriods = 8; ///< Longest delay.

    /// Refuses a device with a fault, values that are not finite or out of range, a period out of
    /// 1e-5 .. 0.1 s, a delay over kDelayMaxPeriods, a start outside the workspace, and a hand
    /// with neither mass nor arm.
    [[nodiscard]] static Result<HandAndDevice, Refusal> create(const HandAndDeviceOptions& options);

    /// One period under `force_n` (what is no finite force counts as none), while the hand's target
    /// moves to `target_m` at constant speed. Returns the measured position at its end.
    Vec3 step(const Vec3& force_n, const Vec3& target_m) noexcept;

    /// All at once somewhere else, with the speeds that they have: for HandTurn, whose coordinates
    /// begin anew each period.
    void place(const Vec3& device_m, const Vec3& hand_m, const Vec3& target_m) noexcept
    {
        device_m_ = device_m;
        hand_m_ = hand_m;
        target_m_ = target_m;
    }

    /// Forces under way are dropped, and from now on this much damping comes on top of the device's
    /// own; finite and not negative. It makes a force again by the next step() that gives one.
    void brake(double damping_n_s_per_m) noexcept;
    void release_brake() noexcept { brake_n_s_per_m_ = 0.0; }

    [[nodiscard]] Vec3 measured_m() const noexcept;
    /// Not known to a controller.
    [[nodiscard]] const Vec3& position_m() const noexcept { return device_m_; }
    [[nodiscard]] const Vec3& velocity_m_per_s() const noexcept { return device_m_per_s_; }
    [[nodiscard]] const Vec3& hand_m() const noexcept { return hand_m_; }
    [[nodiscard]] const HandAndDeviceEnergy& energy() const noexcept { return energy_; }
    /// Of both masses and both springs.
    [[nodiscard]] double stored_j() const noexcept;

private:
    explicit HandAndDevice(const HandAndDeviceOptions& options) noexcept;

    /// Speeds in the middle of a sub-step.
    struct Midway
    {
        Vec3 device_m_per_s;
        Vec3 hand_m_per_s;
        Vec3 friction_n; ///< On the device.
    };

    [[nodiscard]] Midway solve(const Vec3& force_n, const Vec3& target_mid_m,
                               const Vec3& target_velocity) const noexcept;
    void sub_step(const Vec3& force_n, const Vec3& target_mid_m,
                  const Vec3& target_velocity) noexcept;
    void stay_in_workspace() noexcept;
    [[nodiscard]] const Vec3& force_at(std::uint32_t sub_step) const noexcept;

    HandAndDeviceOptions options_;
    double dt_s_;
    double brake_n_s_per_m_{0.0};
    std::uint32_t delay_sub_steps_;
    Vec3 device_m_;
    Vec3 device_m_per_s_{0.0, 0.0, 0.0};
    Vec3 hand_m_;
    Vec3 hand_m_per_s_{0.0, 0.0, 0.0};
    Vec3 target_m_;
    std::array<Vec3, kDelayMaxPeriods + 1> forces_n_{}; ///< Given ones, newest first.
    HandAndDeviceEnergy energy_;
};

} // namespace tactus
