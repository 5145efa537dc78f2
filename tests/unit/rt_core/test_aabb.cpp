// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/math/aabb.hpp"
#include "rt_core/math/smallest_union.hpp"
#include "rt_core/spm/error_code.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace tactus::test
{

namespace
{

Vec3f random_point(Random& random)
{
    return to_float(random.in_cube(10.0));
}

/// Expects the bound on the outer side of the exact one, and the adjacent float inside.
void expect_tight_outside(const Aabb& box, float margin)
{
    const Aabb grown = box.inflated(margin);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const long double low =
            static_cast<long double>(box.low[axis]) - static_cast<long double>(margin);
        const long double high =
            static_cast<long double>(box.high[axis]) + static_cast<long double>(margin);
        ASSERT_LE(static_cast<long double>(grown.low[axis]), low) << margin;
        ASSERT_GE(static_cast<long double>(grown.high[axis]), high) << margin;
        ASSERT_GT(static_cast<long double>(std::nextafter(grown.low[axis], INFINITY)), low);
        ASSERT_LT(static_cast<long double>(std::nextafter(grown.high[axis], -INFINITY)), high);
    }
}

} // namespace

TEST(Aabb, the_empty_box_changes_no_union)
{
    Aabb sut{{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}};
    const Aabb before = sut;

    sut.add(Aabb{});
    EXPECT_EQ(sut, before);
    Aabb other;
    other.add(before);
    EXPECT_EQ(other, before);
}

TEST(Aabb, holds_exactly_the_extremes_of_its_points)
{
    Random random(13);
    for (int round = 0; round < 1'000; ++round)
    {
        SCOPED_TRACE("round " + std::to_string(round));
        std::vector<Vec3f> points(1 + random.below(20));
        Aabb sut;
        Aabb first_half;
        Aabb second_half;
        for (std::size_t i = 0; i < points.size(); ++i)
        {
            points[i] = random_point(random);
            sut.add(points[i]);
            (i % 2 == 0 ? first_half : second_half).add(points[i]);
        }
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const auto [least, most] =
                std::minmax_element(points.begin(), points.end(),
                                    [axis](auto& a, auto& b) { return a[axis] < b[axis]; });
            ASSERT_EQ(sut.low[axis], (*least)[axis]);
            ASSERT_EQ(sut.high[axis], (*most)[axis]);
        }
        first_half.add(second_half);
        ASSERT_EQ(first_half, sut);
    }
}

TEST(Aabb, holds_boxes_up_to_its_sides_and_none_beyond)
{
    const Aabb sut{{0.0F, 0.0F, 0.0F}, {2.0F, 2.0F, 2.0F}};
    EXPECT_TRUE(holds(sut, sut));
    EXPECT_TRUE(holds(sut, Aabb{}));
    EXPECT_TRUE(holds(sut, {{0.0F, 1.0F, 0.0F}, {2.0F, 1.0F, 2.0F}}));
    EXPECT_FALSE(holds(sut, {{0.0F, 1.0F, 0.0F}, {2.0F, 1.0F, std::nextafter(2.0F, 3.0F)}}));
    EXPECT_FALSE(holds(sut, {{std::nextafter(0.0F, -1.0F), 1.0F, 0.0F}, {2.0F, 1.0F, 2.0F}}));
}

TEST(Aabb, the_smallest_union_is_that_of_the_nearest_boxes_flat_or_not)
{
    const auto cube_at = [](float x) { return Aabb{{x, 0.0F, 0.0F}, {x + 1.0F, 1.0F, 1.0F}}; };
    using Pair = std::pair<std::size_t, std::size_t>;
    EXPECT_EQ(smallest_union(std::array{cube_at(0.0F), cube_at(9.0F)}), Pair(0, 1));
    EXPECT_EQ(smallest_union(std::array{cube_at(0.0F), cube_at(9.0F), cube_at(5.0F)}), Pair(1, 2));
    EXPECT_EQ(smallest_union(std::array{cube_at(8.0F), cube_at(0.0F), cube_at(9.0F)}), Pair(0, 2));
    // Flat boxes: all unions have the volume zero.
    const auto point_at = [](float x) { return Aabb{{x, x, 0.0F}, {x, x, 0.0F}}; };
    EXPECT_EQ(smallest_union(std::array{point_at(0.0F), point_at(4.0F), point_at(7.0F)}),
              Pair(1, 2));
    // Equal unions: the first pair.
    EXPECT_EQ(smallest_union(std::array{point_at(0.0F), point_at(3.0F), point_at(6.0F)}),
              Pair(0, 1));
    EXPECT_EQ(smallest_union(std::array{Aabb{{-Aabb::kHuge, 0.0F, 0.0F}, {Aabb::kHuge, 1.0F, 1.0F}},
                                        cube_at(0.0F), cube_at(1.0F)}),
              Pair(1, 2));
}

/// Random numbers, and grid coordinates with a model's errors: codes up to 141 hold 2^27 quanta,
/// more than the largest model. A zero margin changes nothing.
TEST(Aabb, inflation_rounds_outward_by_no_more_than_one_float)
{
    Random random(14);
    const auto on_grid = [&random]
    { return static_cast<float>(random.below(1U << (1 + random.below(24)))); };
    for (int i = 0; i < 400'000; ++i)
    {
        const bool is_grid = i % 2 == 1;
        Aabb box;
        for (int point = 0; point < 2; ++point)
        {
            box.add(is_grid ? Vec3f{on_grid(), on_grid(), on_grid()} : random_point(random));
        }
        const auto code = static_cast<ErrorCode>(random.below(142));
        const float margin = is_grid ? error_in_quanta(code)
                                     : static_cast<float>(std::exp2(random.between(-24.0, 10.0)));
        ASSERT_NO_FATAL_FAILURE(expect_tight_outside(box, margin)) << margin;
        ASSERT_TRUE(margin > 0.0F || box.inflated(margin) == box);
    }
}

} // namespace tactus::test
