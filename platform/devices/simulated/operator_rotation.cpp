// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/operator_rotation.hpp"

#include <cmath>

namespace tactus
{

namespace
{

/// Rotation vector that takes `from` to `to`, about the world's axes.
Vec3 way_between(const Mat3& from, const Mat3& to) noexcept
{
    return rotation_vector(orthonormalised(to * from.transpose()));
}

/// Options of the OperatorAndDevice that simulates the angles, with unlimited reach. Limits that
/// the simulation doesn't use are set to 1.
OperatorAndDeviceOptions in_angles(const OperatorRotationOptions& options)
{
    const RotationLimits& turn = options.device;
    constexpr double kUnused = 1.0;
    OperatorAndDeviceOptions angles;
    angles.device = {.mass_kg = turn.inertia_kg_m2,
                     .damping_n_s_per_m = turn.damping_nm_s_per_rad,
                     .friction_n = turn.friction_nm,
                     .quantum_m = 0.0,
                     .delay_s = options.delay_s,
                     .force_max_n = turn.torque_max_nm > 0.0 ? turn.torque_max_nm : kUnused,
                     .slew_max_n_per_s = kUnused,
                     .stiffness_max_n_per_m = kUnused};
    angles.hand = options.wrist;
    angles.period_s = options.period_s;
    angles.workspace_radius_m = 1e6;
    return angles;
}

} // namespace

Result<OperatorRotation, Refusal> OperatorRotation::create(const OperatorRotationOptions& options)
{
    auto body = OperatorAndDevice::create(in_angles(options));
    if (!body)
    {
        return Refusal{"rotation of the " + body.error().text};
    }
    return OperatorRotation(options, body.value());
}

OperatorRotation::OperatorRotation(const OperatorRotationOptions& options,
                                   const OperatorAndDevice& body) noexcept
    : quantum_rad_(options.device.quantum_rad)
    , body_(body)
    , device_(options.start)
    , hand_(options.start)
    , target_(options.start)
{
}

void OperatorRotation::step(const Vec3& torque_nm, const Mat3& target) noexcept
{
    has_moved_ = has_moved_ || torque_nm != Vec3(Vec3::Zero()) || target != target_;
    if (!has_moved_)
    {
        return;
    }
    const Vec3 hand = way_between(device_, hand_);
    body_.place({0.0, 0.0, 0.0}, hand, hand + way_between(hand_, target_));
    static_cast<void>(body_.step(torque_nm, hand + way_between(hand_, target)));
    device_ = turned_exactly_by(body_.position_m(), device_);
    hand_ = turned_exactly_by(body_.hand_m() - hand, hand_);
    target_ = target;
}

/// Rounds the quaternion's vector part to steps of half a quantum, since a small angle changes it
/// by half the angle.
Quaternion OperatorRotation::measured() const noexcept
{
    Quaternion measured = to_quaternion(device_);
    if (quantum_rad_ > 0.0)
    {
        const double step = 0.5 * quantum_rad_;
        double square = 0.0;
        for (double& part : measured)
        {
            part = std::floor(part / step + 0.5) * step;
            square += part * part;
        }
        const double length = std::sqrt(square);
        for (double& part : measured)
        {
            part /= length;
        }
    }
    return measured;
}

} // namespace tactus
