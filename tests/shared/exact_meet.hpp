// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/triangle.hpp"

namespace tactus::test
{

/// Whether two triangles share a point, their finite double coordinates taken for exact: by signs
/// of volumes and areas in double where its rounding can't change them, else in integers of any
/// width. Triangles may be without area, and boundaries belong to them.
///
/// They do if an edge of one meets the other. An edge that is not in the other's plane meets it
/// where it passes the plane: on one side of all three edges. For what is in one plane the three
/// shadows along the axes are asked: what meets does so in each of them, and in one of them nothing
/// falls together that was apart. 200 ns; some microseconds where integers are needed.
[[nodiscard]] bool exactly_meet(const Triangle& first, const Triangle& second);

/// Whether the segment between two places that differ shares a point with a triangle, as above.
/// Much faster than a triangle with two equal corners, whose volumes are all 0.
[[nodiscard]] bool exactly_meet(const Vec3& from, const Vec3& to, const Triangle& triangle);

/// The sign of the volume of a tetrahedron, of det(b - a, c - a, d - a).
[[nodiscard]] int exact_volume_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

} // namespace tactus::test
