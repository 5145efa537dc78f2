// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/readers.hpp"
#include "tests/unit/host_mesh/support.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

/// The oracle is the shoelace formula: triangles with the polygon's orientation whose areas add up
/// to the polygon's cover it once.
namespace tactus::test
{
namespace
{

using Place = std::array<double, 2>;
using Polygon = std::vector<Place>;

double shoelace(const Polygon& polygon)
{
    double twice = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
        const Place& a = polygon[i];
        const Place& b = polygon[(i + 1) % polygon.size()];
        twice += a[0] * b[1] - b[0] * a[1];
    }
    return twice / 2.0;
}

Polygon begun_at(Polygon polygon, std::size_t first)
{
    std::rotate(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(first),
                polygon.end());
    return polygon;
}

/// Points in each kind of plane; the last is perpendicular to no axis.
std::vector<Point> in_space(const Polygon& polygon, std::size_t plane)
{
    std::vector<Point> points;
    for (const auto& [x, y] : polygon)
    {
        const std::array<Point, 4> all{{{x, y, 2.0},
                                        {-3.0, x, y},
                                        {y, 1e3, x},
                                        {0.6 * x - 0.48 * y, 0.8 * x + 0.36 * y, 0.8 * y}}};
        points.push_back(all[plane]);
    }
    return points;
}

/// Fault of a cut of the polygon; empty if there is none.
std::string fault_of(const Polygon& polygon, std::size_t plane)
{
    const auto sut = detail::cut_polygon(in_space(polygon, plane));
    if (!sut)
    {
        return "is not cut";
    }
    if (sut->size() != polygon.size() - 2)
    {
        return "has another number of triangles";
    }
    double covered = 0.0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges; // Edges cancel between triangles.
    for (const auto& [a, b, c] : *sut)
    {
        const double area = shoelace({polygon[a], polygon[b], polygon[c]});
        covered += std::abs(area);
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
        {
            ++edges[{from, to}];
            --edges[{to, from}];
        }
    }
    for (std::uint32_t i = 0; i < polygon.size(); ++i)
    {
        const std::uint32_t next = (i + 1) % static_cast<std::uint32_t>(polygon.size());
        --edges[{i, next}];
        ++edges[{next, i}];
    }
    if (std::ranges::any_of(edges, [](const auto& edge) { return edge.second != 0; }))
    {
        return "has edges of its own";
    }
    const double area = shoelace(polygon);
    return std::abs(covered - area) <= 1e-12 * area
               ? ""
               : "covers " + std::to_string(covered) + " of " + std::to_string(area);
}

Polygon comb(int teeth)
{
    Polygon polygon{{0, 0}, {0.02 * teeth + 0.001, 0}};
    for (int i = teeth; i > 0; --i)
    {
        const double x = 0.02 * i;
        polygon.insert(polygon.end(),
                       {{x + 0.001, 0.1}, {x - 0.004, 0.1}, {x - 0.004, 0.01}, {x - 0.019, 0.01}});
    }
    polygon.insert(polygon.end(), {{0.001, 0.1}, {0, 0.1}});
    return polygon;
}

Polygon star(int spikes)
{
    Polygon polygon;
    for (int k = 0; k < 2 * spikes; ++k)
    {
        const double r = k % 2 == 0 ? 0.02 : 0.003;
        const double angle = 3.14159265358979323846 * k / spikes;
        polygon.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    return polygon;
}

Polygon spiral(int turns)
{
    Polygon polygon;
    for (int k = 0; k <= 8 * turns; ++k)
    {
        const double angle = 3.14159265358979323846 / 4.0 * k;
        polygon.push_back({(1.0 + k) * std::cos(angle), (1.0 + k) * std::sin(angle)});
    }
    for (int k = 8 * turns; k >= 0; --k)
    {
        const double angle = 3.14159265358979323846 / 4.0 * k;
        polygon.push_back({(0.6 + k) * std::cos(angle), (0.6 + k) * std::sin(angle)});
    }
    return polygon;
}

/// Triangle with three additional corners on each side.
Polygon with_straight_corners()
{
    const Polygon corners{{0, 0}, {0.7, 0.1}, {0.3, 0.9}};
    Polygon polygon;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const Place& a = corners[i];
        const Place& b = corners[(i + 1) % 3];
        for (const double part : {0.0, 0.2, 0.5, 0.7})
        {
            polygon.push_back({a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])});
        }
    }
    return polygon;
}

