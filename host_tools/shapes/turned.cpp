// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/detail/grid.hpp"
#include "host_tools/shapes/detail/surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tactus::detail
{

namespace
{

double length_of(const OutlinePoint& a, const OutlinePoint& b)
{
    const double out = b.from_axis_m - a.from_axis_m;
    const double up = b.z_m - a.z_m;
    return std::sqrt(out * out + up * up);
}

/// Corners of the outline after cutting it into `pieces` pieces. Each cut goes to the edge with the
/// longest pieces, which stay equal.
std::vector<OutlinePoint> cut(std::span<const OutlinePoint> outline, std::uint32_t pieces)
{
    const std::size_t edges = outline.size() - 1;
    std::vector<std::uint32_t> cuts(edges, 1);
    for (std::size_t made = edges; made < pieces; ++made)
    {
        std::size_t longest = 0;
        double most_m = 0.0;
        for (std::size_t i = 0; i < edges; ++i)
        {
            const double piece_m = length_of(outline[i], outline[i + 1]) / cuts[i];
            longest = piece_m > most_m ? i : longest;
            most_m = std::max(most_m, piece_m);
        }
        ++cuts[longest];
    }
    std::vector<OutlinePoint> points;
    for (std::size_t i = 0; i < edges; ++i)
    {
        const OutlinePoint& from = outline[i];
        const OutlinePoint& to = outline[i + 1];
        for (std::uint32_t k = 0; k < cuts[i]; ++k)
        {
            const double t = static_cast<double>(k) / cuts[i];
            points.push_back({from.from_axis_m + t * (to.from_axis_m - from.from_axis_m),
                              from.z_m + t * (to.z_m - from.z_m)});
        }
    }
    points.push_back(outline.back());
    return points;
}

} // namespace

TriangleMesh make_turned(std::span<const OutlinePoint> outline, std::uint32_t segments,
                         std::uint32_t rings)
{
    const std::vector<OutlinePoint> points = cut(outline, rings + 1);
    TriangleMesh mesh;
    const Grid grid{segments, rings, true, false};
    for (std::uint32_t c = 0; c < segments; ++c)
    {
        const double turn = 2.0 * kPi * static_cast<double>(c) / static_cast<double>(segments);
        for (std::uint32_t r = 1; r <= rings; ++r)
        {
            const OutlinePoint& point = points[r];
            mesh.positions.push_back({point.from_axis_m * portable_cos(turn),
                                      point.from_axis_m * portable_sin(turn), point.z_m});
        }
    }
    grid.add_faces(mesh);
    const auto below = static_cast<std::uint32_t>(mesh.positions.size());
    const std::uint32_t above = below + 1;
    mesh.positions.push_back({0.0, 0.0, points.front().z_m});
    mesh.positions.push_back({0.0, 0.0, points.back().z_m});
    for (std::uint32_t c = 0; c < segments; ++c)
    {
        mesh.faces.push_back({below, grid.vertex(c + 1, 0), grid.vertex(c, 0)});
        mesh.faces.push_back({above, grid.vertex(c, rings - 1), grid.vertex(c + 1, rings - 1)});
    }
    return mesh;
}

} // namespace tactus::detail
