// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::test
{

template <typename Real>
using Point = std::array<Real, 3>;

template <typename Real>
[[nodiscard]] inline Real dot(const Point<Real>& a, const Point<Real>& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// a + s b + t c
template <typename Real>
[[nodiscard]] inline Point<Real> combined(const Point<Real>& a, Real s, const Point<Real>& b,
                                          Real t, const Point<Real>& c)
{
    return {a[0] + s * b[0] + t * c[0], a[1] + s * b[1] + t * c[1], a[2] + s * b[2] + t * c[2]};
}

template <typename Real>
[[nodiscard]] inline Point<Real> difference(const Point<Real>& a, const Point<Real>& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// Point of a triangle nearest to `p`: the foot on the plane if it is inside all three edges,
/// otherwise the nearest point of the at most two edges that it is outside of. For any precision:
/// the peers use float as their users do, the truth double. Exact to rounding for triangles of
/// ordinary shape, as in all scenes here.
template <typename Real>
[[nodiscard]] inline Point<Real> closest_on_triangle(const Point<Real>& p, const Point<Real>& a,
                                                     const Point<Real>& b, const Point<Real>& c)
{
    const Point<Real> u = difference(b, a);
    const Point<Real> v = difference(c, a);
    const Point<Real> w = difference(p, a);
    const Real uu = dot(u, u);
    const Real uv = dot(u, v);
    const Real vv = dot(v, v);
    const Real wu = dot(w, u);
    const Real wv = dot(w, v);
    const Real area_sq = uu * vv - uv * uv;
    const Real s = vv * wu - uv * wv; // Barycentric coordinates times area_sq.
    const Real t = uu * wv - uv * wu;
    if (s > 0 && t > 0 && s + t < area_sq)
    {
        return combined(a, s / area_sq, u, t / area_sq, v);
    }
    Point<Real> best = a;
    Real best_sq = dot(w, w);
    const auto try_edge = [&](const Point<Real>& from, const Point<Real>& edge, Real along, Real sq)
    {
        const Real share = sq > 0 ? std::clamp(along / sq, Real{0}, Real{1}) : Real{0};
        const Point<Real> foot = combined(from, share, edge, Real{0}, edge);
        const Point<Real> gap = difference(p, foot);
        if (const Real gap_sq = dot(gap, gap); gap_sq < best_sq)
        {
            best = foot;
            best_sq = gap_sq;
        }
    };
    if (t <= 0)
    {
        try_edge(a, u, wu, uu);
    }
    if (s <= 0)
    {
        try_edge(a, v, wv, vv);
    }
    if (s + t >= area_sq)
    {
        const Point<Real> edge = difference(c, b);
        try_edge(b, edge, dot(difference(p, b), edge), dot(edge, edge));
    }
    return best;
}

} // namespace tactus::test
