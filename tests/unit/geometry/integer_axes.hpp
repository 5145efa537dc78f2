// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/unit/geometry/integer_oracle.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace tactus::test
{

/// Exact and complete test whether a plane separates a hull, which is not flat, of corners on a
/// grid from a triangle, by all possible normals. It tries every plane through three corners of the
/// hull, every product of two edges and the triangle's own plane; most of them belong to no side,
/// which is harmless. For coordinates up to 1,000.
struct IntegerAxes
{
    IntegerAxes(std::span<const GridPoint> hull, const GridTriangle& triangle)
        : hull_(hull), triangle_(triangle)
    {
    }

    [[nodiscard]] static bool is_flat(std::span<const GridPoint> corners)
    {
        for (const GridPoint& a : corners)
        {
            for (const GridPoint& b : corners)
            {
                for (const GridPoint& c : corners)
                {
                    const GridPoint normal = cross(way(corners[0], a), way(b, c));
                    for (const GridPoint& d : corners)
                    {
                        if (dot(normal, way(corners[0], d)) != 0)
                        {
                            return false;
                        }
                    }
                }
            }
        }
        return true;
    }

    [[nodiscard]] bool have_plane_between() const
    {
        const std::array<GridPoint, 3> edges{way(triangle_[0], triangle_[1]),
                                             way(triangle_[1], triangle_[2]),
                                             way(triangle_[2], triangle_[0])};
        if (is_between(cross(edges[0], edges[1])))
        {
            return true;
        }
        for (std::size_t i = 0; i < hull_.size(); ++i)
        {
            for (std::size_t j = 0; j < i; ++j)
            {
                const GridPoint edge = way(hull_[i], hull_[j]);
                if (is_between(cross(edge, edges[0])) || is_between(cross(edge, edges[1])) ||
                    is_between(cross(edge, edges[2])))
                {
                    return true;
                }
                for (std::size_t k = 0; k < j; ++k)
                {
                    if (is_between(cross(edge, way(hull_[i], hull_[k]))))
                    {
                        return true;
                    }
                }
            }
        }
        return false;
    }

private:
    struct Range
    {
        std::int64_t low;
        std::int64_t high;
    };

    static GridPoint way(const GridPoint& from, const GridPoint& to)
    {
        return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    }
    static std::int64_t dot(const GridPoint& a, const GridPoint& b)
    {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    static GridPoint cross(const GridPoint& a, const GridPoint& b)
    {
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }

    static Range extent(std::span<const GridPoint> points, const GridPoint& axis)
    {
        Range range{std::numeric_limits<std::int64_t>::max(),
                    std::numeric_limits<std::int64_t>::min()};
        for (const GridPoint& point : points)
        {
            range.low = std::min(range.low, dot(point, axis));
            range.high = std::max(range.high, dot(point, axis));
        }
        return range;
    }

    [[nodiscard]] bool is_between(const GridPoint& axis) const
    {
        const Range a = extent(hull_, axis);
        const Range b = extent(triangle_, axis);
        return a.high < b.low || b.high < a.low;
    }

    std::span<const GridPoint> hull_;
    const GridTriangle& triangle_;
};

} // namespace tactus::test
