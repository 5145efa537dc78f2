// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/shape_scenes.hpp"

#include <vector>

namespace tactus::test
{

/// The vertices of a convex hull and a triangle.
struct HullScene
{
    std::vector<Vec3> vertices;
    Triangle triangle;
};

/// The second of the pair and a hull round the first: points, segments, polygons, tetrahedra,
/// prisms, boxes, octahedra and up to twelve vertices anywhere, flat, thin and doubled ones too.
[[nodiscard]] HullScene hull_scene(const TrianglePair& pair, Random& random);

} // namespace tactus::test
