// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_simplify/small_meshes.hpp"

#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/test_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <random>
#include <stdexcept>

namespace tactus::test
{
namespace
{

constexpr double kPi = std::numbers::pi;
constexpr double kMiddle = 32'768;
constexpr double kRadius = 30'000;

std::array<std::int32_t, 3> on_grid(double x, double y, double z)
{
    const auto place = [](double value)
    { return static_cast<std::int32_t>(std::lround(kMiddle + kRadius * value)); };
    return {place(x), place(y), place(z)};
}

/// Generated mesh of this radius, on the grid.
QuantisedMesh on_grid(const TriangleMesh& mesh, double radius_m)
{
    QuantisedMesh result;
    result.faces = mesh.faces;
    for (const auto& [x, y, z] : mesh.positions)
    {
        result.positions.push_back(on_grid(x / radius_m, y / radius_m, z / radius_m));
    }
    return result;
}

/// Removes all faces of some vertices that are far enough apart for separate holes.
QuantisedMesh cut_holes(const QuantisedMesh& mesh)
{
    std::vector<char> on_rim(mesh.positions.size(), 0);
    std::vector<char> removed(mesh.positions.size(), 0);
    for (std::uint32_t v = 0; v < mesh.positions.size(); v += 80)
    {
        std::vector<std::uint32_t> ring;
        for (const auto& face : mesh.faces)
        {
            if (std::ranges::find(face, v) != face.end())
            {
                ring.insert(ring.end(), face.begin(), face.end());
            }
        }
        if (std::ranges::none_of(ring, [&](std::uint32_t w) { return on_rim[w] != 0; }))
        {
            removed[v] = 1;
            std::ranges::for_each(ring, [&](std::uint32_t w) { on_rim[w] = 1; });
        }
    }
    QuantisedMesh result;
    std::vector<std::uint32_t> renamed(mesh.positions.size(), 0);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    {
        renamed[v] = static_cast<std::uint32_t>(result.positions.size());
        if (removed[v] == 0)
        {
            result.positions.push_back(mesh.positions[v]);
        }
    }
    for (const auto& [a, b, c] : mesh.faces)
    {
        if (removed[a] == 0 && removed[b] == 0 && removed[c] == 0)
        {
            result.faces.push_back({renamed[a], renamed[b], renamed[c]});
        }
    }
    return result;
}

QuantisedMesh squeeze(QuantisedMesh mesh)
{
    // Shrinks to 1/4096 of its size: most vertices coincide, many faces lose their area.
    for (auto& position : mesh.positions)
    {
        for (auto& value : position)
        {
            value /= 4096;
        }
    }
    return mesh;
}

double hills(double x, double y)
{
    return 0.2 * std::sin(5 * x) * std::cos(4 * y);
}

} // namespace

QuantisedMesh make_sphere(std::uint32_t faces, double noise)
{
    TriangleMesh mesh = make_shape(Shape::sphere, faces).value();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> draw(-noise, 0);
    for (auto& position : mesh.positions)
    {
        const double radius = noise > 0 ? 1 + draw(random) : 1;
        position = {radius * position[0], radius * position[1], radius * position[2]};
    }
    return on_grid(mesh, 0.05);
}

QuantisedMesh make_needle_sphere(std::uint32_t rings, std::uint32_t sectors)
{
    return on_grid(make_uv_sphere(rings, sectors).value(), 0.05);
}

QuantisedMesh make_grid(unsigned columns, unsigned rows,
                        const std::function<double(double, double)>& height)
{
    QuantisedMesh mesh;
    for (unsigned row = 0; row <= rows; ++row)
    {
        for (unsigned column = 0; column <= columns; ++column)
        {
            const double x = 2.0 * column / columns - 1;
            const double y = 2.0 * row / rows - 1;
            mesh.positions.push_back(on_grid(x, y, height(x, y)));
        }
    }
    for (unsigned row = 0; row < rows; ++row)
    {
        for (unsigned column = 0; column < columns; ++column)
        {
            const std::uint32_t a = row * (columns + 1) + column;
            const std::uint32_t b = a + columns + 1;
            mesh.faces.push_back({a, a + 1, b + 1});
            mesh.faces.push_back({b, a, b + 1});
        }
    }
    return mesh;
}

QuantisedMesh make_scan(unsigned columns, unsigned rows,
                        const std::function<double(double, double)>& height)
{
    QuantisedMesh mesh = make_grid(columns, rows, height);
    std::vector<std::array<std::uint32_t, 3>> kept;
    for (unsigned f = 0; f < mesh.faces.size(); ++f)
    {
        const unsigned row = f / 2 / columns;
        const unsigned column = f / 2 % columns;
        if (row % 3 != 1 || column % 3 != 1 || f % 2 != (row / 3 + column / 3) % 2)
        {
            kept.push_back(mesh.faces[f]);
        }
    }
    mesh.faces = std::move(kept);
    return mesh;
}

QuantisedMesh make_perforated(unsigned holes)
{
    const unsigned size = 2 * holes + 1;
    const auto is_solid = [=](unsigned x, unsigned y)
    { return x < size && y < size && (x % 2 == 0 || y % 2 == 0); };
    QuantisedMesh mesh;
    const double across = 2.0 / size;
    const auto at = [=](unsigned x, unsigned y, unsigned z)
    { return (y * (size + 1) + x) * 2 + z; };
    for (unsigned y = 0; y <= size; ++y)
    {
        for (unsigned x = 0; x <= size; ++x)
        {
            mesh.positions.push_back(on_grid(across * x - 1, across * y - 1, 0));
            mesh.positions.push_back(on_grid(across * x - 1, across * y - 1, 0.7 * across));
        }
    }
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d)
    {
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({a, c, d});
    };
    for (unsigned y = 0; y < size; ++y)
    {
        for (unsigned x = 0; x < size; ++x)
        {
            if (!is_solid(x, y))
            {
                continue;
            }
            add(at(x, y, 1), at(x + 1, y, 1), at(x + 1, y + 1, 1), at(x, y + 1, 1));
            add(at(x, y, 0), at(x, y + 1, 0), at(x + 1, y + 1, 0), at(x + 1, y, 0));
            if (!is_solid(x, y - 1)) // Numbers below the first row wrap around.
            {
                add(at(x, y, 0), at(x + 1, y, 0), at(x + 1, y, 1), at(x, y, 1));
            }
            if (!is_solid(x + 1, y))
            {
                add(at(x + 1, y, 0), at(x + 1, y + 1, 0), at(x + 1, y + 1, 1), at(x + 1, y, 1));
            }
            if (!is_solid(x, y + 1))
            {
                add(at(x + 1, y + 1, 0), at(x, y + 1, 0), at(x, y + 1, 1), at(x + 1, y + 1, 1));
            }
            if (!is_solid(x - 1, y))
            {
                add(at(x, y + 1, 0), at(x, y, 0), at(x, y, 1), at(x, y + 1, 1));
            }
        }
    }
    return mesh;
}

