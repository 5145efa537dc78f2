// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/closest_points.hpp"

#include <span>

namespace tactus
{

/// Nearest points of the boundaries of a segment or a triangle (`corners`, two or three) and a
/// triangle: of edges and edges, and of corners and faces. Where an edge pierces a face they are
/// not those of the shapes; the caller knows.
///
/// All pairs of features are compared in double, and those that it can't tell apart in
/// double-double, so |computed - true| <= 4e-16 x local length for any shape. `meet` is left false.
/// Coordinates between 2^-60 and 2^60, the largest of them.
[[nodiscard]] ClosestPoints
nearest_boundary_points(std::span<const Vec3> corners,
                        const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

/// The longest of the edges of both and the ways between their corners: the unit of the law above.
[[nodiscard]] double local_length(std::span<const Vec3> corners,
                                  const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
