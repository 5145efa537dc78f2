// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/shape_oracle.hpp"

#include <algorithm>
#include <vector>

namespace tactus::test
{

/// Distance between a convex hull of few vertices and a triangle by brute force: every three
/// vertices span a triangle in the hull, and those with all others on one side form its surface.
/// The result is the least distance of those triangles, and zero if a corner is inside.
template <typename Real>
struct HullOracle
{
    [[nodiscard]] static Real distance(const std::vector<Vec3>& vertices, const Triangle& triangle)
    {
        if (vertices.size() == 1)
        {
            return BasicDistanceOracle<Real>::distance(vertices[0], triangle);
        }
        if (vertices.size() == 2)
        {
            return ShapeOracle<Real>::distance(vertices, triangle);
        }
        Real least = BasicDistanceOracle<Real>::kInfinity;
        bool is_inside = true;
        bool is_solid = false;
        for (std::size_t i = 0; i < vertices.size(); ++i)
        {
            for (std::size_t j = 0; j < i; ++j)
            {
                for (std::size_t k = 0; k < j; ++k)
                {
                    const Triangle face{vertices[i], vertices[j], vertices[k]};
                    const Sides sides = sides_of(face, vertices);
                    if (sides.front && sides.back)
                    {
                        continue; // The triangle is not on the surface.
                    }
                    least = std::min(least, ShapeOracle<Real>::distance(face, triangle));
                    const Real height = height_over(face, triangle[0]);
                    is_solid = is_solid || sides.front || sides.back;
                    is_inside = is_inside && !(sides.front && height <= 0) &&
                                !(sides.back && height >= 0) &&
                                (sides.front || sides.back || sides.is_needle);
                }
            }
        }
        return is_solid && is_inside ? Real{0} : least;
    }

private:
    /// Noise of a volume, in cubes of its size: 64 bits in long double, 113 in wider types.
    static constexpr Real kNoise = static_cast<Real>(
        sizeof(Real) == sizeof(long double) && std::numeric_limits<Real>::digits == 64 ? 1e-18
                                                                                       : 1e-32);
    struct Sides
    {
        bool front{false};
        bool back{false};
        bool is_needle{false}; ///< True if too thin to have sides; its neighbours bound the hull.
    };

    /// Sides of a face with vertices, except those within rounding of its plane.
    static Sides sides_of(const Triangle& face, const std::vector<Vec3>& vertices)
    {
        double size = 0.0;
        for (const Vec3& vertex : vertices)
        {
            size = std::max(size, (vertex - face[0]).norm());
        }
        const double area = (face[1] - face[0]).cross(face[2] - face[0]).norm();
        const Real flat = static_cast<Real>(1e-16 * size * area) +
                          kNoise * static_cast<Real>(size) * static_cast<Real>(size * size);
        Sides sides{false, false, area < 1e-12 * size * size};
        for (const Vec3& vertex : vertices)
        {
            const Real height = height_over(face, vertex);
            sides.front = sides.front || height > flat;
            sides.back = sides.back || height < -flat;
        }
        return sides;
    }

    /// Height multiplied by twice the area.
    static Real height_over(const Triangle& face, const Vec3& point)
    {
        std::array<std::array<Real, 3>, 3> way{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const auto at = static_cast<Eigen::Index>(axis);
            const auto from = static_cast<Real>(face[0][at]);
            way[0][axis] = static_cast<Real>(face[1][at]) - from;
            way[1][axis] = static_cast<Real>(face[2][at]) - from;
            way[2][axis] = static_cast<Real>(point[at]) - from;
        }
        return way[0][0] * (way[1][1] * way[2][2] - way[1][2] * way[2][1]) +
               way[0][1] * (way[1][2] * way[2][0] - way[1][0] * way[2][2]) +
               way[0][2] * (way[1][0] * way[2][1] - way[1][1] * way[2][0]);
    }
};

} // namespace tactus::test
