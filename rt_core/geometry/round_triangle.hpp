// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/geometry/shapes.hpp"

namespace tactus
{

// Shapes of all points within a radius of a core, a point or a segment. Their distance is the
// core's minus the radius, so it is negative if they overlap the triangle; `gap` then points back.
// If the core itself meets the triangle there is no direction: both points are the shared one,
// `gap` is zero and the distance minus the radius.
//
// `meet` means that the distance is 0 or less, so it is decided up to `distance_error`: the core's
// and 1.2e-16 x radius.

///
/// computed - true| <= (4e-16 + 1e-16 x aspect, counted up to 8) x local length + 1.2e-16 x radius.
/// Coordinates up to 1e150. About 80 ns.
[[nodiscard]] ClosestPoints closest_points(const Sphere& sphere,
                                           const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

/// |computed - true| <= 4e-16 x local length + 1.2e-16 x radius. Range and cost are those of a
/// segment and a triangle.
[[nodiscard]] ClosestPoints closest_points(const Capsule& capsule,
                                           const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
