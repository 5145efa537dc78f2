// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_simplify/small_meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>
#include <utility>

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

using Point = std::array<double, 3>;

/// Four faces to one; the new vertices on the unit sphere.
void subdivide(std::vector<Point>& points, std::vector<std::array<std::uint32_t, 3>>& faces)
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b)
    {
        const auto [at, is_new] =
            middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
        if (is_new)
        {
            Point p{points[a][0] + points[b][0], points[a][1] + points[b][1],
                    points[a][2] + points[b][2]};
            const double length = std::hypot(p[0], p[1], p[2]);
            points.push_back({p[0] / length, p[1] / length, p[2] / length});
        }
        return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : faces)
    {
        const std::uint32_t ab = middle(a, b);
        const std::uint32_t bc = middle(b, c);
        const std::uint32_t ca = middle(c, a);
        finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    faces = finer;
}

/// Removes all faces of some vertices that are far enough apart for the holes not to touch.
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
    // To 1/4096 of its size: most vertices share a place, many faces lose their area.
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

QuantisedMesh make_icosphere(unsigned levels, double noise)
{
    const double g = (1 + std::sqrt(5.0)) / 2;
    std::vector<Point> points{{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                              {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                              {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    for (auto& p : points)
    {
        const double length = std::hypot(p[0], p[1], p[2]);
        p = {p[0] / length, p[1] / length, p[2] / length};
    }
    std::vector<std::array<std::uint32_t, 3>> faces{
        {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (unsigned level = 0; level < levels; ++level)
    {
        subdivide(points, faces);
    }
    std::mt19937 random(7);
    std::uniform_real_distribution<double> draw(-noise, 0);
    QuantisedMesh mesh;
    mesh.faces = faces;
    for (const auto& p : points)
    {
        const double radius = noise > 0 ? 1 + draw(random) : 1;
        mesh.positions.push_back(on_grid(radius * p[0], radius * p[1], radius * p[2]));
    }
    return mesh;
}

QuantisedMesh make_uv_sphere(unsigned rings, unsigned sectors)
{
    QuantisedMesh mesh;
    mesh.positions = {on_grid(0, 0, 1), on_grid(0, 0, -1)};
    const auto at = [=](unsigned ring, unsigned sector)
    { return 2 + (ring - 1) * sectors + sector % sectors; };
    for (unsigned ring = 1; ring < rings; ++ring)
    {
        const double polar = kPi * ring / rings;
        for (unsigned s = 0; s < sectors; ++s)
        {
            const double around = 2 * kPi * s / sectors;
            mesh.positions.push_back(on_grid(std::sin(polar) * std::cos(around),
                                             std::sin(polar) * std::sin(around), std::cos(polar)));
        }
    }
    for (unsigned s = 0; s < sectors; ++s)
    {
        mesh.faces.push_back({0, at(1, s), at(1, s + 1)});
        mesh.faces.push_back({1, at(rings - 1, s + 1), at(rings - 1, s)});
        for (unsigned ring = 1; ring + 1 < rings; ++ring)
        {
            mesh.faces.push_back({at(ring, s), at(ring + 1, s), at(ring + 1, s + 1)});
            mesh.faces.push_back({at(ring, s), at(ring + 1, s + 1), at(ring, s + 1)});
        }
    }
    return mesh;
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

QuantisedMesh make_torus(unsigned around, unsigned across)
{
    QuantisedMesh mesh;
    for (unsigned i = 0; i < around; ++i)
    {
        for (unsigned j = 0; j < across; ++j)
        {
            const double a = 2 * kPi * i / around;
            const double b = 2 * kPi * j / across;
            const double radius = 0.7 + 0.25 * std::cos(b);
            mesh.positions.push_back(
                on_grid(radius * std::cos(a), radius * std::sin(a), 0.25 * std::sin(b)));
        }
    }
    const auto at = [=](unsigned i, unsigned j) { return i % around * across + j % across; };
    for (unsigned i = 0; i < around; ++i)
    {
        for (unsigned j = 0; j < across; ++j)
        {
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
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
        {"sphere", make_icosphere(3, 0)},
        {"noisy sphere", make_icosphere(3, 0.1)},
        {"torus", make_torus(40, 16)},
        {"hills", make_grid(24, 24, hills)},
        {"plate", make_grid(20, 20, [](double, double) { return 0.0; })},
        {"sphere with holes", cut_holes(make_icosphere(3, 0.02))},
        {"needle sphere", make_uv_sphere(8, 120)},
        {"cone", make_cone(6, 90)},
        {"squeezed sphere", squeeze(make_icosphere(3, 0))},
        {"squeezed hills", squeeze(make_grid(24, 24, hills))},
        {"two components", join(make_icosphere(2, 0.05), make_grid(12, 12, hills), 70'000)},
        {"crumbs", make_crumbs(150, 0)},
        {"crumbs of every kind", make_crumbs(40, 40)},
        {"crumbs round a sphere", join(make_icosphere(2, 0), make_crumbs(20, 20), 0)}};
    return meshes;
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
