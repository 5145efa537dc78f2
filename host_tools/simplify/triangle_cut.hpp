// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/fragment_pool.hpp"
#include "host_tools/simplify/point_triangle.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/math/vec3.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

/// An original triangle, by one corner and two sides.
struct TriangleFrame
{
    Vec3 origin;
    Vec3 side_x;
    Vec3 side_y;

    [[nodiscard]] Vec3 point(const TrianglePoint& at) const noexcept;
    /// Maximum displacement of a point by one cut's rounding, in quanta.
    [[nodiscard]] double rounding() const noexcept;
};

[[nodiscard]] TriangleFrame frame_of(const QuantisedMesh& mesh, std::uint32_t triangle) noexcept;

/// Part of an original triangle during one re-assignment. `points` are indices into the star's
/// PointColumns; `generation` is the number of cuts that produced the part.
struct Part
{
    std::array<TrianglePoint, 3> at{};
    std::array<std::uint32_t, 3> points{};
    std::uint32_t generation{0};
};

/// Half of the plane through `start` with normal `normal`: the points p with (p - start) . along >
/// 0.
struct CutPlane
{
    Vec3 start;
    Vec3 along;
    Vec3 normal;
};

/// Parts of a triangle cut by a plane, at most three.
using CutParts = StaticVector<Part, 3>;

/// Cuts the part, appends the cut points to `points` and returns the parts; no part if the half
/// plane does not cross it. The parts cover the original except for gaps of at most rounding();
/// their generation counts the cuts whose gaps the bound must include.
[[nodiscard]] CutParts cut(const Part& part, const TriangleFrame& frame, const CutPlane& plane,
                           PointColumns& points);

} // namespace tactus
