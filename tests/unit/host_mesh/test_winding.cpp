// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"
#include "tests/unit/host_mesh/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

/// Orientation of closed pieces in a model. The oracle is the winding number of points far from
/// every surface, by solid angles.
namespace tactus::test
{
namespace
{

/// Box of eight vertices, counter-clockwise from outside, or from inside.
TriangleMesh box(const Point& low, const Point& high, bool is_turned = false)
{
    TriangleMesh mesh;
    for (std::size_t v = 0; v < 8; ++v)
    {
        mesh.positions.push_back({v % 2 == 0 ? low[0] : high[0], v / 2 % 2 == 0 ? low[1] : high[1],
                                  v / 4 == 0 ? low[2] : high[2]});
    }
    mesh.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                  {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    for (Face& face : mesh.faces)
    {
        is_turned ? std::swap(face[1], face[2]) : void();
    }
    return mesh;
}

TriangleMesh cube(double half, const Point& middle, bool is_turned = false)
{
    return box({middle[0] - half, middle[1] - half, middle[2] - half},
               {middle[0] + half, middle[1] + half, middle[2] + half}, is_turned);
}

/// U of 6 by 6 by 4 cm with a wall of 2 cm, open towards +y: a ray along x from between its arms
/// crosses one of them.
TriangleMesh bounded()
{
    constexpr std::array<std::array<double, 2>, 8> kOutline{
        {{0, 0}, {6, 0}, {6, 6}, {4, 6}, {4, 2}, {2, 2}, {2, 6}, {0, 6}}};
    constexpr std::array<Face, 6> kCap{
        {{7, 0, 5}, {7, 5, 6}, {0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}}};
    TriangleMesh mesh;
    for (const double z : {-0.02, 0.02})
    {
        for (const auto& [x, y] : kOutline)
        {
            mesh.positions.push_back({0.01 * x, 0.01 * y, z});
        }
    }
    for (const auto& [a, b, c] : kCap)
    {
        mesh.faces.push_back({a, c, b});
        mesh.faces.push_back({a + 8, b + 8, c + 8});
    }
    for (std::uint32_t i = 0; i < 8; ++i)
    {
        const std::uint32_t next = (i + 1) % 8;
        mesh.faces.push_back({i, next, next + 8});
        mesh.faces.push_back({i, next + 8, i + 8});
    }
    return mesh;
}

TriangleMesh turned(TriangleMesh mesh)
{
    for (Face& face : mesh.faces)
    {
        std::swap(face[1], face[2]);
    }
    return mesh;
}

/// Model content in metres.
TriangleMesh mesh_of(const PreparedMesh& prepared)
{
    TriangleMesh mesh;
    for (const auto& p : prepared.mesh.positions)
    {
        Point& place = mesh.positions.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            place[axis] = prepared.origin_m[axis] + prepared.quantum_m * p[axis];
        }
    }
    mesh.faces = prepared.mesh.faces;
    return mesh;
}

/// Winding number of the surface about the point: the sum of solid angles over 4 pi.
int winding_number(const TriangleMesh& mesh, const Point& p)
{
    const auto dot = [](const Point& a, const Point& b)
    { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    double angle = 0.0;
    for (const Face& face : mesh.faces)
    {
        std::array<Point, 3> r{};
        std::array<double, 3> length{};
        for (std::size_t k = 0; k < 3; ++k)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                r[k][axis] = mesh.positions[face[k]][axis] - p[axis];
            }
            length[k] = std::sqrt(dot(r[k], r[k]));
        }
        const Point cross{r[1][1] * r[2][2] - r[1][2] * r[2][1],
                          r[1][2] * r[2][0] - r[1][0] * r[2][2],
                          r[1][0] * r[2][1] - r[1][1] * r[2][0]};
        angle += 2.0 * std::atan2(dot(r[0], cross),
                                  length[0] * length[1] * length[2] + dot(r[0], r[1]) * length[2] +
                                      dot(r[1], r[2]) * length[0] + dot(r[2], r[0]) * length[1]);
    }
    return static_cast<int>(std::lround(angle / (4.0 * 3.14159265358979323846)));
}

struct Expected
{
    Point place;
    int winding;
};

struct WindingCase
{
    std::string name;
    TriangleMesh mesh;
    std::size_t outward;
    std::size_t inward;
    std::vector<Expected> places;
};

const Point kFar{0.3, 0.001, 0.002};
const Point kMiddle{0.001, 0.002, 0.003};
const Point kWall{0.03, 0.001, 0.002};

std::vector<WindingCase> winding_cases()
{
    const TriangleMesh whole = cube(0.05, {0, 0, 0});
    const TriangleMesh core = cube(0.02, {0, 0, 0});
    const TriangleMesh seed = cube(0.01, {0, 0, 0});
    const TriangleMesh beside = cube(0.05, {0.5, 0, 0});
    const Point in_beside{0.501, 0.002, 0.003};
    const TriangleMesh across = box({0, -0.03, -0.03}, {0.12, 0.03, 0.03});
    const Point in_both{0.02, 0.001, 0.002};
    TriangleMesh open = whole;
    open.faces.pop_back();
    return {
        {"a_body", whole, 0, 0, {{kFar, 0}, {kMiddle, 1}}},
        {"a_turned_body", turned(whole), 1, 0, {{kFar, 0}, {kMiddle, 1}}},
        {"one_of_two", joined({whole, turned(beside)}), 1, 0, {{kMiddle, 1}, {in_beside, 1}}},
        {"a_void", joined({whole, turned(core)}), 0, 0, {{kWall, 1}, {kMiddle, 0}}},
        {"a_void_first", joined({turned(core), whole}), 0, 0, {{kWall, 1}, {kMiddle, 0}}},
        {"nested_bodies", joined({whole, core}), 0, 1, {{kWall, 1}, {kMiddle, 0}}},
        {"all_turned_with_a_void", joined({turned(whole), core}), 1, 1, {{kWall, 1}, {kMiddle, 0}}},
        {"nested_and_turned",
         joined({turned(whole), turned(core)}),
         1,
         0,
         {{kWall, 1}, {kMiddle, 0}}},
        {"a_body_in_a_void", joined({whole, turned(core), seed}), 0, 0, {{kWall, 1}, {kMiddle, 1}}},
        {"a_turned_body_in_a_void",
         joined({turned(seed), whole, turned(core)}),
         1,
         0,
         {{kWall, 1}, {kMiddle, 1}}},
        {"bodies_that_cross", joined({whole, across}), 0, 0, {{in_both, 2}, {kFar, 0}}},
        {"turned_bodies_that_cross",
         joined({turned(whole), turned(across)}),
         2,
         0,
         {{in_both, 2}, {kFar, 0}}},
        {"a_body_twice", joined({whole, whole}), 0, 0, {{kMiddle, 1}}},
        {"a_body_between_the_arms_of_another",
         joined({bounded(), turned(cube(0.005, {0.03, 0.04, 0.001}))}),
         1,
         0,
         {{{0.0301, 0.0402, 0.0003}, 1}, {{0.01, 0.03, 0.001}, 1}, {{0.022, 0.05, 0.001}, 0}}},
        {"a_void_in_an_arm",
         joined({bounded(), cube(0.005, {0.01, 0.04, 0.001})}),
         0,
         1,
         {{{0.0101, 0.0402, 0.0003}, 0}, {{0.05, 0.03, 0.001}, 1}}},
        {"an_open_piece", turned(open), 0, 0, {}},
        {"a_void_of_an_open_piece", joined({open, turned(core)}), 0, 0, {}},
        {"bodies_that_share_an_edge",
         joined({turned(box({0, 0, 0}, {1, 1, 1})), turned(box({1, 1, 0}, {2, 2, 1}))}),
         2,
         0,
         {{{0.5, 0.5, 0.5}, 1}, {{1.5, 1.5, 0.5}, 1}, {{1.5, 0.5, 0.5}, 0}}},
    };
}

TEST(TurnClosedPieces, gives_every_closed_piece_the_side_that_is_meant)
{
    for (const WindingCase& one : winding_cases())
    {
        const auto sut = prepare_mesh(one.mesh, {});
        ASSERT_TRUE(sut) << one.name << ": " << sut.error().text;
        EXPECT_EQ(sut.value().turned_pieces, one.outward) << one.name;
        EXPECT_EQ(sut.value().turned_voids, one.inward) << one.name;
        EXPECT_TRUE(is_manifold_with_borders(sut.value().mesh)) << one.name;
        for (const Expected& expected : one.places)
        {
            EXPECT_EQ(winding_number(mesh_of(sut.value()), expected.place), expected.winding)
                << one.name << " at x " << expected.place[0];
        }
    }
}

TEST(TurnClosedPieces, leaves_all_as_it_is_when_asked_to_and_is_done_after_once)
{
    for (const WindingCase& one : winding_cases())
    {
        const auto kept = prepare_mesh(one.mesh, {.keeps_winding = true});
        ASSERT_TRUE(kept);
        EXPECT_EQ(kept.value().turned_pieces + kept.value().turned_voids, 0U) << one.name;
        EXPECT_EQ(winding_number(mesh_of(kept.value()), {0.9, 0.3, 0.7}),
                  winding_number(one.mesh, {0.9, 0.3, 0.7}))
            << one.name;
        const auto first = prepare_mesh(one.mesh, {});
        const auto second = prepare_mesh(mesh_of(first.value()), {});
        ASSERT_TRUE(second);
        EXPECT_EQ(second.value().turned_pieces + second.value().turned_voids, 0U) << one.name;
    }
}

TEST(TurnClosedPieces, says_what_it_turned)
{
    const auto one = prepare_mesh(turned(cube(1, {0, 0, 0})), {});
    ASSERT_TRUE(one);
    EXPECT_EQ(one.value().notes,
              std::vector<std::string>{
                  "1 closed piece turned from inwards to outwards; --keep-winding prevents this"});
}

TEST(TurnClosedPieces, knows_thin_tiny_and_distant_bodies)
{
    for (const double thickness : {1e-1, 1e-6, 1e-9})
    {
        for (const double at : {0.0, 1e6})
        {
            const TriangleMesh plate =
                turned(box({at, at, at}, {at + 1, at + 1, at + std::max(thickness, at * 1e-14)}));
            const auto sut = prepare_mesh(plate, {});
            ASSERT_TRUE(sut) << sut.error().text;
            EXPECT_EQ(sut.value().turned_pieces, 1U) << thickness << " at " << at;
        }
    }
    for (const double size : {1e-200, 1e200})
    {
        const auto sut = prepare_mesh(turned(cube(size, {0, 0, 0})), {.fit_diagonal_m = 1.0});
        ASSERT_TRUE(sut) << sut.error().text;
        EXPECT_EQ(sut.value().turned_pieces, 1U) << size;
    }
}

/// Spheres in spheres and beside each other, with any orientation: a point's side depends on the
/// number of spheres around it, not on their orientation.
TEST(TurnClosedPieces, sorts_out_bubbles_in_bubbles)
{
    const auto sphere = make_shape(Shape::sphere, 200);
    ASSERT_TRUE(sphere);
    double radius = 0.0;
    for (const Point& p : sphere.value().positions)
    {
        radius = std::max(radius, std::hypot(p[0], p[1], p[2]));
    }
    for (std::uint32_t seed = 1; seed <= 20; ++seed)
    {
        std::mt19937 random(seed);
        TriangleMesh all;
        std::vector<std::pair<Point, int>> places;
        for (int tower = 0; tower < 5; ++tower)
        {
            const Point middle{3.0 * tower, 0.37 * tower, -0.61 * tower};
            const int depth = 1 + static_cast<int>(random() % 4);
            for (int level = 0; level < depth; ++level)
            {
                TriangleMesh bubble = sphere.value();
                for (Point& p : bubble.positions)
                {
                    for (std::size_t axis = 0; axis < 3; ++axis)
                    {
                        p[axis] = middle[axis] + p[axis] / radius * std::pow(0.7, level);
                    }
                }
                all = joined({all, random() % 2 == 0 ? turned(bubble) : bubble});
            }
            places.emplace_back(middle, depth % 2);
        }
        const auto sut = prepare_mesh(all, {});
        ASSERT_TRUE(sut) << sut.error().text;
        for (const auto& [place, winding] : places)
        {
            EXPECT_EQ(winding_number(mesh_of(sut.value()), place), winding) << "seed " << seed;
        }
    }
}

} // namespace
} // namespace tactus::test
