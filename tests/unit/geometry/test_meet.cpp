// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/box_triangle.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/geometry/crossing.hpp"
#include "rt_core/geometry/shared_features.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/shape_scenes.hpp"
#include "tests/unit/geometry/grid.hpp"
#include "tests/unit/geometry/integer_oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace tactus::test
{
namespace
{

/// Compares to the bit. Any thread.
void expect_same(const ClosestPoints& sut, const ClosestPoints& own)
{
    ASSERT_EQ(sut.on_shape, own.on_shape);
    ASSERT_EQ(sut.on_triangle, own.on_triangle);
    ASSERT_EQ(sut.gap, own.gap);
    ASSERT_EQ(sut.distance, own.distance);
    ASSERT_EQ(sut.distance_error, own.distance_error);
    ASSERT_EQ(sut.meet, own.meet);
    ASSERT_EQ(sut.feature, own.feature);
    ASSERT_EQ(sut.shape_feature, own.shape_feature);
}

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

namespace
{

constexpr int kSide = 6;

/// Arrangement of two sheets of triangles above each other.
struct Sheets
{
    const char* name;
    double height; ///< Height of the bumps, in edges.
    double apart;  ///< Distance of the sheets.
    double narrow; ///< Ratio of edges across to edges along.
    double scale;
};

constexpr std::array kSheets{
    Sheets{"bumpy", 0.5, 1.2, 1.0, 1.0},
    Sheets{"shallow", 1e-3, 0.1, 1.0, 1.0},
    Sheets{"flat and parallel", 0.0, 0.3, 1.0, 1.0},
    Sheets{"needles", 0.3, 0.7, 1e-4, 1.0},
    Sheets{"all but touching", 0.5, 1e-7, 1.0, 1.0},
    Sheets{"crossing", 0.8, 0.0, 1.0, 1.0},
    Sheets{"tiny", 0.5, 1.2, 1.0, 0x1p-100},
    Sheets{"huge", 0.5, 1.2, 1.0, 0x1p100},
};

/// Bumpy sheet; its inner corners belong to six faces.
std::vector<Triangle> sheet(Random& random, const Sheets& sheets, const Vec3& at, double spread)
{
    std::vector<Vec3> corners;
    for (int i = 0; i < kSide * kSide; ++i)
    {
        const Vec3 off = spread * random.in_cube(0.3);
        const Vec3 place(i % kSide, i / kSide, sheets.height * random.between(0.0, 1.0));
        corners.push_back(
            sheets.scale *
            (at + Vec3(place.x() + off.x(), sheets.narrow * (place.y() + off.y()), place.z())));
    }
    std::vector<Triangle> faces;
    for (int y = 0; y + 1 < kSide; ++y)
    {
        for (int x = 0; x + 1 < kSide; ++x)
        {
            const auto corner = [&](int right, int up)
            { return corners[static_cast<std::size_t>((y + up) * kSide + x + right)]; };
            faces.push_back({corner(0, 0), corner(1, 0), corner(1, 1)});
            faces.push_back({corner(1, 1), corner(0, 1), corner(0, 0)});
            faces.push_back({corner(0, 0), corner(1, 1), corner(0, 0)}); // A line twice.
        }
    }
    return faces;
}

} // namespace

TEST(SharedFeatures, of_any_pairs_in_any_order_are_those_that_measuring_finds)
{
    Random random(61);
    for (const Sheets& sheets : kSheets)
    {
        int shared = 0;
        for (int round = 0; round < 12; ++round)
        {
            const double spread = round % 2 == 0 ? 1.0 : 0.0;
            const Vec3 over{random.between(0.0, 2.0), random.between(0.0, 2.0),
                            sheets.height + sheets.apart};
            const auto below = sheet(random, sheets, Vec3(0, 0, 0), spread);
            const auto above = sheet(random, sheets, over, spread);
            std::vector<std::pair<double, std::pair<const Triangle*, const Triangle*>>> pairs;
            for (const Triangle& first : above)
            {
                for (const Triangle& second : below)
                {
                    if (!meet(first, second))
                    {
                        // The order is by distance, as in a query, or random.
                        const double distance = closest_points(first, second, false).distance;
                        pairs.push_back({round % 3 == 0 ? random.between(0.0, 1.0) : distance,
                                         {&first, &second}});
                    }
                }
            }
            std::ranges::sort(pairs);
            SharedFeatures sut;
            std::set<std::pair<double, double>> points;
            for (const auto& [order, faces] : pairs)
            {
                const ClosestPoints own = closest_points(*faces.first, *faces.second, false);
                ASSERT_NO_FATAL_FAILURE(
                    expect_same(sut.closest_points(*faces.first, *faces.second), own))
                    << sheets.name;
                shared += points.insert({own.on_shape.x(), own.on_triangle.x()}).second ? 0 : 1;
            }
        }
        EXPECT_GT(shared, 500) << sheets.name; // Shows that the test is not empty.
    }
}
} // namespace tactus::test
