// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/convex.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/triangle.hpp"

#include <cstdint>

namespace tactus
{

/// Rounding of a bound, in local lengths: 23 roundings of a support point's place and of the
/// products with it, rounded up.
inline constexpr double kGjkRounding = 3e-15;

/// Bounds on the distance of a convex body and a triangle: at least `lower` and at most `upper`.
struct GjkAnswer
{
    Vec3 on_body{0.0, 0.0, 0.0};
    Vec3 on_triangle{0.0, 0.0, 0.0};
    /// Vector from the first to the second, free of the rounding of large coordinates.
    Vec3 gap{0.0, 0.0, 0.0};
    /// Length of `gap`, which joins points of both, raised by rounding. Zero if they are proven to
    /// overlap in more than a point.
    double upper{0.0};
    /// Distance along one direction between the body's farthest point and the triangle's nearest,
    /// lowered by rounding. Zero if no direction shows that they are apart.
    double lower{0.0};
    /// Allowance for rounding in each of the bounds. If `upper` is at most twice this, body and
    /// triangle as good as touch.
    double rounding{0.0};
    std::uint32_t iterations{0}; ///< Support points computed, kGjkIterations at most.
    TriangleFeature feature{TriangleFeature::interior}; ///< Feature of the triangle.
};

/// Distance by Gilbert, Johnson and Keerthi. The simplex consists of differences between points of
/// the triangle and of the body. Its point nearest to zero is kept, and a direction towards that
/// gives the next farthest points, whose difference bounds the distance from below and joins the
/// simplex.
///
/// lower <= distance <= upper always, even if iterations or precision run out, since neither
/// follows from convergence. Their difference obeys the law, for hulls of any shape, flat ones and
/// points too:
///
///     upper - lower <= 1e-12 x distance + 1e-14 x local length
///
/// with the local length = radius + largest distance of a corner from the centre. For bodies with
/// curved surfaces it holds if kGjkIterations suffice. If double ends before that, on needles and
/// where features are nearly parallel and near, the simplex is solved in double-double.
///
/// Stops as soon as `lower` > `limit`: the distance beyond that is not needed.
///
/// `direction` is the start, from body to triangle: zero, or the result of the last query of the
/// same body and a triangle nearby, which saves a step or two. It returns the direction of `lower`,
/// of length 1. The same arguments give the same bits; another direction may give other ones,
/// within the law.
///
/// Any triangle; coordinates up to 1e300. Those below 1e-85 of the largest may count as 0. A box
/// takes 0.6 us apart and 0.9 near, a hull of 64 twice that, 0.2 to 0.3 beyond the limit; curved
/// bodies up to 12 us if near.
[[nodiscard]] GjkAnswer gjk_distance(const ConvexBody& body, const Triangle& triangle,
                                     Vec3& direction,
                                     double limit = kInfinity) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
