// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/triangle_cut.hpp"
#include "tests/shared/distance_oracle.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace tactus::test
{

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

} // namespace tactus::test
