// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/round_triangle.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{

TEST(RoundShape, over_a_face_is_its_height_less_the_radius_away)
{
    const Triangle triangle{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};

    const ClosestPoints above = closest_points(Sphere{Vec3(1, 1, 3), 1.0}, triangle);
    const ClosestPoints inside = closest_points(Sphere{Vec3(1, 1, 0.5), 1.0}, triangle);
    const ClosestPoints lying =
        closest_points(Capsule{{Vec3(1, 1, 2), Vec3(2, 1, 2)}, 2.0}, triangle);

    EXPECT_EQ(above.distance, 2.0);
    EXPECT_EQ(above.on_shape, Vec3(1, 1, 2));
    EXPECT_EQ(above.on_triangle, Vec3(1, 1, 0));
    EXPECT_EQ(above.feature, TriangleFeature::interior);
    EXPECT_FALSE(above.meet);
    EXPECT_EQ(inside.distance, -0.5);
    EXPECT_EQ(inside.gap, Vec3(0, 0, 0.5));
    EXPECT_TRUE(inside.meet);
    EXPECT_EQ(lying.distance, 0.0);
    EXPECT_TRUE(lying.meet);
}

TEST(RoundShape, with_its_core_on_the_triangle_has_no_direction)
{
    const Triangle triangle{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};

    const ClosestPoints answer = closest_points(Sphere{Vec3(1, 1, 0), 0.25}, triangle);

    EXPECT_EQ(answer.distance, -0.25);
    EXPECT_EQ(answer.on_shape, Vec3(1, 1, 0));
    EXPECT_EQ(answer.gap, Vec3(0, 0, 0));
    EXPECT_TRUE(answer.meet);
}

} // namespace tactus::test
