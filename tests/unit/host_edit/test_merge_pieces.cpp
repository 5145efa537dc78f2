// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// A wall that grows column by column, as behind a tool, and is merged after each column. It is
/// compared with the wall of all faces ever added.

#include "host_tools/edit/surface_faces.hpp"
#include "tests/shared/random.hpp"
#include "tests/unit/host_edit/edited_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace tactus
{

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
