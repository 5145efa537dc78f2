// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/object_pose.hpp"

#include <cstdint>

namespace tactus
{

/// Bumps of a material, as energy of the spring between device and proxy.
///
/// The spring of a proxy at p with the depth d holds the energy K e(d) h(p), besides 1/2 K d^2:
///
///     h(p) = height x sum over the object's axes of (w(p / length) - 1/2)
///     w(t) = 16 t^2 (1 - t)^2, of t's fraction: a bump from 0 to 1, twice differentiable
///     e(d) = D (d / (D + d))^2, D = length^2 / (64 height)
///
/// So bumps give back all energy that a user puts into them. D keeps e times any curvature of h
/// within 1/2: the proxy has one place of rest for a goal, and no wall gets stiffer along its
/// surface. Across it the stiffness grows by e'' h <= 3 height / D = 192 (height / length)^2, at
/// most 0.19. A push stays a push, as e'(d) <= 2 d / D. Proofs: docs/internals/passivity.md.
struct Texture
{
    /// Fraction of `turns` above the next lower whole number, 0 .. 1. |turns| up to kGoalRange_m /
    /// kTextureLengthMin_m.
    [[nodiscard]] static double fraction_of(double turns) noexcept TACTUS_NONBLOCKING
    {
        const double cut = turns - static_cast<double>(static_cast<std::int64_t>(turns));
        return cut < 0.0 ? cut + 1.0 : cut;
    }

    /// Bound on the stiffness of a wall with this texture, as a multiple of the wall's own
    /// stiffness K.
    [[nodiscard]] static double stiffening(const Material& material) noexcept TACTUS_NONBLOCKING
    {
        const double height_m = material.texture_height_m;
        const double steepness = height_m > 0.0 ? height_m / material.texture_length_m : 0.0;
        return 1.0 + 192.0 * steepness * steepness;
    }

    double push_m{0.0}; ///< Product e'(d) h: times K, the added push.
    /// Product e(d) grad h in the world frame: times K, the force along the surface.
    Vec3 slope_m{0.0, 0.0, 0.0};

    /// Texture at a proxy at `place_m` in the world, pressed in by `depth_m`. Bumps lie along the
    /// axes of the object, in metres of the world.
    [[nodiscard]] static Texture at(const Material& material, const ObjectPose& pose,
                                    const Vec3& place_m, double depth_m) noexcept TACTUS_NONBLOCKING
    {
        Texture texture;
        const double height_m = material.texture_height_m;
        if (!(height_m > 0.0))
        {
            return texture;
        }
        const double length_m = material.texture_length_m;
        // D of the flattest bumps overflows; 1 / D and d / D do not.
        const double per_limit = 64.0 * height_m / (length_m * length_m);
        const double depths = depth_m * per_limit;
        const double rest = 1.0 / (1.0 + depths); // D / (D + d)
        const Vec3 there_m = pose.rotation.transpose() * (place_m - pose.translation_m);
        double rise_m = 0.0;
        Vec3 slope(0.0, 0.0, 0.0);
        for (int axis = 0; axis < 3; ++axis)
        {
            const double t = fraction_of(there_m[axis] / length_m);
            rise_m += height_m * (16.0 * t * t * (1.0 - t) * (1.0 - t) - 0.5);
            slope[axis] = height_m / length_m * (32.0 * t * (1.0 - t) * (1.0 - 2.0 * t));
        }
        texture.push_m = 2.0 * depths * rest * rest * rest * rise_m;
        texture.slope_m = depth_m * depths * rest * rest * (pose.rotation * slope);
        return texture;
    }
};

} // namespace tactus
