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

/// Edges of a single face.
[[nodiscard]] std::vector<Segment> border_edges(const TriangleMesh& mesh);

/// Edges at which the surface turns by more than `angle_deg`, 0 .. 180; faces without an area do
/// not count.
[[nodiscard]] std::vector<Segment> sharp_edges(const TriangleMesh& mesh, double angle_deg);

/// Greatest distance of points of `lines` to the nearest of `others`. The points include the ends
/// and are at most one `points`-th of the total length apart. Infinity without others, 0 without
/// lines. The cost is the product of both counts.
[[nodiscard]] double largest_distance(const std::vector<Segment>& lines,
                                      const std::vector<Segment>& others, unsigned points);

} // namespace tactus::bench
