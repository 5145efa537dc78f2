// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/collapse_mesh.hpp"
#include "host_tools/simplify/point_triangle.hpp"
#include "host_tools/simplify/triangle_cut.hpp"
#include "host_tools/simplify/vertex_search.hpp"
#include "tests/shared/distance_oracle.hpp"
#include "tests/unit/host_simplify/small_meshes.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

// Refusals of meshes by simplify(), and their wording.
namespace tactus::test
{
namespace
{

void expect_oracle(const std::array<Vec3, 3>& t, const PointColumns& points)
{
    const DistanceTriangle sut(t[0], t[1], t[2]);
    std::vector<double> squared(points.size());
    sut.squared_distances(points, 0, squared.data());
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const auto expected = static_cast<double>(QuadDistanceOracle::distance(points[i], t));
        ASSERT_NEAR(std::sqrt(squared[i]), expected, 2e-7);
    }
}

/// Draws in a fixed order, since that of arguments is the compiler's choice.
Vec3 any_vector(auto& draw, std::mt19937& random)
{
    const double x = draw(random);
    const double y = draw(random);
    const double z = draw(random);
    return {x, y, z};
}

PointColumns random_points(std::mt19937& random, int extent, const std::array<Vec3, 3>& t)
{
    std::uniform_int_distribution<int> draw(0, extent);
    PointColumns points;
    for (int i = 0; i < 8; ++i)
    {
        const Vec3 p = any_vector(draw, random);
        points.push_back(p);
        points.push_back((t[0] + t[1] + t[2]) / 3 + 1e-4 * p);
    }
    return points;
}

} // namespace

TEST(DistanceTriangle, agrees_with_extended_precision_on_random_triangles)
{
    std::mt19937 random(31);
    for (const int extent : {3, 100, 65'535, 16'777'215})
    {
        std::uniform_int_distribution<int> draw(0, extent);
        for (int run = 0; run < 300; ++run)
        {
            std::array<Vec3, 3> t;
            for (auto& corner : t)
            {
                corner = any_vector(draw, random);
            }
            expect_oracle(t, random_points(random, extent, t));
        }
    }
}

TEST(DistanceTriangle, agrees_with_extended_precision_on_needles)
{
    std::mt19937 random(32);
    std::uniform_int_distribution<int> draw(0, 16'777'215);
    std::uniform_int_distribution<int> near(-2, 2);
    for (int run = 0; run < 1000; ++run)
    {
        const Vec3 a = any_vector(draw, random);
        const Vec3 b = any_vector(draw, random);
        const Vec3 nudge = any_vector(near, random);
        const Vec3 middle = 0.5 * (a + b);
        const Vec3 rounded(std::round(middle.x()), std::round(middle.y()), std::round(middle.z()));
        const std::array<Vec3, 3> needle{a, b, a + nudge};
        const std::array<Vec3, 3> cap{a, b, rounded + nudge};
        expect_oracle(needle, random_points(random, 16'777'215, needle));
        expect_oracle(cap, random_points(random, 16'777'215, cap));
    }
}

TEST(DistanceTriangle, every_instruction_set_gives_the_same_bits)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> draw(-1e6, 1e6);
    KernelTriangle triangle{};
    std::vector<double> numbers(sizeof(KernelTriangle) / sizeof(double));
    for (int run = 0; run < 200; ++run)
    {
        std::ranges::generate(numbers, [&] { return draw(random); });
        std::memcpy(&triangle, numbers.data(), sizeof triangle);
        std::array<std::vector<double>, 3> at;
        for (auto& axis : at)
        {
            axis.resize(67); // Not a multiple of any number of lanes.
            std::ranges::generate(axis, [&] { return draw(random); });
        }
        std::vector<double> expected(67);
        kPortableSquaredDistances(triangle, at[0].data(), at[1].data(), at[2].data(), 1, 67,
                                  expected.data());
        for (const SquaredDistances kernel : available_distance_kernels())
        {
            std::vector<double> squared(67);
            kernel(triangle, at[0].data(), at[1].data(), at[2].data(), 1, 67, squared.data());
            ASSERT_EQ(std::memcmp(squared.data(), expected.data(), 67 * sizeof(double)), 0);
        }
    }
}

TEST(DistanceTriangle, without_area_is_its_sides)
{
    const Vec3 a(10, 20, 30);
    const Vec3 b(13, 24, 30);
    PointColumns points;
    points.push_back(Vec3(10, 20, 35));
    points.push_back(Vec3(0, 20, 30));
    std::vector<double> squared(2);
    DistanceTriangle(a, b, a).squared_distances(points, 0, squared.data());
    EXPECT_DOUBLE_EQ(squared[0], 25);
    EXPECT_DOUBLE_EQ(squared[1], 100);
    DistanceTriangle(a, a, a).squared_distances(points, 1, squared.data());
    EXPECT_DOUBLE_EQ(squared[0], 25);
    EXPECT_DOUBLE_EQ(squared[1], 100);
}

namespace
{

const TriangleFrame kFrame{Vec3(100, 200, 300), Vec3(4000, 0, 1000), Vec3(0, 5000, -800)};

Part whole_part(PointColumns& points)
{
    constexpr std::uint32_t kOne = TrianglePoint::kOne;
    const Part part{{{{0, 0}, {kOne, 0}, {0, kOne}}}, {0, 1, 2}, 0};
    points.clear();
    for (const TrianglePoint& at : part.at)
    {
        points.push_back(kFrame.point(at));
    }
    return part;
}

Triangle corners_of(const Part& part)
{
    return {kFrame.point(part.at[0]), kFrame.point(part.at[1]), kFrame.point(part.at[2])};
}

} // namespace

TEST(TriangleCut, parts_cover_the_part_up_to_the_stated_rounding)
{
    std::mt19937 random(41);
    std::uniform_real_distribution<double> draw(-1, 1);
    std::uniform_real_distribution<double> share(0, 1);
    int cuts = 0;
    for (int run = 0; run < 400; ++run)
    {
        PointColumns points;
        std::vector<Part> parts{whole_part(points)};
        for (int plane = 0; plane < 4; ++plane)
        {
            Vec3 start = kFrame.origin + share(random) * kFrame.side_x;
            start += share(random) * kFrame.side_y;
            const CutPlane half{start, Vec3{draw(random), draw(random), draw(random)},
                                Vec3{draw(random), draw(random), draw(random)}};
            std::vector<Part> next;
            for (const Part& part : parts)
            {
                const CutParts made = cut(part, kFrame, half, points);
                cuts += made.empty() ? 0 : 1;
                for (const Part& piece : made)
                {
                    EXPECT_EQ(piece.generation, part.generation + 1);
                    next.push_back(piece);
                }
                if (made.empty())
                {
                    next.push_back(part);
                }
            }
            parts = next;
        }
        for (int sample = 0; sample < 20; ++sample)
        {
            const double s = share(random);
            const Vec3 p =
                kFrame.origin + s * kFrame.side_x + share(random) * (1 - s) * kFrame.side_y;
            long double least = 1e30L;
            for (const Part& part : parts)
            {
                const double gap = part.generation * kFrame.rounding() + 1e-10;
                least = std::min(least, DistanceOracle::distance(p, corners_of(part)) -
                                            static_cast<long double>(gap));
            }
            ASSERT_LE(least, 0);
        }
    }
    EXPECT_GT(cuts, 400);
}

TEST(TriangleCut, appends_the_points_that_its_parts_name)
{
    PointColumns points;
    const Part part = whole_part(points);
    const Vec3 middle = kFrame.origin + kFrame.side_x / 2;
    const CutParts sut = cut(part, kFrame, {middle, kFrame.side_y, kFrame.side_x}, points);
    ASSERT_EQ(sut.size(), 3U);
    ASSERT_EQ(points.size(), 5U);
    for (const Part& piece : sut)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            EXPECT_EQ(points[piece.points[i]], kFrame.point(piece.at[i]));
        }
    }
}

