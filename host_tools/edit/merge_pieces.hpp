// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/edit/surface_faces.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/math/vec3.hpp"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

// Any thread, except the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// The nearest of several triangles to a point, and its squared distance.
[[nodiscard]] std::pair<std::size_t, double> nearest_of(std::span<const Triangle> faces,
                                                        const Vec3& point);

/// Removes vertices of a part of a surface. A vertex is removed by moving it to a neighbour, so all
/// edges that cancelled before still do, and all vertices stay on the grid. Vertices of `fixed`
/// stay, and those where `faces` don't form one closed fan.
///
/// Tolerance. Errors of successive merges don't add up. Each removed point becomes a mark of the
/// nearest face that replaces it: vertices, and crossings of old with new edges where these are far
/// apart. A removal is allowed if the old and the new faces are at most `slack_quanta` apart, and
/// all marks of the old faces lie within `slack_quanta` of the new ones. So every mark stays within
/// the slack of the surface; points between marks were found up to 1.1 slacks away. A face keeps
/// kMaxMarks marks: the farthest from its plane, and of the others those far from each other.
void merge_pieces(std::vector<SurfaceFace>& faces, std::span<const GridPoint> fixed,
                  double slack_quanta);

} // namespace tactus
