// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/math/vec3.hpp"

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

// Closed shapes for tests against triangles, in the triangle's frame and unit of length. Each may
// be degenerate: a segment may be a point, a box a rectangle, and a radius zero.

/// All points between two ends.
struct Segment
{
    Vec3 from{0.0, 0.0, 0.0};
    Vec3 to{0.0, 0.0, 0.0};
};

/// Point of a segment at `parameter`, 0 .. 1 (asserted). It is computed from the nearer end, so
/// that parameters 0 and 1 give the ends exactly.
[[nodiscard]] inline Vec3 point_at(const Segment& segment, double parameter) noexcept
{
    TACTUS_ASSERT(parameter >= 0.0);
    TACTUS_ASSERT(parameter <= 1.0);
    return parameter <= 0.5 ? Vec3(segment.from + parameter * (segment.to - segment.from))
                            : Vec3(segment.to - (1.0 - parameter) * (segment.to - segment.from));
}

/// Box centred at the origin and parallel to the axes; the triangle must be given in its frame.
struct Box
{
    Vec3 half{0.0, 0.0, 0.0}; ///< Half extents, not negative.
};

/// All points within a radius of a center.
struct Sphere
{
    Vec3 center{0.0, 0.0, 0.0};
    double radius{0.0}; ///< Not negative.
};

/// All points within the radius of a segment.
struct Capsule
{
    Segment core;
    double radius{0.0}; ///< Not negative.
};

} // namespace tactus
