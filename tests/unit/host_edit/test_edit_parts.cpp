// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/edit/exact_shapes.hpp"
#include "host_tools/edit/surface_faces.hpp"
#include "tests/shared/random.hpp"
#include "tests/unit/host_edit/edited_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

/// Hulls against their definition, and triangles of loops against the loops' edges.
/// A wall that grows column by column, as behind a tool, and is merged after each column. It is
/// compared with the wall of all faces ever added.
namespace tactus
{
namespace
{

using test::Random;
using EdgeCounts = std::map<std::pair<std::uint32_t, std::uint32_t>, int>;

void count_edge(EdgeCounts& counts, std::uint32_t from, std::uint32_t to, int sign)
{
    counts[{std::min(from, to), std::max(from, to)}] += from < to ? sign : -sign;
}

CornerLoop circle(std::size_t corners, double radius, double turns, std::uint32_t first)
{
    CornerLoop loop;
    for (std::size_t i = 0; i < corners; ++i)
    {
        const double angle =
            2.0 * std::numbers::pi * turns * static_cast<double>(i) / static_cast<double>(corners);
        loop.push_back({std::lround(radius * std::cos(angle)),
                        std::lround(radius * std::sin(angle)),
                        first + static_cast<std::uint32_t>(i)});
    }
    return loop;
}

/// Twice the area of the triangles, and whether their edges are those of the loops.
std::pair<double, bool> filled(const std::vector<CornerLoop>& loops)
{
    std::map<std::uint32_t, LoopCorner> corners;
    EdgeCounts counts;
    for (const CornerLoop& loop : loops)
    {
        for (std::size_t i = 0; i < loop.size(); ++i)
        {
            corners[loop[i].name] = loop[i];
            count_edge(counts, loop[i].name, loop[(i + 1) % loop.size()].name, -1);
        }
    }
    double area = 0.0;
    for (const auto& [a, b, c] : triangles_of_loops(loops))
    {
        count_edge(counts, a, b, 1);
        count_edge(counts, b, c, 1);
        count_edge(counts, c, a, 1);
        const LoopCorner& p = corners[a];
        const LoopCorner& q = corners[b];
        const LoopCorner& r = corners[c];
        area +=
            std::abs(static_cast<double>((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x)));
    }
    const bool is_sum = std::all_of(counts.begin(), counts.end(),
                                    [](const auto& edge) { return edge.second == 0; });
    return {area, is_sum};
}

} // namespace

TEST(convex_hull, holds_all_points_and_is_closed)
{
    Random random(1);
    for (int round = 0; round < 50; ++round)
    {
        std::vector<Vec3> points;
        for (std::size_t i = 0; i < 5 + random.below(100U); ++i)
        {
            points.push_back(random.in_cube(1'000.0));
        }
        const Polyhedron sut = convex_hull(points, 0.0);
        ASSERT_FALSE(sut.facets.empty());
        EdgeCounts counts;
        for (const auto& facet : sut.facets)
        {
            const Vec3& a = sut.vertices[facet[0]];
            const Vec3 normal =
                (sut.vertices[facet[1]] - a).cross(sut.vertices[facet[2]] - a).normalized();
            for (std::size_t i = 0; i < 3; ++i)
            {
                count_edge(counts, facet[i], facet[(i + 1) % 3], 1);
            }
            for (const Vec3& point : points)
            {
                ASSERT_LE(normal.dot(point - a), 1e-9) << "round " << round;
            }
        }
        for (const auto& [edge, count] : counts)
        {
            ASSERT_EQ(count, 0);
        }
    }
}

TEST(convex_hull, of_flat_points_is_empty)
{
    std::vector<Vec3> points;
    for (int i = 0; i < 20; ++i)
    {
        points.emplace_back(i, i * i, 0.01 * (i % 2));
    }
    EXPECT_TRUE(convex_hull(points, 0.1).facets.empty());
    EXPECT_TRUE(convex_hull(std::vector<Vec3>(3, Vec3(0.0, 0.0, 0.0)), 0.0).facets.empty());
}

TEST(loop_triangles, fill_a_ring_and_an_island_in_it)
{
    CornerLoop hole = circle(17, 700.0, -1.0, 100);
    const auto [area, is_sum] =
        filled({circle(40, 1'000.0, 1.0, 0), hole, circle(9, 300.0, 1.0, 200)});
    EXPECT_TRUE(is_sum);
    const auto polygon = [](double corners, double radius)
    { return corners * radius * radius * std::sin(2.0 * std::numbers::pi / corners); };
    EXPECT_NEAR(area, polygon(40, 1'000.0) - polygon(17, 700.0) + polygon(9, 300.0), 2e4);
}

TEST(loop_triangles, sum_to_the_edges_of_any_loops)
{
    Random random(2);
    for (int round = 0; round < 300; ++round)
    {
        std::vector<CornerLoop> loops(1 + random.below(4U));
        std::uint32_t name = 0;
        for (CornerLoop& loop : loops)
        {
            for (std::size_t i = 0; i < 3 + random.below(20U); ++i)
            {
                loop.push_back({static_cast<std::int64_t>(random.below(12U)),
                                static_cast<std::int64_t>(random.below(12U)), name++});
            }
        }
        ASSERT_TRUE(filled(loops).second) << "round " << round;
    }
}

namespace
{

using test::Random;
using test::Soup;

constexpr int kRows = 8;
constexpr int kColumns = 80;
constexpr int kCell_quanta = 50;
constexpr double kSlack_quanta = 6.0;
/// Marks lie within the slack; points between them may lie a little farther. Without marks, 2.05.
constexpr double kBetweenMarks = 1.25;

using Heights = std::vector<std::vector<std::int32_t>>;

GridPoint wall_point(const Heights& heights, int column, int row)
{
    return {column * kCell_quanta, row * kCell_quanta,
            heights[static_cast<std::size_t>(column)][static_cast<std::size_t>(row)]};
}

Soup soup_of_faces(const std::vector<SurfaceFace>& faces)
{
    Soup soup;
    for (const SurfaceFace& face : faces)
    {
        soup.push_back(
            {to_vec3(face.corners[0]), to_vec3(face.corners[1]), to_vec3(face.corners[2])});
    }
    return soup;
}

/// Edges that no opposite edge cancels.
std::map<std::pair<GridPoint, GridPoint>, int> border_of(const std::vector<SurfaceFace>& faces)
{
    std::map<std::pair<GridPoint, GridPoint>, int> edges;
    for (const SurfaceFace& face : faces)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const GridPoint& from = face.corners[i];
            const GridPoint& to = face.corners[(i + 1) % 3];
            from < to ? ++edges[{from, to}] : --edges[{to, from}];
        }
    }
    std::erase_if(edges, [](const auto& edge) { return edge.second == 0; });
    return edges;
}

/// Largest distance from points of one surface to the other.
double farthest(const Soup& from, const Soup& to, std::size_t stride)
{
    double most = 0.0;
    for (std::size_t face = 0; face < from.size(); face += stride)
    {
        const auto& [a, b, c] = from[face];
        for (const Vec3& point : {a, Vec3((a + b) / 2.0), Vec3((b + c) / 2.0), Vec3((c + a) / 2.0),
                                  Vec3((a + b + c) / 3.0)})
        {
            most = std::max(most, test::distance_to(to, point));
        }
    }
    return most;
}

} // namespace

TEST(merge_pieces, a_wall_that_grows_stays_within_the_slack_of_all_that_was_merged)
{
    Random random(5);
    for (const double radius : {1e9, 2'000.0, 1'000.0})
    {
        SCOPED_TRACE(radius);
        Heights heights;
        for (int column = 0; column <= kColumns; ++column)
        {
            auto& rows = heights.emplace_back();
            const double x = column * kCell_quanta;
            for (int row = 0; row <= kRows; ++row)
            {
                const double y = (row - kRows / 2) * kCell_quanta;
                rows.push_back(static_cast<std::int32_t>(
                    std::lround((x * x + y * y) / (2.0 * radius) + random.between(-1.0, 1.0))));
            }
        }
        std::vector<SurfaceFace> merged;
        std::vector<SurfaceFace> all;
        for (int column = 0; column < kColumns; ++column)
        {
            std::vector<GridPoint> fixed;
            for (int row = 0; row < kRows; ++row)
            {
                const GridPoint a = wall_point(heights, column, row);
                const GridPoint b = wall_point(heights, column + 1, row);
                const GridPoint c = wall_point(heights, column + 1, row + 1);
                const GridPoint d = wall_point(heights, column, row + 1);
                for (const GridTriangle& corners : {GridTriangle{a, b, c}, GridTriangle{a, c, d}})
                {
                    merged.push_back({corners});
                    all.push_back({corners});
                }
            }
            for (const auto& [edge, count] : border_of(all))
            {
                fixed.push_back(edge.first);
                fixed.push_back(edge.second);
            }
            merge_pieces(merged, fixed, kSlack_quanta);
            ASSERT_EQ(border_of(merged), border_of(all)) << "column " << column;
        }
        const Soup before = soup_of_faces(all);
        const Soup after = soup_of_faces(merged);
        const double moved = std::max(farthest(before, after, 1), farthest(after, before, 1));
        std::printf("radius %g: %zu of %zu faces, %.2f quanta\n", radius, merged.size(), all.size(),
                    moved);
        EXPECT_LE(moved, kBetweenMarks * kSlack_quanta);
        EXPECT_LT(merged.size(), all.size() / 3);
        for (const SurfaceFace& face : merged)
        {
            const Vec3 a = to_vec3(face.corners[0]);
            const double up =
                (to_vec3(face.corners[1]) - a).cross(to_vec3(face.corners[2]) - a).z();
            EXPECT_GT(up, 0.0);
            EXPECT_LE(face.marks.size(), kMaxMarks);
        }
    }
}
} // namespace tactus
