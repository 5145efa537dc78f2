// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/geometry/hull_scenes.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::test
{
namespace
{

using Vertices = std::vector<Vec3>;

double size_of(const Triangle& triangle)
{
    const double size = std::max((triangle[1] - triangle[0]).cwiseAbs().maxCoeff(),
                                 (triangle[2] - triangle[0]).cwiseAbs().maxCoeff());
    return size > 0.0 ? size : 1.0;
}

/// Extents, mostly equal in all directions, sometimes down to 1e-9 thinner in some.
Vec3 extents(double size, Random& random)
{
    const auto extent = [&]
    { return size * (random.one_in(4) ? std::exp2(random.between(-30.0, 0.0)) : 1.0); };
    const double x = extent();
    const double y = extent();
    return {x, y, extent()};
}

Vertices tetrahedron(const Triangle& base, Random& random)
{
    return {base[0], base[1], base[2], base[0] + random.in_cube(size_of(base))};
}

Vertices prism(const Triangle& base, Random& random)
{
    const Vec3 way = random.in_cube(1.0).cwiseProduct(extents(size_of(base), random));
    return {base[0], base[1], base[2], base[0] + way, base[1] + way, base[2] + way};
}

/// Box, parallel to the axes or rotated.
Vertices box(const Triangle& base, Random& random)
{
    const Vec3 half = extents(size_of(base), random);
    const bool is_upright = random.one_in(2);
    const Vec3 u = is_upright ? Vec3(half.x(), 0, 0) : Vec3(base[1] - base[0]);
    const Vec3 v = is_upright ? Vec3(0, half.y(), 0) : Vec3(base[2] - base[0]);
    const Vec3 w = is_upright ? Vec3(0, 0, half.z()) : random.in_cube(half.z());
    Vertices vertices;
    for (unsigned i = 0; i < 8; ++i)
    {
        vertices.push_back(base[0] + (i & 1U) * u + (i >> 1U & 1U) * v + (i >> 2U) * w);
    }
    return vertices;
}

Vertices octahedron(const Triangle& base, Random& random)
{
    const Vec3 half = extents(size_of(base), random);
    Vertices vertices;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
        Vec3 way(0, 0, 0);
        way[axis] = half[axis];
        vertices.push_back(base[0] + way);
        vertices.push_back(base[0] - way);
    }
    return vertices;
}

Vertices anywhere(const Triangle& base, Random& random)
{
    const Vec3 half = extents(size_of(base), random);
    Vertices vertices;
    for (std::uint32_t count = 4 + random.below(9); count > 0; --count)
    {
        vertices.push_back(base[0] + random.in_cube(1.0).cwiseProduct(half));
    }
    return vertices;
}

/// Vertices near one plane: within 1 to 1e-16 of the size.
Vertices sheet(const Triangle& base, Random& random)
{
    const double thickness = size_of(base) * std::exp2(random.between(-54.0, 0.0));
    Vertices vertices{base[0], base[1], base[2]};
    for (std::uint32_t count = 2 + random.below(6); count > 0; --count)
    {
        Vec3 vertex = base[0] + random.between(-1.0, 1.0) * (base[1] - base[0]);
        vertex += random.between(-1.0, 1.0) * (base[2] - base[0]);
        vertex += random.in_cube(thickness);
        vertices.push_back(vertex);
    }
    return vertices;
}

Vertices hull_round(const Triangle& base, Random& random)
{
    switch (random.below(9))
    {
    case 0:
        return {base[0]};
    case 1:
        return {base[0], base[1]};
    case 2:
        return {base[0], base[1], base[2]};
    case 3:
        return tetrahedron(base, random);
    case 4:
        return prism(base, random);
    case 5:
        return box(base, random);
    case 6:
        return octahedron(base, random);
    case 7:
        return sheet(base, random);
    default:
        return anywhere(base, random);
    }
}

} // namespace

HullScene hull_scene(const TrianglePair& pair, Random& random)
{
    HullScene scene{hull_round(pair.first, random), pair.second};
    if (random.one_in(8))
    {
        scene.vertices.push_back(
            scene.vertices[random.below(static_cast<std::uint32_t>(scene.vertices.size()))]);
    }
    return scene;
}

} // namespace tactus::test
