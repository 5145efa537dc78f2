// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"

#include "host_tools/shapes/detail/grid.hpp"
#include "host_tools/shapes/detail/surfaces.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace tactus
{

namespace
{

using detail::Grid;
using detail::kPi;
using detail::portable_cos;
using detail::portable_sin;
using Point = std::array<double, 3>;

constexpr std::array<std::pair<std::string_view, Shape>, 8> kNames{
    {{"sphere", Shape::sphere},
     {"bumpy-sphere", Shape::bumpy_sphere},
     {"torus", Shape::torus},
     {"terrain", Shape::terrain},
     {"gear", Shape::gear},
     {"peg", Shape::peg},
     {"socket", Shape::socket},
     {"plate", Shape::plate}}};

double fraction(std::uint32_t part, std::uint32_t whole)
{
    return static_cast<double>(part) / static_cast<double>(whole);
}

/// Number n of parts of an icosahedron edge for which 20 n^2 is nearest to `faces`.
std::uint32_t choose_subdivision(std::uint32_t faces)
{
    std::uint32_t n = 1;
    while (20ULL * (n + 1) * (n + 1) <= faces)
    {
        ++n;
    }
    const std::uint64_t above = 20ULL * (n + 1) * (n + 1) - faces;
    return above < faces - 20ULL * n * n ? n + 1 : n;
}

struct Cells
{
    std::uint32_t columns;
    std::uint32_t rows;
};

/// Range of the columns, as factors on the requested ratio's: the ratio changes by their square.
constexpr double kFewestColumns = 0.7;
constexpr double kMostColumns = 1.4;

/// Grid of columns x rows whose cell count is nearest to `cells`, with at most twice or half the
/// requested ratio. Between equally near counts the columns nearest to the requested ratio are
/// chosen.
Cells choose_cells(std::uint32_t cells, double columns_per_row, Cells least)
{
    const double ideal = std::sqrt(static_cast<double>(cells) * columns_per_row);
    const auto from = std::max(least.columns, static_cast<std::uint32_t>(kFewestColumns * ideal));
    const auto to = std::max(from, static_cast<std::uint32_t>(kMostColumns * ideal));
    const auto cost = [&](const Cells& c)
    {
        const double product = static_cast<double>(c.columns) * static_cast<double>(c.rows);
        return std::pair(std::abs(product - static_cast<double>(cells)),
                         std::abs(static_cast<double>(c.columns) - ideal));
    };
    Cells best{from, least.rows};
    for (std::uint32_t columns = from; columns <= to; ++columns)
    {
        const Cells cut{columns, std::max(least.rows, (cells + columns / 2) / columns)};
        best = cost(cut) < cost(best) ? cut : best;
    }
    return best;
}

TriangleMesh make_sphere(std::uint32_t faces, double (*radius_m)(double, double, double))
{
    TriangleMesh mesh = detail::make_icosphere(choose_subdivision(faces));
    for (Point& p : mesh.positions)
    {
        const double radius = radius_m(p[0], p[1], p[2]);
        p = {p[0] * radius, p[1] * radius, p[2] * radius};
    }
    return mesh;
}

double round_radius_m(double, double, double)
{
    return 0.05;
}

TriangleMesh make_torus(std::uint32_t faces)
{
    constexpr double kRing_m = 0.05;
    constexpr double kTube_m = 0.02;
    const auto [columns, rows] = choose_cells(faces / 2, kRing_m / kTube_m, {3, 3});
    TriangleMesh mesh;
    for (std::uint32_t c = 0; c < columns; ++c)
    {
        const double u = 2.0 * kPi * fraction(c, columns);
        for (std::uint32_t r = 0; r < rows; ++r)
        {
            const double v = 2.0 * kPi * fraction(r, rows);
            const double from_axis = kRing_m + kTube_m * portable_cos(v);
            mesh.positions.push_back({from_axis * portable_cos(u), from_axis * portable_sin(u),
                                      kTube_m * portable_sin(v)});
        }
    }
    Grid{columns, rows, true, true}.add_faces(mesh);
    return mesh;
}

std::uint64_t mix(std::uint64_t x)
{
    x = (x ^ (x >> 30U)) * 0xBF58'476D'1CE4'E5B9U;
    x = (x ^ (x >> 27U)) * 0x94D0'49BB'1331'11EBU;
    return x ^ (x >> 31U);
}

/// Number uniform in [0, 1), from the high 53 bits.
double unit_interval(std::uint64_t bits)
{
    return std::ldexp(static_cast<double>(bits >> 11U), -53);
}

double lattice_value(std::uint64_t octave, double x, double y)
{
    const auto column = static_cast<std::uint64_t>(x);
    const auto row = static_cast<std::uint64_t>(y);
    return unit_interval(mix(mix(mix(octave + 1) + column) + row));
}

/// Lattice of random values, blended with two continuous derivatives.
double smooth_noise(std::uint64_t octave, double x, double y)
{
    const double column = std::floor(x);
    const double row = std::floor(y);
    const auto ease = [](double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); };
    const double s = ease(x - column);
    const double t = ease(y - row);
    const double low = lattice_value(octave, column, row) * (1.0 - s) +
                       lattice_value(octave, column + 1.0, row) * s;
    const double high = lattice_value(octave, column, row + 1.0) * (1.0 - s) +
                        lattice_value(octave, column + 1.0, row + 1.0) * s;
    return low * (1.0 - t) + high * t;
}

/// Sum of four octaves, whose shortest wave is 1/32 of the side for any face count.
double terrain_height_m(double x, double y)
{
    double height = 0.0;
    double amplitude_m = 0.01;
    double waves = 4.0;
    for (std::uint64_t octave = 0; octave < 4; ++octave)
    {
        height += amplitude_m * smooth_noise(octave, x * waves, y * waves);
        amplitude_m *= 0.5;
        waves *= 2.0;
    }
    return height;
}

TriangleMesh make_terrain(std::uint32_t faces)
{
    constexpr double kSide_m = 0.1;
    const auto [columns, rows] = choose_cells(faces / 2, 1.0, {1, 1});
    TriangleMesh mesh;
    for (std::uint32_t c = 0; c <= columns; ++c)
    {
        for (std::uint32_t r = 0; r <= rows; ++r)
        {
            const double x = fraction(c, columns);
            const double y = fraction(r, rows);
            mesh.positions.push_back({kSide_m * x, kSide_m * y, terrain_height_m(x, y)});
        }
    }
    Grid{columns + 1, rows + 1, false, false}.add_faces(mesh);
    return mesh;
}

constexpr std::uint32_t kTeeth = 8;
/// Number of edges of the outline: root, flank, tip and flank of each tooth.
constexpr std::uint32_t kProfileEdges = 4 * kTeeth;

/// Position of a corner of the gear's outline; corners are numbered counter-clockwise.
Point outline_corner(std::uint32_t corner)
{
    // Angles of a tooth's corners, as parts of its pitch.
    static constexpr std::array<double, 4> kPlace{0.0, 0.4, 0.5, 0.9};
    const double radius_m = corner % 4 < 2 ? 0.04 : 0.05;
    const double turn = (static_cast<double>(corner / 4 % kTeeth) + kPlace[corner % 4]) / kTeeth;
    return {radius_m * portable_cos(2.0 * kPi * turn), radius_m * portable_sin(2.0 * kPi * turn),
            0.0};
}

/// Adds the vertices of a section through the gear's rim at `outside`, a point of the outline: up
/// the outer wall, inward over the top, down the bore, back outward below.
void add_gear_column(const Point& outside, std::uint32_t wall, std::uint32_t top,
                     TriangleMesh& mesh)
{
    constexpr double kBore_m = 0.015;
    constexpr double kThickness_m = 0.02;
    const double bore = kBore_m / std::sqrt(outside[0] * outside[0] + outside[1] * outside[1]);
    const auto add = [&](double inward, double up)
    {
        const double scale = 1.0 - inward + inward * bore;
        mesh.positions.push_back({outside[0] * scale, outside[1] * scale, up * kThickness_m});
    };
    for (std::uint32_t i = 0; i < wall; ++i)
    {
        add(0.0, fraction(i, wall));
    }
    for (std::uint32_t i = 0; i < top; ++i)
    {
        add(fraction(i, top), 1.0);
    }
    for (std::uint32_t i = 0; i < wall; ++i)
    {
        add(1.0, 1.0 - fraction(i, wall));
    }
    for (std::uint32_t i = 0; i < top; ++i)
    {
        add(1.0 - fraction(i, top), 0.0);
    }
}

TriangleMesh make_gear(std::uint32_t faces)
{
    // With one piece of each outline edge and one ring on both sides, the gear has 4 faces an edge.
    const std::uint32_t units = (faces + 2 * kProfileEdges) / (4 * kProfileEdges);
    const auto [pieces, rings] = choose_cells(units, 0.3, {1, 2});
    const std::uint32_t wall = std::max(1U, 2 * rings / 5);
    const std::uint32_t top = rings - wall;
    TriangleMesh mesh;
    for (std::uint32_t edge = 0; edge < kProfileEdges; ++edge)
    {
        const Point a = outline_corner(edge);
        const Point b = outline_corner(edge + 1);
        for (std::uint32_t i = 0; i < pieces; ++i)
        {
            const double t = fraction(i, pieces);
            add_gear_column({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), 0.0}, wall, top,
                            mesh);
        }
    }
    Grid{kProfileEdges * pieces, 2 * rings, true, true}.add_faces(mesh);
    return mesh;
}

