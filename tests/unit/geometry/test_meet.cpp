// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/box_triangle.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/geometry/crossing.hpp"
#include "tests/shared/shape_scenes.hpp"
#include "tests/unit/geometry/grid.hpp"
#include "tests/unit/geometry/integer_oracle.hpp"
#include "tests/unit/geometry/same_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <utility>

namespace tactus::test
{

namespace
{

/// First piercing by find_piercing() of one edge after the other.
std::optional<EdgePiercing> first_piercing(const Triangle& first, const Triangle& second)
{
    for (const auto& [own, other] : {std::pair(&first, &second), {&second, &first}})
    {
        for (std::size_t edge = 0; edge < 3; ++edge)
        {
            const Segment segment{(*own)[edge], (*own)[(edge + 1) % 3]};
            if (const auto piercing = find_piercing(segment, *other))
            {
                return EdgePiercing{own, edge, *piercing};
            }
        }
    }
    return std::nullopt;
}

} // namespace

TEST(Meet, of_triangles_is_what_exact_linear_algebra_says)
{
    Random random(50);
    Tally tally;
    for (int i = 0; i < kClasses * cases_per_class() / 4; ++i)
    {
        Grid grid(random);
        const GridTriangle a = grid.triangle();
        const GridTriangle b = grid.triangle();
        const bool expected = share_a_point({a[0], a[1], a[2]}, b);
        tally.add(expected);
        ASSERT_EQ(meet(grid.placed(a), grid.placed(b)), expected) << "case " << i;
        ASSERT_EQ(meet(grid.placed(b), grid.placed(a)), expected) << "case " << i;
    }
    tally.expect_both();
}

TEST(Meet, of_a_segment_and_a_triangle_is_what_exact_linear_algebra_says)
{
    Random random(51);
    Tally tally;
    for (int i = 0; i < kClasses * cases_per_class() / 2; ++i)
    {
        Grid grid(random);
        const GridPoint from = grid.point();
        const GridPoint to = grid.point();
        const GridTriangle triangle = grid.triangle();
        const bool expected = share_a_point({from, to}, triangle);
        tally.add(expected);
        const Segment segment{grid.placed(from), grid.placed(to)};
        ASSERT_EQ(meet(segment, grid.placed(triangle)), expected) << "case " << i;
        const auto piercing = find_piercing(segment, grid.placed(triangle));
        ASSERT_TRUE(expected || !piercing) << "case " << i;
    }
    tally.expect_both();
}

TEST(Meet, the_first_edge_that_pierces_is_found_and_nothing_changes_where_meeting_is_known)
{
    Random random(53);
    int pierced = 0;
    int touching = 0;
    for (int i = 0; i < kClasses * cases_per_class() / 8; ++i)
    {
        Grid grid(random);
        const Triangle a = grid.placed(grid.triangle());
        const Triangle b = grid.placed(grid.triangle());
        const auto truth = first_piercing(a, b);
        const auto found = find_edge_piercing(a, b);
        ASSERT_EQ(found.has_value(), truth.has_value()) << "case " << i;
        if (found)
        {
            ASSERT_EQ(found->triangle, truth->triangle) << "case " << i;
            ASSERT_EQ(found->edge, truth->edge) << "case " << i;
            ASSERT_EQ(found->piercing.parameter, truth->piercing.parameter) << "case " << i;
            ASSERT_EQ(found->piercing.feature, truth->piercing.feature) << "case " << i;
        }
        const bool do_meet = meet(a, b);
        expect_same(closest_points(a, b, do_meet), closest_points(a, b));
        pierced += found ? 1 : 0;
        touching += do_meet && !found ? 1 : 0;
    }
    EXPECT_GT(pierced, 1'000);
    EXPECT_GT(touching, 10);
}

TEST(Meet, of_a_box_and_a_triangle_is_what_exact_linear_algebra_says)
{
    Random random(52);
    Tally tally;
    const auto vec = [](const GridPoint& p) {
        return Vec3(static_cast<double>(p[0]), static_cast<double>(p[1]),
                    static_cast<double>(p[2]));
    };
    for (int i = 0; i < kClasses * cases_per_class() / 4; ++i)
    {
        const std::uint32_t steps = 2 + random.below(8);
        const auto point = [&]() -> GridPoint
        {
            const auto coordinate = [&]
            { return std::int64_t{random.below(2 * steps + 1)} - std::int64_t{steps}; };
            return {coordinate(), coordinate(), coordinate()};
        };
        const GridPoint half{random.below(steps), random.below(steps), random.below(steps)};
        const GridTriangle triangle{point(), point(), point()};
        const bool expected = box_shares_a_point(half, triangle);
        tally.add(expected);
        const double scale = std::ldexp(1.0, static_cast<int>(random.below(60)) - 30);
        const Triangle placed{vec(triangle[0]) * scale, vec(triangle[1]) * scale,
                              vec(triangle[2]) * scale};
        ASSERT_EQ(meet(Box{vec(half) * scale}, placed), expected) << "case " << i;
    }
    tally.expect_both();
}

TEST(Meet, tells_touching_from_missing_by_one_bit)
{
    const Triangle floor{Vec3(0.1, 0.1, 0.1), Vec3(1.1, 0.1, 0.1), Vec3(0.1, 1.1, 0.1)};
    const auto standing = [](double height) {
        return Triangle{Vec3(0.3, 0.3, height), Vec3(0.3, 0.4, 2.0), Vec3(0.4, 0.3, 2.0)};
    };

    EXPECT_TRUE(meet(floor, standing(0.1)));
    EXPECT_FALSE(meet(floor, standing(std::nextafter(0.1, 1.0))));
    EXPECT_FALSE(meet(Box{Vec3(0.1, 0.1, 0.1)}, standing(std::nextafter(0.1, 1.0))));
    EXPECT_TRUE(meet(Box{Vec3(0.3, 0.3, 0.1)}, standing(0.1)));
    EXPECT_FALSE(meet(Box{Vec3(std::nextafter(0.3, 0.0), 0.3, 0.1)}, standing(0.1)));
}

} // namespace tactus::test
