// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/shapes.hpp"
#include "rt_core/math/triangle.hpp"

#include <optional>

namespace tactus
{

// Exact decisions whether closed shapes share a point, for any shapes (slivers, segments, points,
// coplanar or touching ones). Coordinates must be zero or between 1e-85 and 1e85 in magnitude.

/// True if the segment and the triangle share a point. About 70 ns; 0.3 to 1 us with exact
/// arithmetic.
[[nodiscard]] bool meet(const Segment& segment,
                        const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

/// True if the triangles share a point. About 140 ns; 1 to 2 us with exact arithmetic.
[[nodiscard]] bool meet(const Triangle& first, const Triangle& second) noexcept TACTUS_NONBLOCKING;

/// Point in which a segment that is not in the triangle's plane pierces the triangle.
struct Piercing
{
    /// Parameter of the point from + parameter (to - from); correct to a few units in the last
    /// place.
    double parameter;
    TriangleFeature feature;
};

/// Finds the point in which a segment pierces a triangle. None if they don't meet or are in one
/// plane; in one plane they meet at an edge or an end of the segment.
[[nodiscard]] std::optional<Piercing>
find_piercing(const Segment& segment, const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

/// Point in which an edge of a triangle pierces another triangle.
struct EdgePiercing
{
    const Triangle* triangle; ///< Triangle that the edge belongs to: one of the two arguments.
    std::size_t edge;
    Piercing piercing;
};

/// Finds the first edge of one triangle that pierces the other; edges of `first` come before those
/// of `second`. None if the triangles don't meet or are in one plane.
[[nodiscard]] std::optional<EdgePiercing>
find_edge_piercing(const Triangle& first, const Triangle& second) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
