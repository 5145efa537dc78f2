// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/round_triangle.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/closest_points.hpp"

#include <cmath>

namespace tactus
{

namespace
{

/// Error of a distance by the subtraction of a radius, as a share of it: one rounding.
constexpr double kRadiusRounding = 1.2e-16;

ClosestPoints grown(const ClosestPoints& core, double radius) noexcept
{
    TACTUS_ASSERT(radius >= 0.0);
    ClosestPoints result = core;
    result.distance = core.distance - radius;
    result.distance_error = core.distance_error + kRadiusRounding * radius;
    result.meet = result.distance <= 0.0;
    if (core.distance > 0.0)
    {
        const Vec3 direction = core.gap / core.distance;
        result.on_shape = core.on_shape + radius * direction;
        result.gap = result.distance * direction;
    }
    return result;
}

} // namespace

ClosestPoints closest_points(const Sphere& sphere, const Triangle& triangle) noexcept
{
    const ClosestPoint closest = closest_point_on_triangle(sphere.center, triangle);
    ClosestPoints core;
    core.on_shape = sphere.center;
    core.on_triangle = closest.point;
    core.gap = closest.gap;
    core.distance = std::sqrt(closest.distance_sq);
    core.distance_error = closest.distance_error;
    core.feature = closest.feature;
    return grown(core, sphere.radius);
}

ClosestPoints closest_points(const Capsule& capsule, const Triangle& triangle) noexcept
{
    return grown(closest_points(capsule.core, triangle), capsule.radius);
}

} // namespace tactus
