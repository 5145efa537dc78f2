// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/shapes.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/math/triple.hpp"

#include <array>
#include <optional>

namespace tactus
{

// Nearest points of two features, in double for a filter, and in double-double for a decision.
// Double-double is exact to about 1e-30 of the lengths, with the exceptions in each comment.

/// Square of the sine of an angle, 1e-6 rad, up to which segments count as parallel.
inline constexpr double kParallel = 1e-12;

template <typename Real>
[[nodiscard]] Real clamp_to_unit(const Real& value) noexcept
{
    return !(value > Real{0.0}) ? Real{0.0} : (value > Real{1.0} ? Real{1.0} : value);
}

/// Nearest points of two segments, as parameters of from + parameter (to - from), and the vector
/// from the first point to the second.
template <typename Real>
struct SegmentsApproach
{
    Real first_parameter;
    Real second_parameter;
    Triple<Real> gap;
    /// True if the segments are parallel (kParallel): double may then be wrong about which features
    /// are nearest.
    bool is_parallel;
};

/// Solves for the nearest points of two lines by their cross product n: s = -((p - q) x v) . n /
/// n.n. Unlike the Gram determinant |u|^2 |v|^2 - (u.v)^2, n.n is no difference of nearly equal
/// numbers. The distance of the lines is h, their angle a, and a rounding r (2^-53 or 2^-104). The
/// points are wrong by r in lengths, and by h r / a along the lines. Across the lines this is at
/// most min(h r / a, a) <= sqrt(h r), which changes the distance by a few roundings at any angle.
template <typename Real>
[[nodiscard]] SegmentsApproach<Real> approach_segments(const Segment& first,
                                                       const Segment& second) noexcept
{
    const auto u = difference<Real>(first.to, first.from);
    const auto v = difference<Real>(second.to, second.from);
    const auto w = difference<Real>(first.from, second.from);
    const auto n = cross(u, v);
    const Real uu = dot(u, u);
    const Real vv = dot(v, v);
    const Real nn = dot(n, n);
    const Real zero{0.0};
    const Real uv = dot(u, v);
    Real s = nn > zero ? clamp_to_unit(-(dot(cross(w, v), n) / nn)) : zero;
    const Real t = vv > zero ? clamp_to_unit((dot(w, v) + s * uv) / vv) : zero;
    // The second pass is needed since t may have been clamped, or s undefined; it only brings the
    // points nearer.
    s = uu > zero ? clamp_to_unit((t * uv - dot(w, u)) / uu) : zero;
    return {s, t, t * v - w - s * u, !(nn > Real{kParallel} * (uu * vv))};
}

/// Vector from a point to its foot on a triangle's plane; none if the foot is not inside the
/// triangle.
template <typename Real>
[[nodiscard]] std::optional<Triple<Real>> approach_face(const Vec3& point,
                                                        const Triangle& triangle) noexcept
{
    const std::array<Triple<Real>, 3> edge{difference<Real>(triangle[1], triangle[0]),
                                           difference<Real>(triangle[2], triangle[1]),
                                           difference<Real>(triangle[0], triangle[2])};
    const auto normal = cross(edge[0], edge[1]);
    const Real normal_sq = dot(normal, normal);
    if (!(normal_sq > Real{kLeastTrustedNormalSq}))
    {
        return std::nullopt;
    }
    for (std::size_t i = 0; i < 3; ++i)
    {
        if (!(dot(cross(edge[i], normal), difference<Real>(triangle[i], point)) > Real{0.0}))
        {
            return std::nullopt;
        }
    }
    return (dot(difference<Real>(triangle[0], point), normal) / normal_sq) * normal;
}

/// Point of a segment nearest to a box, and the vector to it from the nearest point of the box.
template <typename Real>
struct BoxApproach
{
    Real parameter;
    Triple<Real> gap;
};

/// Signed distance of `x` beyond the range -half .. half; 0 inside.
template <typename Real>
[[nodiscard]] Real excess(const Real& x, const Real& half) noexcept
{
    return x > half ? x - half : (x < -half ? x + half : Real{0.0});
}

/// Search for the point of a segment nearest to a box. The squared distance is convex along the
/// segment, and quadratic between the up to six places where a coordinate enters or leaves the box.
/// The slope at each of these shows on which side the minimum is; between the last two it is
/// solved.
template <typename Real>
class SegmentAndBox
{
public:
    SegmentAndBox(const Segment& segment, const Box& box) noexcept
        : from_(as_array(to_triple<Real>(segment.from)))
        , way_(as_array(difference<Real>(segment.to, segment.from)))
        , half_(as_array(to_triple<Real>(box.half)))
    {
    }

