// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/geometry/shapes.hpp"

namespace tactus
{

/// True if a box and a triangle share a point. The 13 separating axes (three of the box, the
/// triangle's normal, nine products of edges) are each decided exactly, for coordinates that are
/// zero or between 1e-85 and 1e85 in magnitude. Box and triangle may be flat. About 130 ns; 3 if a
/// corner of the triangle is in the box.
[[nodiscard]] bool meet(const Box& box, const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

/// Nearest points of a box and a triangle in the box's frame; if they meet, a shared point. If a
/// corner of the triangle is in the box, it is that point. Error law and range are those of a
/// segment and a triangle; the local length includes the box's diagonal and the distances to its
/// corners. About 80 ns if a corner is nearest, 400 otherwise, 5 to 200 if they meet.
[[nodiscard]] ClosestPoints closest_points(const Box& box,
                                           const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