TEST(TriangleCut, through_a_corner_makes_two_parts)
{
    PointColumns points;
    const Part part = whole_part(points);
    const Vec3 across = kFrame.side_x - kFrame.side_y;
    const Vec3 up = kFrame.side_x.cross(kFrame.side_y);
    const Vec3 towards_middle = (kFrame.side_x + kFrame.side_y) / 2;
    const Vec3 normal = towards_middle.cross(up);
    ASSERT_NE(normal.dot(across), 0);
    EXPECT_EQ(cut(part, kFrame, {kFrame.origin, towards_middle, normal}, points).size(), 2U);
}

TEST(TriangleCut, leaves_what_the_half_plane_does_not_cross)
{
    PointColumns points;
    const Part part = whole_part(points);
    const Vec3 middle = kFrame.origin + kFrame.side_x / 2;
    const Vec3 beside = kFrame.origin + 2 * kFrame.side_x;
    EXPECT_TRUE(cut(part, kFrame, {beside, kFrame.side_y, kFrame.side_x}, points).empty());
    // The plane crosses, but its half that would do so is on the other side of its start.
    const Vec3 below = middle - kFrame.side_y;
    EXPECT_TRUE(cut(part, kFrame, {below, -kFrame.side_y, kFrame.side_x}, points).empty());
    EXPECT_EQ(points.size(), 3U);
    EXPECT_FALSE(cut(part, kFrame, {below, kFrame.side_y, kFrame.side_x}, points).empty());
}

namespace
{

/// Five points without faces.
QuantisedMesh five_points()
{
    return {{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}, {9, 9, 9}}, {}};
}

