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
    /// True if they share a point. False if `nearest.lower` is above zero, true if `nearest.upper`
    /// is within rounding: for touching within 6e-15 local lengths. In between libccd decides.
    bool meet{false};
    /// True if libccd was asked and contradicts the proven bounds: to be counted. libccd takes gaps
    /// below about 1e-8 of the size for touching and may miss mere touching. Elsewhere, many of
    /// these indicate a support function that breaks its contract.
    bool is_ccd_overruled{false};
};

/// Arguments, law and limits are those of gjk_distance. libccd's GJK intersection is also
/// evaluated, except for triangles proven beyond `limit`.
///
/// libccd judges zero by absolute size, so its input is relative to the body's centre and scaled to
/// about 1. Without libccd (a replay on another processor) an open question counts as yes. Takes
/// 0.1 us more than gjk_distance if they are apart, 0.5 to 1.7 us if near.
[[nodiscard]] ConvexContact contact_of(const ConvexBody& body, const Triangle& triangle,
                                       Vec3& direction,
                                       double limit = kInfinity) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
