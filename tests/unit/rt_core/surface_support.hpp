// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/force/proxy.hpp"
#include "tests/shared/distance_oracle.hpp"
#include "tests/shared/owned_surface.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

namespace tactus::test
{

using TriangleList = std::vector<std::array<Vec3f, 3>>;

/// A square of two triangles, counter-clockwise from its first corner.
inline void add_square(TriangleList& list, const Vec3& a, const Vec3& b, const Vec3& c,
                       const Vec3& d)
{
    list.push_back({to_float(a), to_float(b), to_float(c)});
    list.push_back({to_float(a), to_float(c), to_float(d)});
}

/// The plane z = 0, 2 m wide.
[[nodiscard]] inline TriangleList plane()
{
    TriangleList list;
    add_square(list, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
    return list;
}

/// The surface of the cube of half edge `half` round the origin, seen from both sides.
[[nodiscard]] inline TriangleList cube(double half)
{
    TriangleList list;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
        for (const double side : {-half, half})
        {
            const auto corner = [&](double u, double v)
            {
                Vec3 point;
                point[axis] = side;
                point[(axis + 1) % 3] = u * half;
                point[(axis + 2) % 3] = v * half;
                return point;
            };
            add_square(list, corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1));
        }
    }
    return list;
}

/// The nearest distance from a point to the triangles.
[[nodiscard]] inline double distance_to(const TriangleList& list, const Vec3& point)
{
    double least = std::numeric_limits<double>::infinity();
    for (const auto& corners : list)
    {
        least = std::min(
            least, static_cast<double>(DistanceOracle::distance(point, to_triangle(corners))));
    }
    return least;
}

/// What a query at `center_m` would say of these triangles with everything in `certified_m` exact.
[[nodiscard]] inline std::unique_ptr<OwnedSurface>
surface_of(const TriangleList& list, const Vec3& center_m, double certified_m)
{
    auto surface = std::make_unique<OwnedSurface>();
    surface->center_m = center_m;
    surface->answer.certified_radius_m = certified_m;
    surface->answer.lower_m = std::max(0.0, std::min(certified_m, distance_to(list, center_m)));
    for (std::uint32_t i = 0; i < list.size(); ++i)
    {
        const auto d =
            static_cast<double>(DistanceOracle::distance(center_m, to_triangle(list[i])));
        if (d <= certified_m)
        {
            surface->triangles[surface->count] = {PrimId{i}, list[i]};
            surface->distances_m[surface->count++] = std::max(0.0, d * (1.0 - 1e-14));
        }
    }
    return surface;
}

} // namespace tactus::test
