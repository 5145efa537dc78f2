// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/worst_shapes.hpp"

#include "host_tools/shapes/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace tactus::test
{

namespace
{

constexpr double kSide_m = 0.1;

struct WorstShape
{
    const char* name;
    std::function<TriangleMesh()> make;
    std::uint32_t base_faces{200}; ///< Base faces; more if pieces cannot vanish.
};

const std::vector<WorstShape>& worst_shapes()
{
    static const std::vector<WorstShape> shapes{
        {"needles", [] { return make_uv_sphere(20, 400).value(); }},
        {"poles-300", [] { return make_uv_sphere(8, 300).value(); }},
        {"poles-4000", [] { return make_uv_sphere(2, 4'000).value(); }},
        {"spikes", [] { return make_spiky_sphere(); }},
        {"thin-plate-1e-4", [] { return make_thin_plate(30, 1.4e-5).value(); }},
        {"close-sheets", [] { return make_close_sheets(24); }},
        {"huge-and-tiny", [] { return make_patch_in_huge_faces(48); }},
        {"border", [] { return make_shape(Shape::terrain, 4'000).value(); }},
        {"broken", [] { return make_broken_sphere(); }},
        {"soup", [] { return make_triangle_soup(700, 5).value(); }, 700},
        {"components", [] { return make_loose_spheres(5); }, 1'500},
    };
    return shapes;
}

/// Adds a square grid of (cells + 1)^2 vertices over [low, low + side]^2 at height z; returns its
/// first vertex. Vertex (column, row) is first + row * (cells + 1) + column.
std::uint32_t add_square(TriangleMesh& mesh, std::uint32_t cells, double low, double side, double z)
{
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const double step = side / static_cast<double>(cells);
    for (std::uint32_t row = 0; row <= cells; ++row)
    {
        for (std::uint32_t column = 0; column <= cells; ++column)
        {
            // The grid is not flat, so that collapses have a cost.
            const double bump = 0.05 * step * ((7 * row + 3 * column) % 4);
            mesh.positions.push_back({low + step * column, low + step * row, z + bump});
        }
    }
    for (std::uint32_t row = 0; row < cells; ++row)
    {
        for (std::uint32_t column = 0; column < cells; ++column)
        {
            const std::uint32_t a = first + row * (cells + 1) + column;
            const std::uint32_t above = a + cells + 1;
            mesh.faces.push_back({a, a + 1, above + 1});
            mesh.faces.push_back({a, above + 1, above});
        }
    }
    return first;
}

/// Octant with 0 or 1 along each axis; values below 0 wrap around.
using Octant = std::array<std::uint32_t, 3>;

bool is_in_notched_cube(const Octant& octant)
{
    return octant != Octant{1, 1, 1} &&
           std::ranges::all_of(octant, [](std::uint32_t i) { return i <= 1; });
}

/// One side of an octant, perpendicular to `axis`, in cells x cells squares with separate corners.
void add_side(TriangleMesh& mesh, std::uint32_t cells, const Octant& octant, std::size_t axis,
              bool is_upper)
{
    const double step = kSide_m / (2.0 * cells);
    const auto add_corner = [&](std::uint32_t column, std::uint32_t row)
    {
        Octant at{};
        at[axis] = (octant[axis] + (is_upper ? 1U : 0U)) * cells;
        at[(axis + 1) % 3] = octant[(axis + 1) % 3] * cells + column;
        at[(axis + 2) % 3] = octant[(axis + 2) % 3] * cells + row;
        mesh.positions.push_back({step * at[0], step * at[1], step * at[2]});
        return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    };
    for (std::uint32_t i = 0; i < cells * cells; ++i)
    {
        const std::uint32_t column = i % cells;
        const std::uint32_t row = i / cells;
        std::array square{add_corner(column, row), add_corner(column + 1, row),
                          add_corner(column + 1, row + 1), add_corner(column, row + 1)};
        if (!is_upper)
        {
            std::ranges::reverse(square);
        }
        mesh.faces.push_back({square[0], square[1], square[2]});
        mesh.faces.push_back({square[0], square[2], square[3]});
    }
}

} // namespace

TriangleMesh make_spiky_sphere()
{
    TriangleMesh mesh = make_shape(Shape::sphere, 2'000).value();
    for (std::size_t i = 0; i < mesh.positions.size(); i += 40)
    {
        for (double& coordinate : mesh.positions[i])
        {
            coordinate *= 3.0;
        }
    }
    return mesh;
}

TriangleMesh make_close_sheets(std::uint32_t cells)
{
    TriangleMesh mesh;
    const double gap = 1e-4 * kSide_m * std::sqrt(2.0);
    for (int sheet = 0; sheet < 3; ++sheet)
    {
        add_square(mesh, cells, 0.0, kSide_m, sheet * gap);
    }
    return mesh;
}

TriangleMesh make_patch_in_huge_faces(std::uint32_t cells)
{
    TriangleMesh mesh;
    constexpr double kPatch_m = 0.001;
    const std::uint32_t first = add_square(mesh, cells, (kSide_m - kPatch_m) / 2.0, kPatch_m, 0.0);
    const auto outer = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(
        mesh.positions.end(),
        {{0.0, 0.0, 0.0}, {kSide_m, 0.0, 0.0}, {kSide_m, kSide_m, 0.0}, {0.0, kSide_m, 0.0}});
    // Side s of the patch runs counter-clockwise from its corner s to corner s + 1.
    const auto border = [&](std::uint32_t side, std::uint32_t i)
    {
        const std::uint32_t column = side == 0 ? i : side == 1 ? cells : side == 2 ? cells - i : 0;
        const std::uint32_t row = side == 0 ? 0 : side == 1 ? i : side == 2 ? cells : cells - i;
        return first + row * (cells + 1) + column;
    };
    for (std::uint32_t side = 0; side < 4; ++side)
    {
        const std::uint32_t corner = outer + side;
        const std::uint32_t next_corner = outer + (side + 1) % 4;
        for (std::uint32_t i = 0; i < cells; ++i)
        {
            mesh.faces.push_back({corner, border(side, i + 1), border(side, i)});
        }
        mesh.faces.push_back({corner, next_corner, border(side, cells)});
    }
    return mesh;
}

TriangleMesh make_broken_sphere()
{
    TriangleMesh mesh = make_shape(Shape::bumpy_sphere, 2'000).value();
    const std::size_t sound = mesh.faces.size();
    for (std::size_t f = 0; f < sound; f += 50)
    {
        const auto [a, b, c] = mesh.faces[f];
        const std::array<double, 3> at = mesh.positions[a];
        const auto tip = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back({1.2 * at[0], 1.2 * at[1], 1.2 * at[2]});
        mesh.faces.push_back({a, b, tip}); // Third face at an edge.
        mesh.faces.push_back({a, b, c});   // Duplicate face.
        mesh.faces.push_back({a, a, b});   // Two equal corners.
        const auto middle = static_cast<std::uint32_t>(mesh.positions.size());
        const std::array<double, 3> to = mesh.positions[tip];
        mesh.positions.push_back(
            {(at[0] + to[0]) / 2.0, (at[1] + to[1]) / 2.0, (at[2] + to[2]) / 2.0});
        mesh.faces.push_back({a, tip, middle}); // Face without an area.
    }
    return mesh;
}

TriangleMesh make_loose_spheres(std::uint32_t per_side)
{
    const TriangleMesh sphere = make_uv_sphere(6, 8).value(); // Diameter 0.1 m.
    TriangleMesh mesh;
    const double scale = 0.6 / static_cast<double>(per_side);
    const double pitch = kSide_m / static_cast<double>(per_side);
    for (std::uint32_t i = 0; i < per_side * per_side * per_side; ++i)
    {
        const std::array<double, 3> at{pitch * (i % per_side), pitch * (i / per_side % per_side),
                                       pitch * (i / per_side / per_side)};
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const std::array<double, 3>& p : sphere.positions)
        {
            mesh.positions.push_back(
                {at[0] + scale * p[0], at[1] + scale * p[1], at[2] + scale * p[2]});
        }
        for (const auto& [a, b, c] : sphere.faces)
        {
            mesh.faces.push_back({first + a, first + b, first + c});
        }
    }
    return mesh;
}

TriangleMesh make_notched_cube(std::uint32_t cells)
{
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 8; ++i)
    {
        const Octant octant{i & 1U, (i >> 1U) & 1U, i >> 2U};
        for (std::size_t axis = 0; axis < 3 && is_in_notched_cube(octant); ++axis)
        {
            for (const bool is_upper : {false, true})
            {
                Octant beside = octant;
                beside[axis] += is_upper ? 1U : ~0U;
                if (!is_in_notched_cube(beside))
                {
                    add_side(mesh, cells, octant, axis, is_upper);
                }
            }
        }
    }
    return mesh;
}

std::size_t worst_model_count()
{
    return worst_shapes().size();
}

const TestModel& worst_model(std::size_t index)
{
    const WorstShape& shape = worst_shapes()[index];
    return test_model(std::string("worst-") + shape.name, shape.make(), shape.base_faces);
}

std::size_t generated_model_count()
{
    return kSmallModels + worst_model_count();
}

const TestModel& generated_model(std::size_t index)
{
    return index < kSmallModels ? small_model(index) : worst_model(index - kSmallModels);
}

} // namespace tactus::test