std::vector<std::pair<std::string, Polygon>> simple_polygons()
{
    return {
        {"square", {{0, 0}, {1, 0}, {1, 1}, {0, 1}}},
        {"arrow", {{0, 0}, {2, 1}, {0, 2}, {0.5, 1}}},
        {"l", {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}},
        {"c", {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {3, 2}, {3, 3}, {0, 3}}},
        {"comb", comb(20)},
        {"star", star(12)},
        {"spiral", spiral(5)},
        {"straight_corners", with_straight_corners()},
        {"corners_on_one_side", {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {1, 1}}},
        {"corner_twice", {{0, 0}, {1, 0}, {1, 0}, {1, 1}, {0.5, 0.5}, {0, 1}, {0, 1}, {0, 1}}},
        {"hole_by_a_bridge",
         {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}},
        {"two_holes_by_bridges",
         {{0, 0},
          {9, 0},
          {9, 4},
          {8, 3},
          {8, 1},
          {6, 1},
          {6, 3},
          {8, 3},
          {9, 4},
          {0, 4},
          {1, 3},
          {3, 3},
          {3, 1},
          {1, 1},
          {1, 3},
          {0, 4}}},
        {"spike", {{0, 0}, {2, 0}, {2, 1}, {3, 1}, {2, 1}, {2, 2}, {0, 2}}},
        {"spike_inwards", {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {2, 1}, {2, 2}, {0, 2}}},
        {"corner_on_an_edge", {{0, 0}, {4, 0}, {4, 2}, {2, 0}, {0, 2}}},
        {"two_parts_that_touch", {{0, 0}, {1, 1}, {2, 0}, {2, 2}, {1, 1}, {0, 2}}},
        {"slit", {{0, 0}, {4, 0}, {4, 2}, {1, 1}, {4, 2.0000001}, {4, 4}, {0, 4}}},
        {"notch_of_a_millionth",
         {{0, 0}, {1, 0}, {1, 1}, {0.5, 1}, {0.4999995, 0.999999}, {0.499999, 1}, {0, 1}}},
        {"needle", {{0, 0}, {1, 0}, {1, 1e-6}, {0.5, 5e-7}, {0, 1e-6}}},
    };
}

TEST(CutPolygon, covers_the_polygon_once_in_every_plane_from_every_corner)
{
    for (const auto& [name, polygon] : simple_polygons())
    {
        for (std::size_t first = 0; first < polygon.size(); ++first)
        {
            for (std::size_t plane = 0; plane < 4; ++plane)
            {
                EXPECT_EQ(fault_of(begun_at(polygon, first), plane), "")
                    << name << " from " << first << " in plane " << plane;
            }
        }
    }
}

