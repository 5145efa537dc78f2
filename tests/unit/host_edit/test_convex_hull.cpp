// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Hulls against their definition, and triangles of loops against the loops' edges.

#include "host_tools/edit/exact_shapes.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

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

} // namespace tactus
