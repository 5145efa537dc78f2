// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/box_triangle.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "tests/shared/round_triangle.hpp"
#include "tests/unit/geometry/convex_checks.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <limits>

namespace tactus::test
{
namespace
{

using enum HullError;

/// Checks the distance of a shape as a convex body against its own kernel.
void check(const GjkAnswer& answer, const ClosestPoints& kernel, double length, double law)
{
    const double distance = std::max(0.0, kernel.distance);
    ASSERT_TRUE(is_finite(answer));
    ASSERT_LE(answer.lower, distance + kernel.distance_error);
    ASSERT_GE(answer.upper, distance - kernel.distance_error);
    ASSERT_LE(answer.upper - answer.lower, 1e-12 * answer.upper + law * length);
    ASSERT_LE(answer.iterations, kGjkIterations);
}

using ConvexShapeTest = ::testing::TestWithParam<PairClass>;

} // namespace

TEST_P(ConvexShapeTest, box_and_segment_are_as_far_as_their_kernels_say)
{
    Random random(95);
    for (int i = 0; i < convex_cases_per_class() / 4; ++i)
    {
        const TrianglePair pair = GetParam().make(random);
        const BoxScene scene = box_scene(pair, random);
        const std::vector<Vec3> corners = corners_of(scene.box);
        const Hull box = hull_of(corners);
        Vec3 direction(0, 0, 0);
        const GjkAnswer of_box = gjk_distance(box.body(), scene.triangle, direction);
        check(of_box, closest_points(scene.box, scene.triangle),
              local_length(box.body(), scene.triangle), 1e-14);
        ASSERT_FALSE(HasFatalFailure()) << "box, case " << i;

        const Segment segment = pair.segment();
        const std::vector<Vec3> ends{segment.from, segment.to};
        const Hull hull = hull_of(ends);
        direction = Vec3(0, 0, 0);
        const GjkAnswer of_segment = gjk_distance(hull.body(), pair.second, direction);
        check(of_segment, closest_points(segment, pair.second),
              local_length(hull.body(), pair.second), 1e-14);
        ASSERT_FALSE(HasFatalFailure()) << "segment, case " << i;
    }
}

/// Curved bodies may run out of iterations: their bounds still hold, and are close.
TEST_P(ConvexShapeTest, sphere_and_capsule_are_as_far_as_their_kernels_say)
{
    Random random(96);
    int out_of_law = 0;
    double worst = 0.0;
    for (int i = 0; i < convex_cases_per_class() / 4; ++i)
    {
        const TrianglePair pair = GetParam().make(random);
        const double size = (pair.first[1] - pair.first[0]).norm();
        const double radius = size * std::exp2(random.between(-10.0, 1.0));
        const Capsule capsule{{pair.first[0], random.one_in(2) ? pair.first[0] : pair.first[1]},
                              radius};
        const RoundCore body(capsule);
        const double length = local_length(body.body(), pair.second);
        Vec3 direction = random.one_in(2) ? Vec3(0, 0, 0) : random.in_cube(1.0);

        const GjkAnswer answer = gjk_distance(body.body(), pair.second, direction);

        // The centre is rounded.
        ClosestPoints kernel = closest_points(capsule, pair.second);
        kernel.distance_error += 1e-15 * largest_coordinate(pair.first);
        check(answer, kernel, length, 1e-9);
        ASSERT_FALSE(HasFatalFailure()) << "case " << i;
        out_of_law += share_of_law(answer, length) > 1.0 ? 1 : 0;
        worst = std::max(worst, share_of_law(answer, length));
    }
    std::printf("%s: %d of %d out of the law of hulls, worst %.3g of it\n", GetParam().name,
                out_of_law, convex_cases_per_class() / 4, worst);
}

INSTANTIATE_TEST_SUITE_P(Pairs, ConvexShapeTest, ::testing::ValuesIn(pair_classes()),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(ConvexBodies, answers_scale_with_their_questions)
{
    Random random(97);
    for (int i = 0; i < convex_cases_per_class(); ++i)
    {
        HullScene scene =
            hull_scene(pair_classes()[random.below(kPairClasses)].make(random), random);
        const double factor = std::exp2(random.one_in(2) ? -300.0 : 300.0);
        HullScene far = scene;
        far.triangle = scaled(scene.triangle, factor);
        for (Vec3& vertex : far.vertices)
        {
            vertex *= factor;
        }
        Vec3 direction(0, 0, 0);
        Vec3 far_direction(0, 0, 0);

        const GjkAnswer usual =
            gjk_distance(hull_of(scene.vertices).body(), scene.triangle, direction);
        const Hull far_hull = hull_of(far.vertices);
        const GjkAnswer answer = gjk_distance(far_hull.body(), far.triangle, far_direction);

        ASSERT_TRUE(is_finite(answer)) << "case " << i;
        ASSERT_NEAR(answer.upper / factor, usual.upper, 6.0 * usual.rounding) << "case " << i;
    }
}

TEST(ConvexBodies, every_answer_to_finite_numbers_is_finite)
{
    Random random(98);
    const auto number = [&random]
    {
        const std::uint32_t kind = random.below(5);
        const double size = kind == 0   ? 0.0
                            : kind == 1 ? 1e300
                            : kind == 2 ? 0x1p-1074
                            : kind == 3 ? 1.0
                                        : std::exp2(random.between(-1000.0, 990.0));
        return random.one_in(2) ? size : -size;
    };
    const auto point = [&number]
    {
        const double x = number();
        const double y = number();
        return Vec3(x, y, number());
    };
    for (int i = 0; i < convex_cases_per_class() * 4; ++i)
    {
        std::vector<Vec3> vertices;
        for (std::uint32_t count = 1 + random.below(6); count > 0; --count)
        {
            vertices.push_back(point());
        }
        const Hull hull = hull_of(vertices);
        const Vec3 corner = point();
        const Triangle triangle{corner, random.one_in(3) ? corner : point(), point()};
        Vec3 direction = random.one_in(3) ? point() : Vec3(0, 0, 0);

        const GjkAnswer answer = gjk_distance(hull.body(), triangle, direction);

        ASSERT_TRUE(is_finite(answer)) << "case " << i;
        ASSERT_TRUE(direction.allFinite()) << "case " << i;
    }
}

TEST(Hull, refuses_what_is_no_hull)
{
    std::vector<Vec3> vertices(kMaxHullVertices, Vec3(1, 2, 3));
    EXPECT_TRUE(Hull::create(vertices).has_value());
    vertices.emplace_back(1, 2, 3);
    EXPECT_EQ(Hull::create(vertices).error(), too_many_vertices);
    EXPECT_EQ(Hull::create({}).error(), no_vertex);
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
          -std::nextafter(kCoordinateRange, 1e301)})
    {
        vertices.assign(3, Vec3(1, 2, -kCoordinateRange));
        EXPECT_TRUE(Hull::create(vertices).has_value());
        vertices[1][2] = bad;
        EXPECT_EQ(Hull::create(vertices).error(), vertex_not_finite) << bad;
    }
}

