// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/math/aabb.hpp"
#include "rt_core/spm/error_code.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::test
{

namespace
{

Vec3f random_point(Random& random)
{
    return to_float(random.in_cube(10.0));
}

/// On the outer side of the exact bound, and the float next to it is not.
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

TEST(Aabb, inflation_rounds_outward_by_no_more_than_one_float)
{
    Random random(14);
    for (int i = 0; i < 200'000; ++i)
    {
        Aabb box;
        box.add(random_point(random));
        box.add(random_point(random));
        const auto margin = static_cast<float>(std::exp2(random.between(-24.0, 10.0)));
        ASSERT_NO_FATAL_FAILURE(expect_tight_outside(box, margin));
    }
}

/// Codes up to 141 hold 2^27 quanta, more than the largest model.
TEST(Aabb, inflation_by_a_models_errors_is_outward_at_every_grid_coordinate)
{
    Random random(15);
    for (int i = 0; i < 200'000; ++i)
    {
        Aabb box;
        for (int point = 0; point < 2; ++point)
        {
            Vec3f p{};
            for (float& coordinate : p)
            {
                coordinate = static_cast<float>(random.below(1U << (1 + random.below(24))));
            }
            box.add(p);
        }
        const auto code = static_cast<ErrorCode>(1 + random.below(141));
        ASSERT_NO_FATAL_FAILURE(expect_tight_outside(box, error_in_quanta(code))) << int{code};
    }
}

TEST(Aabb, inflation_by_nothing_changes_nothing)
{
    Aabb sut{{1.0F, -2.0F, 0.1F}, {4.0F, 5.0F, 6.0F}};

    EXPECT_EQ(sut.inflated(0.0F), sut);
}

} // namespace tactus::test