std::string refusal(const QuantisedMesh& mesh)
{
    const auto result = simplify(mesh, {});
    return result.has_value() ? "" : result.error().text;
}

} // namespace

TEST(EdgeMatch, finds_the_face_across_each_edge)
{
    QuantisedMesh mesh = five_points();
    mesh.faces = {{0, 1, 2}, {3, 2, 1}};
    const auto sut = match_edges(mesh);
    constexpr std::uint32_t kNone = Collapse::kNoFace;
    const FaceNeighbours expected{{kNone, 1, kNone}, {kNone, 0, kNone}};
    EXPECT_EQ(sut.value(), expected);
}

TEST(EdgeMatch, refuses_what_is_no_manifold_by_what_is_wrong)
{
    const std::vector<std::pair<decltype(QuantisedMesh::faces), std::string>> cases{
        {{}, "the mesh has 0 faces; allowed are 1 to 536870910"},
        {{{0, 1, 2}, {0, 2, 5}}, "face 1 names vertex 5, but the mesh has 5 vertices"},
        {{{0, 1, 2}, {3, 1, 3}}, "face 1 names a vertex twice; its three corners must differ"},
        {{{0, 1, 2}, {1, 0, 3}, {1, 0, 4}},
         "the edge between vertices 0 and 1 has more than two faces: 0, 1 and 2"},
        {{{0, 1, 2}, {0, 1, 3}},
         "faces 0 and 1 run along the edge between vertices 0 and 1 in the same direction"},
        {{{0, 1, 2}, {0, 3, 4}}, "the faces of vertex 0 form more than one fan"},
        {{{0, 1, 2}, {2, 1, 3}}, "vertex 4 belongs to no face"}};
    QuantisedMesh mesh = five_points();
    for (const auto& [faces, words] : cases)
    {
        mesh.faces = faces;
        EXPECT_EQ(refusal(mesh), words);
    }
    for (const std::int32_t off : {-1, 1 << 24})
    {
        mesh.positions[4][1] = off;
        EXPECT_EQ(refusal(mesh), "vertex 4 is off the grid; coordinates are 0 to 16777215");
    }
    // Two closed meshes that touch in a vertex.
    const QuantisedMesh closed = make_sphere(180, 0);
    QuantisedMesh touching = join(closed, closed, 0);
    const auto first = static_cast<std::uint32_t>(closed.positions.size());
    for (auto& face : touching.faces)
    {
        for (auto& vertex : face)
        {
            vertex = vertex == first ? 0 : (vertex > first ? vertex - 1 : vertex);
        }
    }
    touching.positions.erase(touching.positions.begin() + first);
    EXPECT_EQ(refusal(touching), "the faces of vertex 0 form more than one fan");
}

namespace
{

std::vector<std::uint32_t> first_numbers(std::size_t count)
{
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0U);
    return numbers;
}

TEST(VertexSearch, finds_the_nearest_first)
{
    QuantisedMesh mesh;
    for (std::int32_t i = 0; i < 100; ++i)
    {
        mesh.positions.push_back({i * i, 0, 0});
    }
    const auto vertices = first_numbers(mesh.positions.size());
    const VertexSearch sut(mesh, vertices);
    EXPECT_EQ(sut.place_count(), 100U);
    const auto found = sut.nearest(50);
    ASSERT_EQ(found.size(), 12U);
    EXPECT_EQ(found[0], 50U);
    EXPECT_EQ(found[1], 49U);
    EXPECT_EQ(found[2], 51U);
    EXPECT_EQ(found[11], 44U);
}

TEST(VertexSearch, has_one_place_for_all_vertices_at_one_position)
{
    QuantisedMesh mesh;
    for (std::int32_t i = 0; i < 8'000; ++i)
    {
        mesh.positions.push_back({0, 0, i % 2});
    }
    const auto vertices = first_numbers(mesh.positions.size());
    const VertexSearch sut(mesh, vertices);
    EXPECT_EQ(sut.place_count(), 2U);
    // Each vertex is found by some other one.
    std::set<std::uint32_t> all;
    for (const std::uint32_t vertex : vertices)
    {
        const auto found = sut.nearest(vertex);
        ASSERT_EQ(found.size(), 12U);
        for (std::size_t i = 0; i < found.size(); ++i)
        {
            EXPECT_EQ(found[i] % 2, vertex % 2) << "the other place is farther";
            all.insert(found[i]);
        }
        EXPECT_EQ(found[0], (vertex + 2) % 8'000);
    }
    EXPECT_EQ(all.size(), 8'000U);
}

TEST(VertexSearch, finds_fewer_where_there_are_fewer)
{
    QuantisedMesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 0}, {5, 0, 0}};
    const auto vertices = first_numbers(3);
    const VertexSearch sut(mesh, vertices);
    const auto found = sut.nearest(2);
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(found[0], 2U);
}

} // namespace
} // namespace tactus::test
