// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/haptic_device.hpp"
#include "platform/platform_error.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"

namespace tactus
{

/// How a device stands in the world:
///
///     position_world = translation_m + scale x rotation x position_device
///     force_device   = rotation^T x force_world
///
/// A scale of 10 makes 1 cm of the hand's way 10 cm of the world. Forces are not scaled: a newton
/// of the world is a newton on the hand. A device that moves s times as far for the same force is,
/// seen from the world, one of a s-th of its mass, damping and stiffness; to_world(DeviceInfo)
/// says so, and the cap of docs/stability.md holds unchanged. The default is no change at all.
class DeviceFrame
{
public:
    static constexpr double kTranslationMax_m = 1e4;
    static constexpr double kScaleMin = 1e-3;
    static constexpr double kScaleMax = 1e3;
    /// How far each coordinate of rotation^T x rotation may be from the identity's.
    static constexpr double kRotationTolerance = 1e-6;

    DeviceFrame() = default;

    /// Refuses, with `bad_option`, a translation beyond kTranslationMax_m on an axis, a scale out
    /// of [kScaleMin, kScaleMax], and a matrix that is no right-handed rotation; what is one within
    /// the tolerance is made orthonormal to rounding.
    [[nodiscard]] static Result<DeviceFrame, PlatformError>
    create(const Mat3& rotation, const Vec3& translation_m, double scale);

    [[nodiscard]] Vec3 position_to_world(const Vec3& device_m) const noexcept
    {
        return translation_m_ + scale_ * (rotation_ * device_m);
    }
    /// In metres per second.
    [[nodiscard]] Vec3 velocity_to_world(const Vec3& device_m_per_s) const noexcept
    {
        return scale_ * (rotation_ * device_m_per_s);
    }
    [[nodiscard]] Vec3 force_to_device(const Vec3& world_n) const noexcept
    {
        return rotation_.transpose() * world_n;
    }
    /// What the device is in the world, from what it says of itself; rates and delay stay.
    [[nodiscard]] DeviceInfo to_world(const DeviceInfo& device) const;

private:
    Mat3 rotation_{Mat3::Identity()};
    Vec3 translation_m_{Vec3::Zero()};
    double scale_{1.0};
};

} // namespace tactus