TEST(CutPolygon, keeps_fans_that_cover)
{
    const auto convex = detail::cut_polygon(in_space({{0, 0}, {2, 0}, {3, 1}, {2, 2}, {0, 2}}, 3));
    EXPECT_EQ(convex, (std::vector<detail::CornerTriangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
    const auto arrow = detail::cut_polygon(in_space({{0.5, 1}, {0, 0}, {2, 1}, {0, 2}}, 0));
    EXPECT_EQ(arrow, (std::vector<detail::CornerTriangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(CutPolygon, puts_corners_of_a_straight_side_into_no_sliver)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> noise(-1e-8, 1e-8);
    for (int trial = 0; trial < 50; ++trial)
    {
        Polygon polygon = with_straight_corners();
        for (Place& place : polygon)
        {
            place = {place[0] + noise(random), place[1] + noise(random)};
        }
        std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
        const auto sut = detail::cut_polygon(in_space(polygon, 0));
        ASSERT_TRUE(sut) << trial;
        for (const auto& [a, b, c] : *sut)
        {
            EXPECT_GT(shoelace({polygon[a], polygon[b], polygon[c]}), 1e-3) << trial;
        }
    }
}

TEST(CutPolygon, cuts_polygons_that_are_not_quite_flat)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<double> height(-0.1, 0.1);
    const Polygon c{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {3, 2}, {3, 3}, {0, 3}};
    for (int trial = 0; trial < 100; ++trial)
    {
        std::vector<Point> corners = in_space(c, 0);
        for (Point& corner : corners)
        {
            corner[2] += height(random);
        }
        const auto sut = detail::cut_polygon(corners);
        ASSERT_TRUE(sut) << trial;
        double covered = 0.0;
        for (const auto& [i, j, k] : *sut)
        {
            covered += std::abs(shoelace({c[i], c[j], c[k]}));
        }
        EXPECT_NEAR(covered, shoelace(c), 1e-12) << trial;
    }
}

TEST(CutPolygon, refuses_what_crosses_itself_or_has_no_area)
{
    for (const Polygon& polygon :
         {Polygon{{0, 0}, {2, 2}, {2, 0}, {0, 1}}, Polygon{{0, 0}, {1, 1}, {1, 0}, {0, 1}},
          Polygon{{0, 0}, {1, 1}, {2, 2}, {3, 3}}, Polygon{{1, 1}, {1, 1}, {1, 1}, {1, 1}},
          Polygon{{0, 3}, {-2, -3}, {3, 1}, {-3, 1}, {2, -3}}})
    {
        EXPECT_FALSE(detail::cut_polygon(in_space(polygon, 0))) << polygon.size();
    }
    const double nan = std::nan("");
    EXPECT_FALSE(detail::cut_polygon(std::vector<Point>(4, {nan, nan, nan})));
    EXPECT_FALSE(
        detail::cut_polygon(std::vector<Point>{{0, 0, 0}, {HUGE_VAL, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
}

/// Corners at random distances around a middle: star-shaped, with deep notches.
TEST(CutPolygon, covers_random_polygons)
{
    for (std::uint32_t seed = 1; seed <= 300; ++seed)
    {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> distance(0.05, 1.0);
        const std::size_t corners = 4 + random() % 60;
        Polygon polygon;
        for (std::size_t i = 0; i < corners; ++i)
        {
            const double angle = 2.0 * 3.14159265358979323846 * static_cast<double>(i) /
                                 static_cast<double>(corners);
            const double r = distance(random);
            polygon.push_back({r * std::cos(angle), r * std::sin(angle)});
        }
        EXPECT_EQ(fault_of(polygon, seed % 4), "") << "seed " << seed;
    }
}

/// C bracket of thickness 1 in every format that has polygons.
TEST(PolygonSink, gives_concave_solids_their_surface_in_every_format)
{
    const Polygon c{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {3, 2}, {3, 3}, {0, 3}};
    for (std::size_t first = 0; first < c.size(); ++first)
    {
        const Polygon outline = begun_at(c, first);
        std::vector<Point> points;
        std::vector<std::vector<std::uint32_t>> polygons(2);
        for (std::uint32_t i = 0; i < 8; ++i)
        {
            points.push_back({outline[i][0], outline[i][1], 0});
            polygons[0].insert(polygons[0].begin(), i);
            polygons[1].push_back(8 + i);
            polygons.push_back({i, (i + 1) % 8, 8 + (i + 1) % 8, 8 + i});
        }
        for (const Place& place : outline)
        {
            points.push_back({place[0], place[1], 1});
        }
        std::string vertices;
        std::string obj_faces;
        std::string faces;
        std::string stl = "solid\n";
        for (const Point& p : points)
        {
            vertices += fmt::format("{} {} {}\n", p[0], p[1], p[2]);
        }
        for (const auto& polygon : polygons)
        {
            obj_faces += "f";
            faces += std::to_string(polygon.size());
            stl += "facet normal 0 0 0\nouter loop\n";
            for (const std::uint32_t v : polygon)
            {
                obj_faces += fmt::format(" {}", v + 1);
                faces += fmt::format(" {}", v);
                stl += fmt::format("vertex {} {} {}\n", points[v][0], points[v][1], points[v][2]);
            }
            obj_faces += "\n";
            faces += "\n";
            stl += "endloop\nendfacet\n";
        }
        std::string obj = obj_faces; // Faces before vertices, which OBJ permits.
        for (const Point& p : points)
        {
            obj += fmt::format("v {} {} {}\n", p[0], p[1], p[2]);
        }
        const std::string face_element =
            "element face 10\nproperty list uchar int vertex_indices\n";
        const std::string vertex_element =
            "element vertex 16\nproperty float x\nproperty float y\nproperty float z\n";
        for (const auto& [name, text] :
             {std::pair("a.obj", obj), std::pair("a.off", "OFF\n16 10 0\n" + vertices + faces),
              std::pair("a.ply", "ply\nformat ascii 1.0\n" + vertex_element + face_element +
                                     "end_header\n" + vertices + faces),
              std::pair("b.ply", "ply\nformat ascii 1.0\n" + face_element + vertex_element +
                                     "end_header\n" + faces + vertices),
              std::pair("a.stl", stl + "endsolid\n")})
        {
            const auto sut = read_bytes(name, text);
            ASSERT_TRUE(sut) << name << ": " << sut.error().text;
            EXPECT_TRUE(sut.value().notes.empty()) << name << ": " << sut.value().notes.front();
            EXPECT_EQ(sut.value().mesh.faces.size(), 28U) << name;
            double area = 0.0;
            for (const Face& f : sut.value().mesh.faces)
            {
                std::array<double, 6> d{};
                for (std::size_t axis = 0; axis < 3; ++axis)
                {
                    const auto& p = sut.value().mesh.positions;
                    d[axis] = p[f[1]][axis] - p[f[0]][axis];
                    d[3 + axis] = p[f[2]][axis] - p[f[0]][axis];
                }
                area += 0.5 * std::hypot(d[1] * d[5] - d[2] * d[4], d[2] * d[3] - d[0] * d[5],
                                         d[0] * d[4] - d[1] * d[3]);
            }
            EXPECT_NEAR(area, 2.0 * 7.0 + 16.0, 1e-12) << name << " from " << first;
            EXPECT_NEAR(signed_volume(sut.value().mesh), 7.0, 1e-12) << name;
        }
    }
}

TEST(PolygonSink, notes_only_what_is_wrong)
{
    const std::string vertices = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 1 0\n";
    const auto notes_of = [&](const std::string& faces)
    {
        const auto sut = read_bytes("a.obj", vertices + faces);
        EXPECT_TRUE(sut) << sut.error().text;
        return sut ? sut.value().notes : std::vector<std::string>{};
    };
    EXPECT_TRUE(notes_of("f 1 2 3 4\nf 1 2 3 4 1\nf 1 1 2 3 3 4\n").empty());
    EXPECT_EQ(notes_of("f 1 3 2 4\n"),
              std::vector<std::string>{
                  "1 polygon crosses itself or has no area; cut into a fan of triangles"});
    EXPECT_EQ(notes_of("f 1 3 2 4\nf 1 2 1 2\n"),
              std::vector<std::string>{
                  "2 polygons cross themselves or have no area; cut into fans of triangles"});
}

} // namespace
} // namespace tactus::test
