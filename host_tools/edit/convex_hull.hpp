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

} // namespace tactus
