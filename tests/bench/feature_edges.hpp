// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/math/vec3.hpp"

#include <vector>

namespace tactus::bench
{

struct Segment
{
    Vec3 from{0.0, 0.0, 0.0};
    Vec3 to{0.0, 0.0, 0.0};
};

/// Edges of one face alone.
[[nodiscard]] std::vector<Segment> border_edges(const TriangleMesh& mesh);

/// Edges at which the surface turns by more than `angle_deg`, 0 .. 180; faces without an area turn
/// nothing.
[[nodiscard]] std::vector<Segment> sharp_edges(const TriangleMesh& mesh, double angle_deg);

/// The largest distance of points of `lines` to the nearest of `others`; the points include the
/// ends and are at most a `points`-th of the whole length apart. Infinity when there are no others,
/// 0 without lines. One by one: their product decides the cost.
[[nodiscard]] double largest_distance(const std::vector<Segment>& lines,
                                      const std::vector<Segment>& others, unsigned points);

} // namespace tactus::bench
