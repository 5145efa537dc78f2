// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/shapes.hpp"
#include "tests/shared/distance_oracle.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace tactus::test
{

/// Distances of shapes by brute force over their features in a wider precision: the Gram
/// determinant where the kernels use cross products, a triangle's own plane where they use normals,
/// twelve triangles for a box, and the distance of the piercing point for a piercing edge. Nothing
/// is decided: every number is the distance of two points on the shapes, except for rounding.
template <typename Real>
class ShapeOracle
{
public:
    using Base = BasicDistanceOracle<Real>;
    using Point = typename Base::Point;

    /// Distance of two or three corners from a triangle.
    [[nodiscard]] static Real distance(std::span<const Vec3> corners, const Triangle& triangle)
    {
        Real least = Base::kInfinity;
        for (const Vec3& corner : corners)
        {
            least = std::min(least, Base::distance(corner, triangle));
        }
        const std::size_t edges = corners.size() == 2 ? 1 : corners.size();
        for (std::size_t i = 0; i < edges; ++i)
        {
            const Segment edge{corners[i], corners[(i + 1) % corners.size()]};
            least = std::min(least, piercing(edge, triangle));
            for (std::size_t j = 0; j < 3; ++j)
            {
                least = std::min(least, of_segments(edge, {triangle[j], triangle[(j + 1) % 3]}));
            }
        }
        if (corners.size() == 3)
        {
            const Triangle first{corners[0], corners[1], corners[2]};
            for (std::size_t j = 0; j < 3; ++j)
            {
                least = std::min({least, Base::distance(triangle[j], first),
                                  piercing({triangle[j], triangle[(j + 1) % 3]}, first)});
            }
        }
        return least;
    }

    [[nodiscard]] static Real distance(const Box& box, const Triangle& triangle)
    {
        const auto is_inside = [&box](const Vec3& point)
        { return ((box.half - point.cwiseAbs()).array() >= 0.0).all(); };
        if (is_inside(triangle[0]) || is_inside(triangle[1]) || is_inside(triangle[2]))
        {
            return 0;
        }
        Real least = Base::kInfinity;
        for (int axis = 0; axis < 3; ++axis)
        {
            for (const double side : {-1.0, 1.0})
            {
                const Triangle half = half_of_side(box, axis, side, 1.0);
                const Triangle other_half = half_of_side(box, axis, side, -1.0);
                least = std::min({least, distance(half, triangle), distance(other_half, triangle)});
            }
        }
        return least;
    }

    [[nodiscard]] static Real to_segment(const Vec3& query, const Segment& segment)
    {
        return Base::to_segment(query, segment.from, segment.to);
    }

private:
    static Triangle half_of_side(const Box& box, int axis, double side, double which)
    {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        Triangle corners{box.half, box.half, box.half};
        for (Vec3& corner : corners)
        {
            corner[axis] *= side;
        }
        corners[0][u] *= which;
        corners[0][v] *= which;
        corners[1][u] *= -1.0;
        corners[2][v] *= -1.0;
        return corners;
    }

    static Real of_segments(const Segment& first, const Segment& second)
    {
        const Point u = Base::difference(first.to, first.from);
        const Point v = Base::difference(second.to, second.from);
        const Point w = Base::difference(first.from, second.from);
        Real least = std::min({to_segment(first.from, second), to_segment(first.to, second),
                               to_segment(second.from, first), to_segment(second.to, first)});
        const Real uv = Base::dot(u, v);
        const Real vv = Base::dot(v, v);
        const Real determinant = Base::dot(u, u) * vv - uv * uv;
        if (determinant > 0)
        {
            const Real s = (uv * Base::dot(v, w) - vv * Base::dot(u, w)) / determinant;
            if (s > 0 && s < 1)
            {
                // The search starts at that point, since s and t would be rounded differently on
                // parallel lines.
                const Point from = Base::along({0, 0, 0}, -1, Base::along(w, s, u));
                least = std::min(least, Base::to_segment(from, Base::along(from, 1, v)));
            }
        }
        return least;
    }

    /// Distance from the triangle to the point where the segment crosses its plane.
    static Real piercing(const Segment& segment, const Triangle& triangle)
    {
        const Point u = Base::difference(triangle[1], triangle[0]);
        const Point v = Base::difference(triangle[2], triangle[0]);
        const Point normal{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                           u[0] * v[1] - u[1] * v[0]};
        const Real from = Base::dot(Base::difference(segment.from, triangle[0]), normal);
        const Real to = Base::dot(Base::difference(segment.to, triangle[0]), normal);
        if ((from >= 0 && to >= 0) || (from <= 0 && to <= 0))
        {
            return Base::kInfinity;
        }
        const Real share = from / (from - to);
        const Point way = Base::difference(segment.to, segment.from);
        std::array<Point, 3> corner{};
        for (std::size_t i = 0; i < 3; ++i)
        {
            corner[i] = Base::along(Base::difference(triangle[i], segment.from), -share, way);
        }
        return Base::distance(corner);
    }
};

} // namespace tactus::test