QuantisedMesh make_torus(std::uint32_t faces)
{
    return on_grid(make_shape(Shape::torus, faces).value(), 0.075);
}

QuantisedMesh make_cone(unsigned rings, unsigned sectors)
{
    QuantisedMesh mesh;
    mesh.positions = {on_grid(0, 0, 1)};
    const auto at = [=](unsigned ring, unsigned sector)
    { return 1 + (ring - 1) * sectors + sector % sectors; };
    for (unsigned ring = 1; ring <= rings; ++ring)
    {
        const double share = static_cast<double>(ring) / rings;
        for (unsigned s = 0; s < sectors; ++s)
        {
            const double around = 2 * kPi * s / sectors;
            mesh.positions.push_back(
                on_grid(share * std::cos(around), share * std::sin(around), 1 - share));
        }
    }
    for (unsigned s = 0; s < sectors; ++s)
    {
        mesh.faces.push_back({0, at(1, s), at(1, s + 1)});
        for (unsigned ring = 1; ring < rings; ++ring)
        {
            mesh.faces.push_back({at(ring, s), at(ring + 1, s), at(ring + 1, s + 1)});
            mesh.faces.push_back({at(ring, s), at(ring + 1, s + 1), at(ring, s + 1)});
        }
    }
    return mesh;
}

