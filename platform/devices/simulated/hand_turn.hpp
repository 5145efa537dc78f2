// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/hand_and_device.hpp"
#include "rt_core/math/rotation.hpp"

namespace tactus
{

struct HandTurnOptions
{
    TurnLimits device; ///< Inertia above zero.
    double delay_s{0.0};
    /// The wrist and its grip: kg m^2, N m/rad, N m s/rad in place of what the names say.
    HandLimb wrist;
    double period_s{1e-3};
    Mat3 start{Mat3::Identity()}; ///< Of all; orthonormal to rounding.
};

/// How a hand turns the device that it holds: HandAndDevice with angles for ways, moments of
/// inertia for masses and torques for forces.
///
/// Two bodies whose inertia is the same about each axis turn as point masses move, as long as the
/// springs between them are turned by little: x stands for the turn since the period began, and the
/// springs are measured anew, as the rotations between the bodies, when the next one begins. About
/// one axis this is exact, and so is the balance of energy; about several the springs' energy
/// changes at a new period by the square of how much they are stretched.
///
/// Until something turns it nothing is computed. Allocates nothing. One thread, as HandAndDevice.
class HandTurn
{
public:
    /// Refuses what HandAndDevice refuses.
    [[nodiscard]] static Result<HandTurn, Refusal> create(const HandTurnOptions& options);

    /// One period under `torque_nm`, while the wrist's target turns to `target` at constant speed.
    void step(const Vec3& torque_nm, const Mat3& target) noexcept;

    /// As those of HandAndDevice, in N m s/rad.
    void brake(double damping_nm_s_per_rad) noexcept { body_.brake(damping_nm_s_per_rad); }
    void release_brake() noexcept { body_.release_brake(); }

    /// In steps of the quantum about each axis.
    [[nodiscard]] Quaternion measured() const noexcept;
    /// Not known to a controller.
    [[nodiscard]] const Mat3& rotation() const noexcept { return device_; }
    [[nodiscard]] const Vec3& velocity_rad_per_s() const noexcept
    {
        return body_.velocity_m_per_s();
    }
    [[nodiscard]] const HandAndDeviceEnergy& energy() const noexcept { return body_.energy(); }
    [[nodiscard]] double stored_j() const noexcept { return body_.stored_j(); }

private:
    HandTurn(const HandTurnOptions& options, const HandAndDevice& body) noexcept;

    double quantum_rad_;
    HandAndDevice body_;
    Mat3 device_;
    Mat3 hand_;
    Mat3 target_;
    bool has_moved_{false};
};

} // namespace tactus
