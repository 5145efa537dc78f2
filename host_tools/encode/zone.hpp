// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/triangle.hpp"
#include "rt_core/math/vec3.hpp"

#include <variant>

// Any thread, but not the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

struct BallZone
{
    Vec3 center_m{0.0, 0.0, 0.0};
    double radius_m{0.0}; ///< >= 0.
};

struct BoxZone
{
    Vec3 low_m{0.0, 0.0, 0.0};
    Vec3 high_m{0.0, 0.0, 0.0}; ///< On no axis below `low_m`.
};

/// A part of space that needs full resolution, its boundary included. Not one of the header's
/// regions: it may lie anywhere. Its frame is that of who has it; finite, which nothing checks.
using Zone = std::variant<BallZone, BoxZone>;

/// The zone seen from a frame whose origin is at `origin_m`, larger by `margin_m` >= 0 on every
/// side.
[[nodiscard]] Zone moved_and_grown(const Zone& zone, const Vec3& origin_m, double margin_m);

/// Whether any point of the triangle lies in the zone, but for rounding.
[[nodiscard]] bool touches(const Zone& zone, const Triangle& triangle);

} // namespace tactus
