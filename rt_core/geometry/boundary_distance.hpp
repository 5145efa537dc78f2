// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/closest_points.hpp"

#include <span>

namespace tactus
{

/// Nearest points of the boundaries of a segment or a triangle (`corners`, two or three) and a
/// triangle: of edges and edges, and of corners and faces. If an edge pierces a face they are not
/// those of the shapes, which the caller must know.
///
/// All pairs of features are compared in double, and those that it can't separate in double-double,
/// so |computed - true| <= 4e-16 x local length for any shape. `meet` is left false. The largest
/// coordinate must be between 2^-60 and 2^60.
[[nodiscard]] ClosestPoints
nearest_boundary_points(std::span<const Vec3> corners,
                        const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

/// The longest of both shapes' edges and of the distances between their corners: the unit of the
/// law above.
[[nodiscard]] double local_length(std::span<const Vec3> corners,
                                  const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
