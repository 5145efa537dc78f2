// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/brute_force.hpp"

#include <cstdint>
#include <random>
#include <vector>

namespace tactus::test
{

/// Points of a mesh's surface. Corners, where a distance to one face is largest; points of faces
/// drawn evenly, so that small faces get their share; and points drawn evenly by area, so that
/// large ones do.
class SurfacePoints
{
public:
    /// `faces`, at least one, must outlive it.
    SurfacePoints(const std::vector<Face>& faces, std::uint64_t seed);

    /// A corner, a point of any face, a point of the area: a third of the points each.
    [[nodiscard]] std::vector<Vec3> draw(std::size_t count);
    /// Evenly by area.
    [[nodiscard]] Vec3 draw_by_area();

private:
    [[nodiscard]] Vec3 draw_corner();
    [[nodiscard]] Vec3 draw_by_face();
    [[nodiscard]] Vec3 point_of(std::size_t face);

    const std::vector<Face>& faces_;
    std::vector<double> area_up_to_; ///< Of the first faces, each included.
    std::mt19937_64 random_;
};

/// A raster over each face, `fineness` points on a side less one: its corners, points of its edges
/// and inside. Calls `visit(point)`; points of edges come once for each of their faces.
template <typename Visit>
void visit_raster(const std::vector<Face>& faces, std::uint32_t fineness, const Visit& visit)
{
    for (const Face& face : faces)
    {
        const Vec3 a = to_vec3(face[0]);
        const Vec3 u = (to_vec3(face[1]) - a) / fineness;
        const Vec3 v = (to_vec3(face[2]) - a) / fineness;
        for (std::uint32_t i = 0; i <= fineness; ++i)
        {
            for (std::uint32_t j = 0; i + j <= fineness; ++j)
            {
                visit(Vec3(a + i * u + j * v));
            }
        }
    }
}

} // namespace tactus::test
