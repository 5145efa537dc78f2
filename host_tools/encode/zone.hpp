// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/triangle.hpp"
#include "rt_core/math/vec3.hpp"

#include <variant>

// Any thread, except the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// All points within a radius of a centre.
struct SphereZone
{
    Vec3 center_m{0.0, 0.0, 0.0};
    double radius_m{0.0}; ///< Radius; 0 or more.
};

/// All points between two corners.
struct BoxZone
{
    Vec3 low_m{0.0, 0.0, 0.0};
    Vec3 high_m{0.0, 0.0, 0.0}; ///< Upper corner; on no axis below `low_m`.
};

/// A part of space that needs full resolution, boundary included; independent of the header's
/// regions. The frame is the user's; values must be finite (unchecked).
using Zone = std::variant<SphereZone, BoxZone>;

/// The zone relative to `origin_m`, extended by `margin_m` >= 0 on every side.
[[nodiscard]] Zone moved_and_grown(const Zone& zone, const Vec3& origin_m, double margin_m);

/// True if a point of the triangle is in the zone, except for rounding.
[[nodiscard]] bool touches(const Zone& zone, const Triangle& triangle);

} // namespace tactus