/// Outlines of solids of revolution, from the axis below to the axis above; in metres.
constexpr std::array<detail::OutlinePoint, 6> kPegOutline{
    {{0.0, -0.03}, {0.009, -0.03}, {0.01, -0.029}, {0.01, 0.029}, {0.009, 0.03}, {0.0, 0.03}}};
constexpr std::array<detail::OutlinePoint, 7> kSocketOutline{{{0.0, -0.03},
                                                              {0.03, -0.03},
                                                              {0.03, 0.02},
                                                              {0.0112, 0.02},
                                                              {0.0102, 0.019},
                                                              {0.0102, -0.02},
                                                              {0.0, -0.02}}};

TriangleMesh make_turned(std::uint32_t faces, std::span<const detail::OutlinePoint> outline)
{
    const auto corners = static_cast<std::uint32_t>(outline.size() - 2);
    const auto [segments, rings] = choose_cells((faces + 1) / 2, 1.0, {8, corners});
    return detail::make_turned(outline, segments, rings);
}

/// Plate of c x c cells a side, with the c for which 4 c (c + 2) is nearest to `faces`.
TriangleMesh make_plate(std::uint32_t faces)
{
    constexpr double kThickness_m = 0.01;
    const auto count = [](std::uint32_t cells) { return 4ULL * cells * (cells + 2ULL); };
    std::uint32_t cells = 1;
    while (count(cells + 1) <= faces)
    {
        ++cells;
    }
    cells += count(cells + 1) - faces < faces - count(cells) ? 1U : 0U;
    return detail::make_plate(cells, kThickness_m);
}

} // namespace