    [[nodiscard]] BoxApproach<Real> approach() const noexcept
    {
        return place_at(nearest_parameter());
    }

    /// approach() with a guess of the parameter: a third of the work if the guess is proven;
    /// otherwise the guess is ignored.
    [[nodiscard]] BoxApproach<Real> approach_near(double near) const noexcept
    {
        const std::optional<Real> parameter = solve_near(Real{near});
        return place_at(parameter ? *parameter : nearest_parameter());
    }

private:
    using Coordinates = std::array<Real, 3>;
    /// Side of the box for each coordinate: before it (-1), within (0) or beyond (1).
    using Sides = std::array<int, 3>;

    static Coordinates as_array(const Triple<Real>& v) noexcept { return {v.x, v.y, v.z}; }

    [[nodiscard]] BoxApproach<Real> place_at(const Real& parameter) const noexcept
    {
        return {parameter,
                {excess_at(0, parameter), excess_at(1, parameter), excess_at(2, parameter)}};
    }

    [[nodiscard]] Real excess_at(std::size_t axis, const Real& parameter) const noexcept
    {
        return excess(from_[axis] + parameter * way_[axis], half_[axis]);
    }

    /// Half of the derivative of the squared distance.
    [[nodiscard]] Real slope_at(const Real& parameter) const noexcept
    {
        return way_[0] * excess_at(0, parameter) + way_[1] * excess_at(1, parameter) +
               way_[2] * excess_at(2, parameter);
    }

    [[nodiscard]] Real nearest_parameter() const noexcept
    {
        const Real zero{0.0};
        Real low{0.0};
        Real high{1.0};
        if (!(slope_at(low) < zero))
        {
            return low;
        }
        if (!(slope_at(high) > zero))
        {
            return high;
        }
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            for (const Real& side : {half_[axis], -half_[axis]})
            {
                const Real at = way_[axis] == zero ? low : (side - from_[axis]) / way_[axis];
                if (at > low && at < high)
                {
                    (slope_at(at) > zero ? high : low) = at;
                }
            }
        }
        return solve_between(low, high);
    }

    /// Returns the minimum between `low` and `high`, where the same coordinates stay outside of the
    /// box.
    [[nodiscard]] Real solve_between(const Real& low, const Real& high) const noexcept
    {
        const Real at = solve(sides_at(Real{0.5} * (low + high))).value_or(low);
        return at < low ? low : (at > high ? high : at);
    }

    /// Solves for the minimum with the sides of `near`; none unless the slope there is proven to be
    /// zero or, at an end, to point out of the segment.
    [[nodiscard]] std::optional<Real> solve_near(const Real& near) const noexcept
    {
        const Real zero{0.0};
        const Real one{1.0};
        if (!(near > zero))
        {
            return slope_at(zero) < zero ? std::nullopt : std::optional(zero);
        }
        if (!(near < one))
        {
            return slope_at(one) < zero ? std::optional(one) : std::nullopt;
        }
        const Sides sides = sides_at(near);
        const std::optional<Real> at = solve(sides);
        return at && *at > zero && *at < one && sides_at(*at) == sides ? at : std::nullopt;
    }

    /// Returns the parameter of zero slope if each coordinate were on this side everywhere.
    [[nodiscard]] std::optional<Real> solve(const Sides& sides) const noexcept
    {
        Real towards{0.0};
        Real way_sq{0.0};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            if (sides[axis] != 0)
            {
                const Real side = sides[axis] > 0 ? half_[axis] : -half_[axis];
                towards = towards + way_[axis] * (side - from_[axis]);
                way_sq = way_sq + way_[axis] * way_[axis];
            }
        }
        return way_sq > Real{0.0} ? std::optional(towards / way_sq) : std::nullopt;
    }

    [[nodiscard]] Sides sides_at(const Real& parameter) const noexcept
    {
        Sides sides{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const Real outside = excess_at(axis, parameter);
            sides[axis] = outside > Real{0.0} ? 1 : (outside < Real{0.0} ? -1 : 0);
        }
        return sides;
    }

    Coordinates from_;
    Coordinates way_;
    Coordinates half_;
};

} // namespace tactus
