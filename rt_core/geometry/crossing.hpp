// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/shapes.hpp"
#include "rt_core/math/triangle.hpp"

#include <optional>

namespace tactus
{

// Whether closed shapes share a point: exact decisions, whatever the shapes (slivers, segments,
// points, coplanar or touching ones), as long as coordinates are zero or between 1e-85 and 1e85 in
// magnitude. Nothing here needs the other shape's plane to exist.

/// About 70 ns; 0.3 to 1 us where exact arithmetic decides.
[[nodiscard]] bool meet(const Segment& segment,
                        const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

/// About 140 ns; 1 to 2 us where exact arithmetic decides.
[[nodiscard]] bool meet(const Triangle& first, const Triangle& second) noexcept TACTUS_NONBLOCKING;

/// Where a segment that is not in the triangle's plane pierces the triangle.
struct Piercing
{
    double parameter; ///< from + parameter (to - from), right to a few units in the last place.
    TriangleFeature feature;
};

/// None where they don't meet, and also where they do so in one plane: then an edge meets an edge
/// or a corner of the segment lies in the triangle.
[[nodiscard]] std::optional<Piercing>
find_piercing(const Segment& segment, const Triangle& triangle) noexcept TACTUS_NONBLOCKING;

/// Where an edge of a triangle pierces another triangle.
struct EdgePiercing
{
    const Triangle* triangle; ///< Whose edge it is: one of those that were asked about.
    std::size_t edge;
    Piercing piercing;
};

/// find_piercing() of the first edge that does, those of `first` before those of `second`; none
/// where the two don't meet, and where they do so in one plane.
[[nodiscard]] std::optional<EdgePiercing>
find_edge_piercing(const Triangle& first, const Triangle& second) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
