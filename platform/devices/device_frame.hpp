// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/haptic_device.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/math/rotation.hpp"
#include "rt_core/math/similarity.hpp"
#include "transport/base/refusal.hpp"

// Any thread: DeviceFrame is a value. Its conversions of positions, velocities, rotations and
// forces neither wait nor allocate. create() and to_world(DeviceInfo) may allocate; call them
// before the loop.
namespace tactus
{

/// Placement of a device in the world:
///
///     position_world = translation_m + scale x rotation x position_device
///     rotation_world = rotation x rotation_device
///     force_device   = rotation^T x force_world, likewise the torque
///
/// A scale of 10 makes 1 cm of the device's motion 10 cm of the world. Forces and angles are not
/// scaled: a newton of the world is a newton on the user. With a scale of s, mass, damping and
/// stiffness of the device in the world are its own divided by s; to_world(DeviceInfo) converts
/// them. The stiffness limit of docs/stability.md then holds unchanged. The default is the
/// identity.
class DeviceFrame
{
public:
    DeviceFrame() = default;

    /// `in_world`: pose and scale of the device's frame in the world. Refuses a translation beyond
    /// kPoseReachMax_m on an axis, a scale out of [kPoseScaleMin, kPoseScaleMax], and a matrix
    /// other than a right-handed rotation. Rotations within kRotationTolerance are made orthonormal
    /// to rounding.
    [[nodiscard]] static Result<DeviceFrame, Refusal> create(const Similarity& in_world);

    [[nodiscard]] Vec3 position_to_world(const Vec3& device_m) const noexcept
    {
        return frame_.local_to_world(device_m);
    }
    /// Velocity in metres per second.
    [[nodiscard]] Vec3 velocity_to_world(const Vec3& device_m_per_s) const noexcept
    {
        return frame_.scale * (frame_.rotation * device_m_per_s);
    }
    [[nodiscard]] Vec3 force_to_device(const Vec3& world_n) const noexcept
    {
        return frame_.rotation.transpose() * world_n;
    }
    [[nodiscard]] Quaternion rotation_to_world(const Quaternion& device) const noexcept
    {
        return to_quaternion(frame_.rotation * to_rotation(device));
    }
    /// Angular velocity in radians per second.
    [[nodiscard]] Vec3 turning_to_world(const Vec3& device_rad_per_s) const noexcept
    {
        return frame_.rotation * device_rad_per_s;
    }
    [[nodiscard]] Vec3 torque_to_device(const Vec3& world_nm) const noexcept
    {
        return frame_.rotation.transpose() * world_nm;
    }
    /// Converts device information from the device's frame to the world's. Rates, delay, forces and
    /// rotational limits are unchanged.
    [[nodiscard]] DeviceInfo to_world(const DeviceInfo& device) const;

private:
    Similarity frame_;
};

} // namespace tactus