double bumpy_radius_m(double u, double v, double w)
{
    constexpr double kRadius_m = 0.05;
    constexpr double kBump = 0.02;
    constexpr double kWaves = 8.0;
    return kRadius_m * (1.0 + kBump * portable_sin(kWaves * u) * portable_sin(kWaves * v) *
                                  portable_sin(kWaves * w));
}

std::vector<std::string_view> shape_names()
{
    std::vector<std::string_view> names;
    for (const auto& [name, shape] : kNames)
    {
        names.push_back(name);
    }
    return names;
}

std::optional<Shape> parse_shape(std::string_view name)
{
    for (const auto& [known, shape] : kNames)
    {
        if (known == name)
        {
            return shape;
        }
    }
    return std::nullopt;
}

Result<TriangleMesh, Refusal> make_shape(Shape shape, std::uint32_t faces)
{
    if (faces < kMinShapeFaces || faces > kMaxShapeFaces)
    {
        return Refusal{
            fmt::format("faces is {}; must be {} .. {}", faces, kMinShapeFaces, kMaxShapeFaces)};
    }
    switch (shape)
    {
    case Shape::sphere:
        return make_sphere(faces, round_radius_m);
    case Shape::bumpy_sphere:
        return make_sphere(faces, bumpy_radius_m);
    case Shape::torus:
        return make_torus(faces);
    case Shape::terrain:
        return make_terrain(faces);
    case Shape::gear:
        return make_gear(faces);
    case Shape::peg:
        return make_turned(faces, kPegOutline);
    case Shape::socket:
        return make_turned(faces, kSocketOutline);
    case Shape::plate:
        return make_plate(faces);
    }
    return Refusal{"unknown shape"};
}

} // namespace tactus
