// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/brute_force.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::test
{

namespace
{

using Real = long double;
using LongPoint = std::array<Real, 3>;

LongPoint minus(const LongPoint& a, const LongPoint& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Real product(const LongPoint& a, const LongPoint& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

LongPoint widen(const Vec3f& v)
{
    return {static_cast<Real>(v[0]), static_cast<Real>(v[1]), static_cast<Real>(v[2])};
}

Real distance_to_segment(const LongPoint& p, const LongPoint& a, const LongPoint& b)
{
    const LongPoint edge = minus(b, a);
    const LongPoint from = minus(p, a);
    const Real length_sq = product(edge, edge);
    const Real t =
        length_sq > 0 ? std::clamp(product(from, edge) / length_sq, Real{0}, Real{1}) : 0;
    const LongPoint gap = minus(from, {t * edge[0], t * edge[1], t * edge[2]});
    return std::sqrt(product(gap, gap));
}

} // namespace

long double brute_distance(const Vec3& point, const Face& face)
{
    const LongPoint p{static_cast<Real>(point.x()), static_cast<Real>(point.y()),
                      static_cast<Real>(point.z())};
    const LongPoint a = widen(face[0]);
    const LongPoint b = widen(face[1]);
    const LongPoint c = widen(face[2]);
    Real best = std::min(
        {distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
    // Barycentric coordinates of the foot on the plane, by the Gram matrix of two edges.
    const LongPoint u = minus(b, a);
    const LongPoint v = minus(c, a);
    const LongPoint w = minus(p, a);
    const Real uu = product(u, u);
    const Real uv = product(u, v);
    const Real vv = product(v, v);
    const Real determinant = uu * vv - uv * uv;
    if (determinant > 0)
    {
        const Real s = (vv * product(w, u) - uv * product(w, v)) / determinant;
        const Real t = (uu * product(w, v) - uv * product(w, u)) / determinant;
        if (s >= 0 && t >= 0 && s + t <= 1)
        {
            const LongPoint gap{w[0] - s * u[0] - t * v[0], w[1] - s * u[1] - t * v[1],
                                w[2] - s * u[2] - t * v[2]};
            best = std::min(best, std::sqrt(product(gap, gap)));
        }
    }
    return best;
}

long double brute_distance(const Vec3& point, const std::vector<Face>& faces)
{
    long double best = std::numeric_limits<long double>::infinity();
    for (const Face& face : faces)
    {
        best = std::min(best, brute_distance(point, face));
    }
    return best;
}

} // namespace tactus::test
