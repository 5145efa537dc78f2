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

/// Mechanical properties of a hand with its arm and its grip. The defaults are those of a relaxed
/// hand; all must be finite and not negative.
struct OperatorLimb
{
    double mass_kg{0.1};
    double stiffness_n_per_m{200.0}; ///< Stiffness between the hand and its target.
    double damping_n_s_per_m{4.0};   ///< Damping between the hand and its target.
    /// Stiffness between hand and device. If both values of the grip are 0, the device is let go.
    double grip_stiffness_n_per_m{2'000.0};
    double grip_damping_n_s_per_m{4.0};
};

/// A simulated device, the operator who holds it, and where both start.
struct OperatorAndDeviceOptions
{
    DeviceLimits device;
    OperatorLimb hand;
    double period_s{1e-3};
    Vec3 start_world_m{0.0, 0.0, 0.0}; ///< Initial position of hand and device.
    Vec3 workspace_centre_world_m{0.0, 0.0, 0.0};
    double workspace_radius_m{1.0};
};

/// Energies since the start, in joules. Only the two works can be negative.
struct OperatorAndDeviceEnergy
{
    double force_work_j{0.0};   ///< Work of the device's motors.
    double target_work_j{0.0};  ///< Work of the hand's target, through arm spring and damper.
    double viscous_loss_j{0.0}; ///< Loss in the device's damping and its brake.
    double friction_loss_j{0.0};
    double hand_loss_j{0.0}; ///< Loss in the dampers of arm and grip.
    double stop_loss_j{0.0}; ///< Loss when the device stops at the workspace's end.
};

/// A hand that holds a device, as two point masses:
///
///     target --[ spring, damper ]-- hand --[ grip: spring, damper ]-- device <-- held force
///     (given)                                                           |
///                                                       damper and Coulomb friction
///                                                       against the ground
///
/// Each force acts from DeviceLimits::delay_s after its step() until the next one acts, cut to
/// force_max_n. The position is measured in steps of quantum_m on each axis. A resting device stays
/// at rest under forces up to friction_n. The device stops at the workspace's sphere without
/// bounce.
///
/// Each period is integrated in kSubSteps equal steps by the implicit midpoint rule. The rule
/// changes the energy of the linear part by exactly the work done and lost, so that the integration
/// itself causes no limit cycle. The same forces and targets give the same bits; time counts in
/// periods. Allocates nothing. One thread, the one that reads the device.
class OperatorAndDevice
{
public:
    /// Number of sub-steps in a period; delays are rounded to whole sub-steps.
    static constexpr std::uint32_t kSubSteps = 20;
    static constexpr std::uint32_t kDelayMaxPeriods = 8; ///< Longest delay of a device.

    /// Refuses a device with a fault, values that are not finite or out of range, a period out of
    /// 1e-5 .. 0.1 s, a delay over kDelayMaxPeriods, a start outside the workspace, and a hand with
    /// neither mass nor arm.
    [[nodiscard]] static Result<OperatorAndDevice, Refusal>
    create(const OperatorAndDeviceOptions& options);

    /// Simulates one period under `force_n` (a non-finite force counts as zero), while the hand's
    /// target moves to `target_m` at constant speed. Returns the measured position at its end.
    Vec3 step(const Vec3& force_n, const Vec3& target_m) noexcept;

    /// Sets all three positions and keeps all velocities. Used by OperatorRotation, which resets
    /// its coordinates each period.
    void place(const Vec3& device_m, const Vec3& hand_m, const Vec3& target_m) noexcept
    {
        device_m_ = device_m;
        hand_m_ = hand_m;
        target_m_ = target_m;
    }

    /// Drops the forces of all earlier steps, and adds this damping to the device's own until
    /// release_brake(). The damping must be finite and not negative. Forces of later steps act.
    void brake(double damping_n_s_per_m) noexcept;
    void release_brake() noexcept { brake_n_s_per_m_ = 0.0; }

    [[nodiscard]] Vec3 measured_m() const noexcept;
    /// True position, unknown to a controller.
    [[nodiscard]] const Vec3& position_m() const noexcept { return device_m_; }
    [[nodiscard]] const Vec3& velocity_m_per_s() const noexcept { return device_m_per_s_; }
    [[nodiscard]] const Vec3& hand_m() const noexcept { return hand_m_; }
    [[nodiscard]] const OperatorAndDeviceEnergy& energy() const noexcept { return energy_; }
    /// Energy of both masses and both springs.
    [[nodiscard]] double stored_j() const noexcept;

private:
    explicit OperatorAndDevice(const OperatorAndDeviceOptions& options) noexcept;

    /// Velocities in the middle of a sub-step.
    struct Midway
    {
        Vec3 device_m_per_s;
        Vec3 hand_m_per_s;
        Vec3 friction_n; ///< Friction on the device.
    };

    [[nodiscard]] Midway solve(const Vec3& force_n, const Vec3& target_mid_m,
                               const Vec3& target_velocity) const noexcept;
    void sub_step(const Vec3& force_n, const Vec3& target_mid_m,
                  const Vec3& target_velocity) noexcept;
    void stay_in_workspace() noexcept;
    [[nodiscard]] const Vec3& force_at(std::uint32_t sub_step) const noexcept;

    OperatorAndDeviceOptions options_;
    double dt_s_;
    double brake_n_s_per_m_{0.0};
    std::uint32_t delay_sub_steps_;
    Vec3 device_m_;
    Vec3 device_m_per_s_{0.0, 0.0, 0.0};
    Vec3 hand_m_;
    Vec3 hand_m_per_s_{0.0, 0.0, 0.0};
    Vec3 target_m_;
    std::array<Vec3, kDelayMaxPeriods + 1> forces_n_{}; ///< Forces of the last steps, newest first.
    OperatorAndDeviceEnergy energy_;
};

} // namespace tactus
