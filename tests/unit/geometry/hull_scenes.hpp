// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/shape_scenes.hpp"

#include <vector>

namespace tactus::test
{

/// Vertices of a convex hull, and a triangle.
struct HullScene
{
    std::vector<Vec3> vertices;
    Triangle triangle;
};

/// The second triangle of the pair and a hull around the first: points, segments, polygons,
/// tetrahedra, prisms, boxes, octahedra and up to twelve random vertices, including flat, thin and
/// duplicate ones.
[[nodiscard]] HullScene hull_scene(const TrianglePair& pair, Random& random);

} // namespace tactus::test