TEST(Hull, is_within_its_radius_round_its_centre)
{
    Random random(99);
    for (int i = 0; i < 2'000; ++i)
    {
        const HullScene scene =
            hull_scene(pair_classes()[random.below(kPairClasses)].make(random), random);
        const ConvexBody body = hull_of(scene.vertices).body();
        for (const Vec3& vertex : scene.vertices)
        {
            ASSERT_LE((vertex - body.center).norm(), body.radius) << "case " << i;
        }
    }
}

TEST(Hull, has_its_farthest_vertex_where_it_is_asked_for_and_of_equals_the_first)
{
    const std::vector<Vec3> vertices{Vec3(0, 0, 0), Vec3(2, 0, 1), Vec3(2, 4, 1), Vec3(0, 4, 2)};
    const Hull hull = hull_of(vertices);
    const ConvexBody body = hull.body();
    const auto farthest = [&body](const Vec3& direction) -> Vec3
    { return body.center + body.support(body.context, direction); };

    EXPECT_EQ(body.center, Vec3(1, 2, 1));
    EXPECT_EQ(farthest(Vec3(0, 0, 1)), vertices[3]);
    EXPECT_EQ(farthest(Vec3(0, 0, -1)), vertices[0]);
    EXPECT_EQ(farthest(Vec3(1, 0, 0)), vertices[1]);
    EXPECT_EQ(farthest(Vec3(0, 1, 0)), vertices[2]);
}

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
