// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

// Any thread, except the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// A closed polyhedron with triangular facets, counter-clockwise seen from outside.
struct Polyhedron
{
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> facets; ///< Indices into `vertices`.
};

/// Convex hull of points; those at most `margin` outside the hull of the others may be left out.
/// Exactly convex, since every side is decided exactly. Empty if all points lie within `margin` of
/// a plane. 0.4 ms for 200 points.
[[nodiscard]] Polyhedron convex_hull(std::span<const Vec3> points, double margin);

/// A corner of a polygon in its plane's integer coordinates, each below 2^30 in magnitude.
struct LoopCorner
{
    std::int64_t x{0};
    std::int64_t y{0};
    std::uint32_t name{0}; ///< Name of the corner; corners of equal names have equal coordinates.
};

using CornerLoop = std::vector<LoopCorner>;

/// Triangles, by the names of their corners, that fill the region left of the closed loops. Their
/// oriented edges cancel except for those of the loops, for any loops: also if they cross or touch
/// each other, or enclose no area. Triangles have three different names; flat ones occur. For a
/// loop of n corners n^2 steps.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>>
triangles_of_loops(std::vector<CornerLoop> loops);

} // namespace tactus
