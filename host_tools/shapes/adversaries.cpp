// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/detail/grid.hpp"
#include "host_tools/shapes/detail/surfaces.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "transport/base/refusal.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

/// Meshes that are difficult for all later stages: needles, poles, thin walls, separate pieces.
namespace tactus
{

namespace
{

constexpr double kPlateSide_m = 0.1;

using detail::Grid;
using detail::kPi;
using detail::portable_cos;
using detail::portable_sin;

/// Adds both poles and the fans around them, after the grid's vertices.
void add_poles(const Grid& grid, double radius_m, TriangleMesh& mesh)
{
    const auto south = static_cast<std::uint32_t>(mesh.positions.size());
    const std::uint32_t north = south + 1;
    mesh.positions.push_back({0.0, 0.0, -radius_m});
    mesh.positions.push_back({0.0, 0.0, radius_m});
    for (std::uint32_t c = 0; c < grid.columns; ++c)
    {
        mesh.faces.push_back({south, grid.vertex(c + 1, 0), grid.vertex(c, 0)});
        mesh.faces.push_back(
            {north, grid.vertex(c, grid.rows - 1), grid.vertex(c + 1, grid.rows - 1)});
    }
}

/// Border of a square grid of cells + 1 vertices a side, counter-clockwise seen from above.
std::vector<std::uint32_t> border_of(const Grid& grid, std::uint32_t cells)
{
    std::vector<std::uint32_t> border;
    for (std::uint32_t i = 0; i < cells; ++i)
    {
        border.push_back(grid.vertex(i, 0));
    }
    for (std::uint32_t i = 0; i < cells; ++i)
    {
        border.push_back(grid.vertex(cells, i));
    }
    for (std::uint32_t i = cells; i > 0; --i)
    {
        border.push_back(grid.vertex(i, cells));
    }
    for (std::uint32_t i = cells; i > 0; --i)
    {
        border.push_back(grid.vertex(0, i));
    }
    return border;
}

/// splitmix64: a counter with a mixing function, the same on every machine.
class Random
{
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    /// Uniform in [0, 1).
    double next()
    {
        state_ += 0x9E37'79B9'7F4A'7C15U;
        std::uint64_t x = state_;
        x = (x ^ (x >> 30U)) * 0xBF58'476D'1CE4'E5B9U;
        x = (x ^ (x >> 27U)) * 0x94D0'49BB'1331'11EBU;
        return std::ldexp(static_cast<double>((x ^ (x >> 31U)) >> 11U), -53);
    }

private:
    std::uint64_t state_;
};

} // namespace

Result<TriangleMesh, Refusal> make_uv_sphere(std::uint32_t rings, std::uint32_t segments)
{
    constexpr double kRadius_m = 0.05;
    if (rings < 2 || segments < 3 || 2ULL * segments * (std::uint64_t{rings} - 1) > kMaxShapeFaces)
    {
        return Refusal{fmt::format("{} rings x {} segments: must be at least 2 x 3 and make at "
                                   "most {} faces",
                                   rings, segments, kMaxShapeFaces)};
    }
    TriangleMesh mesh;
    const Grid grid{segments, rings - 1, true, false};
    for (std::uint32_t c = 0; c < segments; ++c)
    {
        const double turn = 2.0 * kPi * static_cast<double>(c) / static_cast<double>(segments);
        for (std::uint32_t r = 1; r < rings; ++r)
        {
            const double rise = kPi * static_cast<double>(r) / static_cast<double>(rings);
            const double from_axis = kRadius_m * portable_sin(rise);
            mesh.positions.push_back({from_axis * portable_cos(turn),
                                      from_axis * portable_sin(turn),
                                      -kRadius_m * portable_cos(rise)});
        }
    }
    grid.add_faces(mesh);
    add_poles(grid, kRadius_m, mesh);
    return mesh;
}

Result<TriangleMesh, Refusal> make_thin_plate(std::uint32_t cells, double thickness_m)
{
    if (cells < 1 || cells > 1000 || !(thickness_m >= 1e-6 && thickness_m <= kPlateSide_m))
    {
        return Refusal{fmt::format("{} cells, {} m thick: must be 1 .. 1000 cells and 1e-6 .. "
                                   "{} m",
                                   cells, thickness_m, kPlateSide_m)};
    }
    return detail::make_plate(cells, thickness_m);
}

Result<TriangleMesh, Refusal> make_triangle_soup(std::uint32_t triangles, std::uint64_t seed)
{
    constexpr double kCube_m = 0.1;
    constexpr double kTriangle_m = 0.005;
    if (triangles < 1 || triangles > kMaxShapeFaces)
    {
        return Refusal{fmt::format("triangles is {}; must be 1 .. {}", triangles, kMaxShapeFaces)};
    }
    TriangleMesh mesh;
    Random random(seed);
    for (std::uint32_t t = 0; t < triangles; ++t)
    {
        std::array<double, 3> place{};
        for (double& coordinate : place)
        {
            coordinate = random.next() * (kCube_m - kTriangle_m);
        }
        for (std::uint32_t corner = 0; corner < 3; ++corner)
        {
            auto& p = mesh.positions.emplace_back();
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                p[axis] = place[axis] + random.next() * kTriangle_m;
            }
        }
        mesh.faces.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    return mesh;
}

} // namespace tactus

namespace tactus::detail
{

TriangleMesh make_plate(std::uint32_t cells, double thickness_m)
{
    TriangleMesh mesh;
    const Grid grid{cells + 1, cells + 1, false, false};
    for (const double z : {0.0, thickness_m})
    {
        for (std::uint32_t c = 0; c <= cells; ++c)
        {
            for (std::uint32_t r = 0; r <= cells; ++r)
            {
                mesh.positions.push_back({kPlateSide_m * static_cast<double>(c) / cells,
                                          kPlateSide_m * static_cast<double>(r) / cells, z});
            }
        }
    }
    grid.add_faces(mesh); // The lower side, flipped, and its copy above.
    const std::uint32_t above = grid.columns * grid.rows;
    const std::size_t below_faces = mesh.faces.size();
    for (std::size_t f = 0; f < below_faces; ++f)
    {
        const auto [a, b, c] = mesh.faces[f];
        mesh.faces.push_back({a + above, b + above, c + above});
        mesh.faces[f] = {a, c, b};
    }
    const auto border = border_of(grid, cells);
    for (std::size_t i = 0; i < border.size(); ++i)
    {
        const std::uint32_t a = border[i];
        const std::uint32_t b = border[(i + 1) % border.size()];
        mesh.faces.push_back({a, b, b + above});
        mesh.faces.push_back({a, b + above, a + above});
    }
    return mesh;
}

} // namespace tactus::detail
