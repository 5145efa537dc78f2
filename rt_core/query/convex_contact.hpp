// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/gjk.hpp"
#include "rt_core/math/infinity.hpp"

namespace tactus
{

/// Intersection and distance of a convex body and a triangle.
struct ConvexContact
{
    GjkAnswer nearest;
    /// True if body and triangle share a point. False if `nearest.lower` is above zero; true if
    /// `nearest.upper` is within rounding, 6e-15 local lengths. libccd decides between these
    /// bounds.
    bool meet{false};
    /// True if libccd contradicts the proven bounds. libccd takes gaps below about 1e-8 of the size
    /// for touching and may miss mere touching. Further contradictions, if many, indicate a support
    /// function that breaks its contract.
    bool is_ccd_overruled{false};
};

/// Evaluates gjk_distance(), with its arguments, law and limits, and libccd's intersection test,
/// except for triangles proven beyond `limit`.
///
/// libccd judges zero by absolute size, so its input is relative to the body's centre and scaled to
/// about 1. Without libccd (a replay on another processor), an open question counts as meeting.
/// Takes 0.1 us more than gjk_distance() for separate shapes, 0.5 to 1.7 us for near ones.
[[nodiscard]] ConvexContact contact_of(const ConvexBody& body, const Triangle& triangle,
                                       Vec3& direction,
                                       double limit = kInfinity) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
