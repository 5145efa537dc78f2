// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/triangle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tactus::test
{

/// Square root, right to the last bit but one, also in types wider than long double.
template <typename Real>
[[nodiscard]] Real square_root(Real value)
{
    const auto start = static_cast<Real>(std::sqrt(static_cast<long double>(value)));
    return start > 0 ? (start + value / start) / 2 : start;
}

/// Point-triangle distance in a wider precision and by another method than the kernel's: the
/// triangle is rotated into its own plane by orthogonalising its edges (longest edge first, twice),
/// where two coordinates decide about inside. Its error is a few 2^-64 x aspect x local length in
/// long double.
template <typename RealNumber>
class BasicDistanceOracle
{
public:
    using Real = RealNumber;
    using Point = std::array<Real, 3>;
    static constexpr auto kInfinity =
        static_cast<Real>(std::numeric_limits<long double>::infinity());

    [[nodiscard]] static Real distance(const Vec3& query, const Triangle& triangle)
    {
        return distance({difference(triangle[0], query), difference(triangle[1], query),
                         difference(triangle[2], query)});
    }

    /// Distance from the origin to a triangle.
    [[nodiscard]] static Real distance(const std::array<Point, 3>& corner)
    {
        const Real edges =
            std::min({to_segment(corner[0], corner[1]), to_segment(corner[1], corner[2]),
                      to_segment(corner[2], corner[0])});
        return std::min(edges, to_interior(corner));
    }

    [[nodiscard]] static Real to_segment(const Vec3& query, const Vec3& from, const Vec3& to)
    {
        return to_segment(difference(from, query), difference(to, query));
    }

    /// Distance from the origin to a segment, by the signs of the two end angles.
    static Real to_segment(const Point& from, const Point& to)
    {
        const Point edge = along(to, -1, from);
        if (dot(from, edge) >= 0)
        {
            return norm(from);
        }
        if (dot(to, edge) <= 0)
        {
            return norm(to);
        }
        return norm(along(from, -dot(from, edge) / dot(edge, edge), edge));
    }

    static Point difference(const Vec3& a, const Vec3& b)
    {
        return {static_cast<Real>(a.x()) - static_cast<Real>(b.x()),
                static_cast<Real>(a.y()) - static_cast<Real>(b.y()),
                static_cast<Real>(a.z()) - static_cast<Real>(b.z())};
    }
    static Real dot(const Point& a, const Point& b)
    {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    static Real norm(const Point& a) { return square_root(dot(a, a)); }
    /// a + factor x b
    static Point along(const Point& a, Real factor, const Point& b)
    {
        return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
    }

private:
    /// Height over the plane if the foot is inside, otherwise infinite.
    static Real to_interior(std::array<Point, 3> corner)
    {
        std::size_t longest = 0;
        std::array<Real, 3> length{};
        for (std::size_t i = 0; i < 3; ++i)
        {
            length[i] = norm(along(corner[(i + 1) % 3], -1, corner[i]));
            longest = length[i] > length[longest] ? i : longest;
        }
        std::rotate(corner.begin(), corner.begin() + static_cast<std::ptrdiff_t>(longest),
                    corner.end());
        const Real base = length[longest];
        if (base == 0)
        {
            return kInfinity;
        }
        const Point edge = along(corner[1], -1, corner[0]);
        const Point u{edge[0] / base, edge[1] / base, edge[2] / base};
        Point v = along(corner[2], -1, corner[0]);
        const Real apex = dot(v, u);
        v = along(v, -apex, u);
        v = along(v, -dot(v, u), u);
        const Real height = norm(v);
        if (height == 0)
        {
            return kInfinity;
        }
        v = {v[0] / height, v[1] / height, v[2] / height};
        // Coordinates of the foot: x along the longest edge, y towards the third corner.
        const Real x = -dot(corner[0], u);
        const Real y = -dot(corner[0], v);
        const Real left = apex * y / height;
        const Real right = base - (base - apex) * y / height;
        if (y < 0 || y > height || x < left || x > right)
        {
            return kInfinity;
        }
        return norm(along(along(corner[0], x, u), y, v));
    }
};

using DistanceOracle = BasicDistanceOracle<long double>;

/// Distance of a point from a stored face.
template <typename Real>
[[nodiscard]] Real wide_distance(const std::array<Real, 3>& point, const std::array<Vec3f, 3>& face)
{
    std::array<std::array<Real, 3>, 3> corners{};
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            corners[corner][axis] = static_cast<Real>(face[corner][axis]) - point[axis];
        }
    }
    return BasicDistanceOracle<Real>::distance(corners);
}

/// Type wider than long double, if the machine has one.
#if defined(__SIZEOF_FLOAT128__)
__extension__ using Quad = __float128;
#else
using Quad = long double;
#endif
using QuadDistanceOracle = BasicDistanceOracle<Quad>;

} // namespace tactus::test