QuantisedMesh join(const QuantisedMesh& a, const QuantisedMesh& b, std::int32_t shift)
{
    QuantisedMesh mesh = a;
    const auto first = static_cast<std::uint32_t>(a.positions.size());
    for (const auto& p : b.positions)
    {
        mesh.positions.push_back({p[0] + shift, p[1], p[2]});
    }
    for (const auto& f : b.faces)
    {
        mesh.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
    }
    return mesh;
}

QuantisedMesh make_crumbs(std::uint32_t triangles, std::uint32_t solids)
{
    std::mt19937 random(3);
    std::uniform_int_distribution<std::int32_t> anywhere(0, 60'000);
    std::uniform_int_distribution<std::int32_t> nearby(0, 900);
    QuantisedMesh mesh;
    const auto add = [&](std::uint32_t vertices, std::initializer_list<std::array<int, 3>> faces)
    {
        const auto first = static_cast<int>(mesh.positions.size());
        const std::array<std::int32_t, 3> at{anywhere(random), anywhere(random), anywhere(random)};
        for (std::uint32_t i = 0; i < vertices; ++i)
        {
            mesh.positions.push_back(
                {at[0] + nearby(random), at[1] + nearby(random), at[2] + nearby(random)});
        }
        for (const auto& [a, b, c] : faces)
        {
            mesh.faces.push_back({static_cast<std::uint32_t>(first + a),
                                  static_cast<std::uint32_t>(first + b),
                                  static_cast<std::uint32_t>(first + c)});
        }
    };
    for (std::uint32_t i = 0; i < triangles; ++i)
    {
        add(3, {{0, 1, 2}});
    }
    for (std::uint32_t i = 0; i < solids; ++i)
    {
        add(4, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}});
        add(3, {{0, 1, 2}, {0, 2, 1}});
    }
    return mesh;
}

const std::vector<NamedMesh>& all_small_meshes()
{
    static const std::vector<NamedMesh> meshes{
        {"sphere", make_sphere(1'280, 0)},
        {"noisy sphere", make_sphere(1'280, 0.1)},
        {"torus", make_torus(1'280)},
        {"hills", make_grid(24, 24, hills)},
        {"plate", make_grid(20, 20, [](double, double) { return 0.0; })},
        {"sphere with holes", cut_holes(make_sphere(1'280, 0.02))},
        {"scan with pinholes", make_scan(24, 24, hills)},
        {"needle sphere", make_needle_sphere(8, 120)},
        {"cone", make_cone(6, 90)},
        {"squeezed sphere", squeeze(make_sphere(1'280, 0))},
        {"squeezed hills", squeeze(make_grid(24, 24, hills))},
        {"two components", join(make_sphere(320, 0.05), make_grid(12, 12, hills), 70'000)},
        {"crumbs", make_crumbs(150, 0)},
        {"crumbs of every kind", make_crumbs(40, 40)},
        {"crumbs round a sphere", join(make_sphere(320, 0), make_crumbs(20, 20), 0)}};
    return meshes;
}

std::vector<Face> faces_of(const QuantisedMesh& mesh,
                           std::span<const std::array<std::uint32_t, 3>> faces)
{
    PreparedMesh part;
    part.mesh.positions = mesh.positions;
    part.mesh.faces.assign(faces.begin(), faces.end());
    part.quantum_m = 1.0;
    return faces_on_grid(part);
}

Simplification simplified(const QuantisedMesh& mesh, std::uint32_t base_faces, unsigned threads)
{
    SimplifyOptions options;
    options.base_faces = base_faces;
    options.threads = threads;
    auto result = simplify(mesh, options);
    if (!result)
    {
        throw std::runtime_error(result.error().text);
    }
    return std::move(result).value();
}

} // namespace tactus::test
