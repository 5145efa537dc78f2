// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/round_triangle.hpp"
#include "tests/unit/geometry/shape_oracle.hpp"
#include "tests/unit/geometry/shape_scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace tactus::test
{

namespace
{

/// What holds for every round shape, whose core is `core_distance` away: in wide numbers.
void check(const ClosestPoints& answer, double radius, Quad core_distance, double magnitude)
{
    const auto truth = core_distance - static_cast<Quad>(radius);
    ASSERT_LE(std::abs(static_cast<double>(truth - static_cast<Quad>(answer.distance))),
              answer.distance_error + 1e-17 * magnitude); // What wide numbers leave on thin faces.
    ASSERT_EQ(answer.meet, answer.distance <= 0.0);
    const double slack = answer.distance_error + 1e-15 * (magnitude + radius);
    ASSERT_LE((answer.on_triangle - answer.on_shape - answer.gap).norm(), slack);
    if (answer.distance > -radius)
    {
        ASSERT_NEAR(answer.gap.norm(), std::abs(answer.distance), slack);
    }
}

double magnitude_of(const TrianglePair& pair)
{
    double most = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
    {
        most = std::max(
            {most, pair.first[i].cwiseAbs().maxCoeff(), pair.second[i].cwiseAbs().maxCoeff()});
    }
    return most;
}

/// Now and then just the distance, so that the shape touches.
double some_radius(Random& random, double distance, double magnitude)
{
    return random.one_in(3) ? distance : magnitude * std::exp2(random.between(-20.0, 1.0));
}

class RoundShapeTest : public ::testing::TestWithParam<PairClass>
{
};

} // namespace

TEST_P(RoundShapeTest, sphere_keeps_its_error_law)
{
    Random random(70);
    for (int i = 0; i < cases_per_class() / 4; ++i)
    {
        const TrianglePair pair = GetParam().make(random);
        const Vec3 center = pair.first[random.below(3)];
        const Quad distance = QuadDistanceOracle::distance(center, pair.second);
        const double size = magnitude_of(pair);
        const double radius = some_radius(random, static_cast<double>(distance), size);
        check(closest_points(Sphere{center, radius}, pair.second), radius, distance, size);
        ASSERT_FALSE(HasFatalFailure()) << "case " << i;
    }
}

TEST_P(RoundShapeTest, capsule_keeps_its_error_law)
{
    Random random(71);
    for (int i = 0; i < cases_per_class() / 4; ++i)
    {
        const TrianglePair pair = GetParam().make(random);
        const Segment core = pair.segment();
        const std::array<Vec3, 2> ends{core.from, core.to};
        const auto distance = ShapeOracle<long double>::distance(ends, pair.second);
        const double size = magnitude_of(pair);
        const double radius = some_radius(random, static_cast<double>(distance), size);
        const ClosestPoints answer = closest_points(Capsule{core, radius}, pair.second);
        const long double off =
            std::abs(distance - static_cast<long double>(radius + answer.distance));
        const bool is_clear = off < 0.5L * static_cast<long double>(answer.distance_error);
        check(answer, radius,
              is_clear ? static_cast<Quad>(distance)
                       : ShapeOracle<Quad>::distance(ends, pair.second),
              size);
        ASSERT_FALSE(HasFatalFailure()) << "case " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Pairs, RoundShapeTest, ::testing::ValuesIn(pair_classes()),
                         [](const auto& kind) { return std::string(kind.param.name); });

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
