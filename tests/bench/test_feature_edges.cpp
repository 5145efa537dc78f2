// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/feature_edges.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::bench
{

namespace
{

/// A unit square of two faces from (0, 0) to (1, 1), and a third face over its side x = 1 that
/// rises by `slope`.
TriangleMesh make_bent_strip(double slope)
{
    return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0.5, slope}},
            {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}}};
}

TEST(FeatureEdges, borders_are_edges_of_one_face)
{
    EXPECT_EQ(border_edges(make_bent_strip(0.0)).size(), 5U);
}

TEST(FeatureEdges, sharp_is_more_than_the_angle)
{
    const TriangleMesh strip = make_bent_strip(1.0); // Turns by 45 degrees at x = 1.

    const std::vector<Segment> sharp = sharp_edges(strip, 44.0);
    ASSERT_EQ(sharp.size(), 1U);
    EXPECT_EQ(sharp[0].from, Vec3(1, 0, 0));
    EXPECT_EQ(sharp[0].to, Vec3(1, 1, 0));
    EXPECT_TRUE(sharp_edges(strip, 46.0).empty());
}

TEST(FeatureEdges, distance_is_taken_along_the_whole_line)
{
    const std::vector<Segment> line{{Vec3(0, 0, 0), Vec3(10, 0, 0)}};
    const std::vector<Segment> bent{{Vec3(0, 1, 0), Vec3(5, 3, 0)},
                                    {Vec3(5, 3, 0), Vec3(10, 1, 0)}};
    const double middle = 2.0 / std::sqrt(29.0) * 5.0 + 1.0 / std::sqrt(29.0) * 5.0;

    EXPECT_NEAR(largest_distance(line, bent, 1'000), middle, 1e-12);
    EXPECT_NEAR(largest_distance(bent, line, 1'000), 3.0, 1e-12);
    EXPECT_NEAR(largest_distance(line, {{Vec3(0, 0, 0), Vec3(4, 0, 0)}}, 1), 6.0, 1e-12);
}

TEST(FeatureEdges, lines_that_are_lost_are_infinitely_far)
{
    const std::vector<Segment> line{{Vec3(0, 0, 0), Vec3(1, 0, 0)}};

    EXPECT_TRUE(std::isinf(largest_distance(line, {}, 10)));
    EXPECT_EQ(largest_distance({}, line, 10), 0.0);
}

} // namespace

} // namespace tactus::bench
