// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/brute_force.hpp"

#include <cstdint>
#include <random>
#include <vector>

namespace tactus::test
{

/// Points of a mesh's surface: corners, where a distance to one face is greatest; points by face,
/// so that small faces get their share; and points by area, so that large ones do.
class SurfacePoints
{
public:
    /// Prepares `faces`, at least one, which must outlive this object.
    SurfacePoints(const std::vector<Face>& faces, std::uint64_t seed);

    /// Draws a third each: corners, points of any face, points by area.
    [[nodiscard]] std::vector<Vec3> draw(std::size_t count);
    /// Draws uniformly by area.
    [[nodiscard]] Vec3 draw_by_area();

private:
    [[nodiscard]] Vec3 draw_corner();
    [[nodiscard]] Vec3 draw_by_face();
    [[nodiscard]] Vec3 point_of(std::size_t face);

    const std::vector<Face>& faces_;
    std::vector<double> area_up_to_; ///< Area of the first faces, each included.
    std::mt19937_64 random_;
};

/// Visits a raster over each face with `fineness` + 1 points on a side: its corners, points of its
/// edges and inside. Points of edges are visited once for each of their faces.
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
