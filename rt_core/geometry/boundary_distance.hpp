// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/closest_points.hpp"

#include <span>

namespace tactus
{

/// Nearest points of the boundaries of a shape and a triangle: of edges and edges, and of corners
/// and faces. The shape is a segment or a triangle with these `corners`. The results are nearest
/// points of the shapes only if no edge pierces a face.
///
/// All pairs of features are compared in double, and those that double can't separate in
/// double-double. So |computed - true| <= 4e-16 x local length for any shape. `meet` is left false.
/// The largest coordinate must be between 2^-60 and 2^60.
[[nodiscard]] ClosestPoints
nearest_boundary_points(std::span<const Vec3> corners,
                        const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

/// Local length, the unit of the error law above: the longest of both shapes' edges and of the
/// distances between their corners.
[[nodiscard]] double local_length(std::span<const Vec3> corners,
                                  const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
