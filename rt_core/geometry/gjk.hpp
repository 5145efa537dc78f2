// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/convex.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/triangle.hpp"

#include <cstdint>

namespace tactus
{

/// Largest rounding of a bound, in local lengths: 23 roundings of a support point's place and of
/// the products with it, rounded up.
inline constexpr double kGjkRounding = 3e-15;

/// Bounds on the distance of a convex body and a triangle: at least `lower` and at most `upper`.
struct GjkAnswer
{
    Vec3 on_body{0.0, 0.0, 0.0};
    Vec3 on_triangle{0.0, 0.0, 0.0};
    /// Vector from on_body to on_triangle, without the rounding of large coordinates.
    Vec3 gap{0.0, 0.0, 0.0};
    /// Length of `gap`, raised by rounding. Zero if body and triangle are proven to overlap in more
    /// than a point.
    double upper{0.0};
    /// Separation of body and triangle along one direction, lowered by rounding. Zero if no
    /// direction shows that they are apart.
    double lower{0.0};
    /// Allowance for rounding in each of the bounds. Body and triangle may touch if `upper` is at
    /// most twice this.
    double rounding{0.0};
    std::uint32_t iterations{0}; ///< Number of support points computed, kGjkIterations at most.
    /// Feature of the triangle at its nearest point.
    TriangleFeature feature{TriangleFeature::interior};
};

/// Bounds on the distance by the algorithm of Gilbert, Johnson and Keerthi. The simplex consists of
/// differences between points of the triangle and of the body. A direction to its point nearest to
/// zero gives the next farthest points, whose difference bounds the distance from below and joins
/// the simplex.
///
/// The bounds lower <= distance <= upper hold always, even if iterations or precision run out.
/// Their difference obeys this law for hulls of any shape, also flat ones and points:
///
///     upper - lower <= 1e-12 x distance + 1e-14 x local length
///
/// The local length is radius + largest distance of a corner from the centre. The law holds for
/// bodies with curved surfaces if kGjkIterations suffice. If double does not suffice (needles,
/// features that are nearly parallel and near), the simplex is solved in double-double.
///
/// The search stops as soon as `lower` > `limit`.
///
/// `direction` is the start, from body to triangle: zero, or the result for the same body and a
/// triangle nearby, which saves a step or two. It returns the direction of `lower`, of length 1.
/// The same arguments give the same bits; another direction may give other bits within the law.
///
/// Any triangle is allowed, with coordinates up to 1e300; those below 1e-85 of the largest may
/// count as 0. A box takes 0.6 us apart and 0.9 near, a hull of 64 vertices twice that, 0.2 to 0.3
/// beyond the limit; curved bodies up to 12 us if near.
[[nodiscard]] GjkAnswer gjk_distance(const ConvexBody& body, const Triangle& triangle,
                                     Vec3& direction,
                                     double limit = kInfinity) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
