// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/operator_and_device.hpp"
#include "rt_core/math/rotation.hpp"

namespace tactus
{

/// The rotational part of a simulated device and operator.
struct OperatorRotationOptions
{
    RotationLimits device; ///< Rotation limits; inertia above zero.
    double delay_s{0.0};
    /// Wrist and its grip. Units are kg m^2, N m/rad and N m s/rad in place of those in the names.
    OperatorLimb wrist;
    double period_s{1e-3};
    Mat3 start{Mat3::Identity()}; ///< Initial rotation of device and hand; orthonormal.
};

/// Rotation of a held device by the hand: OperatorAndDevice with angles for displacements, moments
/// of inertia for masses and torques for forces.
///
/// A body with the same inertia about each axis rotates as a point mass moves, while the springs
/// are turned little. A coordinate is the rotation since the period began. Each period measures the
/// springs again, as rotations between the bodies. About one axis this is exact, and so is the
/// energy balance. About several axes each new period changes the springs' energy by the square of
/// their deflection.
///
/// Computes nothing before the first torque or rotation of the target. Allocates nothing. One
/// thread, as OperatorAndDevice.
class OperatorRotation
{
public:
    /// Refuses the same values as OperatorAndDevice.
    [[nodiscard]] static Result<OperatorRotation, Refusal>
    create(const OperatorRotationOptions& options);

    /// Simulates one period under `torque_nm`, while the wrist's target rotates to `target` at
    /// constant speed.
    void step(const Vec3& torque_nm, const Mat3& target) noexcept;

    /// Brakes like OperatorAndDevice::brake(), in N m s/rad.
    void brake(double damping_nm_s_per_rad) noexcept { body_.brake(damping_nm_s_per_rad); }
    void release_brake() noexcept { body_.release_brake(); }

    /// Measured rotation, in steps of quantum_rad about each axis.
    [[nodiscard]] Quaternion measured() const noexcept;
    /// True rotation, unknown to a controller.
    [[nodiscard]] const Mat3& rotation() const noexcept { return device_; }
    [[nodiscard]] const Vec3& velocity_rad_per_s() const noexcept
    {
        return body_.velocity_m_per_s();
    }
    [[nodiscard]] const OperatorAndDeviceEnergy& energy() const noexcept { return body_.energy(); }
    [[nodiscard]] double stored_j() const noexcept { return body_.stored_j(); }

private:
    OperatorRotation(const OperatorRotationOptions& options,
                     const OperatorAndDevice& body) noexcept;

    double quantum_rad_;
    OperatorAndDevice body_;
    Mat3 device_;
    Mat3 hand_;
    Mat3 target_;
    bool has_moved_{false};
};

} // namespace tactus
