// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// What judges pairs of faces, against linear algebra that knows of no planes and sides.

#include "tests/shared/exact_meet.hpp"
#include "tests/shared/shape_scenes.hpp"
#include "tests/unit/geometry/grid.hpp"
#include "tests/unit/geometry/integer_oracle.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{

TEST(ExactMeet, is_what_exact_linear_algebra_says)
{
    Random random(55);
    Tally tally;
    for (int i = 0; i < 4 * cases_per_class(); ++i)
    {
        Grid grid(random);
        const GridTriangle a = grid.triangle();
        const GridTriangle b = grid.triangle();
        const bool expected = share_a_point({a[0], a[1], a[2]}, b);
        tally.add(expected);
        ASSERT_EQ(exactly_meet(grid.placed(a), grid.placed(b)), expected) << "case " << i;
        ASSERT_EQ(exactly_meet(grid.placed(b), grid.placed(a)), expected) << "case " << i;
    }
    tally.expect_both();
}

TEST(ExactMeet, of_a_segment_is_what_exact_linear_algebra_says)
{
    Random random(56);
    Tally tally;
    for (int i = 0; i < 4 * cases_per_class(); ++i)
    {
        Grid grid(random);
        const GridTriangle a = grid.triangle();
        const GridTriangle b = grid.triangle();
        const Triangle ends = grid.placed(a);
        if (ends[0] != ends[1])
        {
            const bool expected = share_a_point({a[0], a[1]}, b);
            tally.add(expected);
            ASSERT_EQ(exactly_meet(ends[0], ends[1], grid.placed(b)), expected) << "case " << i;
            ASSERT_EQ(exactly_meet(ends[1], ends[0], grid.placed(b)), expected) << "case " << i;
        }
    }
    tally.expect_both();
}

TEST(ExactMeet, tells_touching_from_missing_by_one_bit)
{
    const Triangle floor{Vec3(0.1, 0.1, 0.1), Vec3(1.1, 0.1, 0.1), Vec3(0.1, 1.1, 0.1)};
    const auto standing = [](double height) {
        return Triangle{Vec3(0.3, 0.3, height), Vec3(0.3, 0.4, 2.0), Vec3(0.4, 0.3, 2.0)};
    };
    EXPECT_TRUE(exactly_meet(floor, standing(0.1)));
    EXPECT_FALSE(exactly_meet(floor, standing(std::nextafter(0.1, 1.0))));
    EXPECT_TRUE(exactly_meet(floor, standing(std::nextafter(0.1, 0.0))));
}

TEST(ExactMeet, volumes_have_the_right_sign_over_any_range_of_exponents)
{
    const double tiny = std::ldexp(1.0, -1'000);
    const Vec3 a(1.0, 1.0, 1.0);
    const Vec3 b(3.0, 1.0, 1.0);
    const Vec3 c(1.0, 5.0, 1.0);
    EXPECT_EQ(exact_volume_sign(a, b, c, Vec3(0.0, 0.0, 1.0)), 0);
    EXPECT_EQ(exact_volume_sign(a, b, c, Vec3(0.0, tiny, 1.0)), 0);
    const Vec3 origin(0.0, 0.0, 0.0);
    EXPECT_EQ(exact_volume_sign(origin, b, c, Vec3(2.0, 3.0, 1.0)), 0);
    EXPECT_EQ(exact_volume_sign(origin, b, c, Vec3(2.0, 3.0, std::nextafter(1.0, 2.0))), 1);
    EXPECT_EQ(exact_volume_sign(origin, b, c, Vec3(2.0, 3.0, std::nextafter(1.0, 0.0))), -1);
    const Vec3 sum = b + 2.0 * c; // In a plane with the origin, b and c.
    EXPECT_EQ(exact_volume_sign(Vec3(tiny, 0.0, 0.0), b, c, sum), -1);
    EXPECT_EQ(exact_volume_sign(Vec3(-tiny, 0.0, 0.0), b, c, sum), 1);
}

} // namespace tactus::test
