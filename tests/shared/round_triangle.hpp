// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/geometry/shapes.hpp"

namespace tactus
{

// Nearest points of a round shape and a triangle. The shape is all points within a radius of its
// core, a point or a segment. The distance is the core's less the radius, so it is negative if
// shape and triangle overlap; `gap` then points back. If the core meets the triangle, both points
// are the shared one, `gap` is zero, and the distance minus the radius.
//
// `meet` means a distance of 0 or less, up to `distance_error`: the core's plus 1.2e-16 x radius.

/// |computed - true| <= (4e-16 + 1e-16 x aspect) x local length + 1.2e-16 x radius, with an aspect
/// counted up to 8. Coordinates up to 1e150. About 80 ns.
[[nodiscard]] ClosestPoints closest_points(const Sphere& sphere,
                                           const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

/// |computed - true| <= 4e-16 x local length + 1.2e-16 x radius. Range and cost are those of
/// closest_points() for a segment.
[[nodiscard]] ClosestPoints closest_points(const Capsule& capsule,
                                           const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
