// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/limits.hpp"
#include "rt_core/math/triangle.hpp"
#include "tests/shared/distance_oracle.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace tactus::test
{

namespace
{

struct Pose
{
    Triangle triangle;
    Vec3 query;
};

struct ShapeClass
{
    const char* name;
    Pose (*make)(Random&);
};

void PrintTo(const ShapeClass& shape, std::ostream* out)
{
    *out << shape.name;
}

Vec3 on_grid(Random& random, std::uint32_t across, std::uint32_t up)
{
    const double x = random.below(across);
    const double y = random.below(across);
    const double z = random.below(up);
    return {x, y, z};
}

/// Point near the triangle: above its inside, beside an edge or a corner, far away, or on it.
Vec3 query_near(Random& random, const Triangle& triangle, double size)
{
    const double a = random.between(-0.5, 1.5);
    const double b = random.between(-0.5, 1.5);
    const Vec3 at = triangle[0] + a * (triangle[1] - triangle[0]) + b * (triangle[2] - triangle[0]);
    switch (random.below(4))
    {
    case 0:
        return at;
    case 1:
        return at + random.in_cube(size * std::exp2(random.between(-40.0, 0.0)));
    case 2:
    {
        const Vec3& corner = triangle[random.below(3)];
        return corner + random.in_cube(size * 0.1);
    }
    default:
        return random.in_cube(2.0 * size);
    }
}

Pose with_query(Random& random, const Triangle& triangle, double size)
{
    return {triangle, query_near(random, triangle, size)};
}

Pose generic(Random& random)
{
    return with_query(random, {random.in_cube(1.0), random.in_cube(1.0), random.in_cube(1.0)}, 1.0);
}

/// Triangle with one short edge across a long one.
Pose needle(Random& random)
{
    const Vec3 tip = random.in_cube(1.0);
    const Vec3 end = random.in_cube(1.0);
    const double width = std::exp2(random.between(-27.0, -3.0));
    return with_query(random, {tip, end, end + random.in_cube(width)}, 1.0);
}

/// Triangle with the third corner just off the middle of the longest edge.
Pose cap(Random& random)
{
    const Vec3 from = random.in_cube(1.0);
    const Vec3 to = random.in_cube(1.0);
    const double height = std::exp2(random.between(-26.6, -3.0));
    const Vec3 foot = from + random.between(0.0, 1.0) * (to - from);
    const Vec3 apex = foot + random.in_cube(height);
    return with_query(random, {from, apex, to}, 1.0);
}

Pose two_equal_corners(Random& random)
{
    const Vec3 a = random.in_cube(1.0);
    const Vec3 b = random.in_cube(1.0);
    const std::array<Triangle, 3> triangles{Triangle{a, a, b}, Triangle{a, b, a},
                                            Triangle{b, a, a}};
    return with_query(random, triangles[random.below(3)], 1.0);
}

Pose all_equal_corners(Random& random)
{
    const Vec3 a = random.in_cube(1.0);
    return with_query(random, {a, a, a}, 1.0);
}

/// Collinear triangle, exactly (small integers) or as nearly as doubles permit.
Pose collinear(Random& random)
{
    if (random.one_in(2))
    {
        const Vec3 a = on_grid(random, 8, 8);
        const Vec3 step = on_grid(random, 4, 4) + Vec3(0, 0, 1);
        return with_query(random, {a, a + step * random.below(5), a + step * random.below(5)}, 8.0);
    }
    const Vec3 a = random.in_cube(1.0);
    const Vec3 b = random.in_cube(1.0);
    return with_query(random, {a, b, a + random.between(-1.0, 2.0) * (b - a)}, 1.0);
}

Pose far_away(Random& random)
{
    Pose pose = generic(random);
    const Vec3 offset = random.in_cube(1e6);
    for (Vec3& corner : pose.triangle)
    {
        corner += offset;
    }
    if (!random.one_in(4))
    {
        pose.query += offset;
    }
    return pose;
}

Pose tiny(Random& random)
{
    Pose pose = random.one_in(2) ? generic(random) : needle(random);
    for (Vec3& corner : pose.triangle)
    {
        corner *= 1e-6;
    }
    pose.query *= 1e-6;
    return pose;
}

/// Triangle with stored coordinates: floats on a grid, as in a model.
Pose on_the_grid(Random& random)
{
    const auto point = [&random] { return Vec3(on_grid(random, 1U << 16U, 16) * 0x1p-16); };
    const Triangle triangle{point(), point(), point()};
    return {triangle, random.one_in(3) ? point() : query_near(random, triangle, 1.0)};
}

double magnitude(const Pose& pose)
{
    double most = pose.query.cwiseAbs().maxCoeff();
    for (const Vec3& corner : pose.triangle)
    {
        most = std::max(most, corner.cwiseAbs().maxCoeff());
    }
    return most;
}

/// Distance of the answer's point from its feature.
double off_feature(const Pose& pose, const ClosestPoint& answer)
{
    const auto feature = static_cast<std::size_t>(answer.feature);
    if (feature < 3)
    {
        return (answer.point - pose.triangle[feature]).norm();
    }
    if (feature < 6)
    {
        return static_cast<double>(DistanceOracle::to_segment(
            answer.point, pose.triangle[feature - 3], pose.triangle[(feature - 2) % 3]));
    }
    return static_cast<double>(DistanceOracle::distance(answer.point, pose.triangle));
}

/// Deviation of a distance from the true one; wider numbers decide on thin triangles, where long
/// double cannot.
double deviation(const Pose& pose, double distance, double allowed)
{
    const auto off = static_cast<double>(std::abs(
        DistanceOracle::distance(pose.query, pose.triangle) - static_cast<long double>(distance)));
    if (off <= 0.5 * allowed)
    {
        return off;
    }
    return std::abs(static_cast<double>(QuadDistanceOracle::distance(pose.query, pose.triangle) -
                                        static_cast<Quad>(distance)));
}

class ClosestPointTest : public ::testing::TestWithParam<ShapeClass>
{
};

} // namespace

TEST_P(ClosestPointTest, keeps_its_error_law_and_reports_a_point_of_the_triangle)
{
    Random random(16);
    double worst_law = 0.0;
    double worst_place = 0.0;
    double worst_reach = 0.0;
    for (int i = 0; i < 120'000; ++i)
    {
        const Pose pose = GetParam().make(random);
        const ClosestPoint answer = closest_point_on_triangle(pose.query, pose.triangle);
        ASSERT_TRUE(answer.point.allFinite()) << "case " << i;
        ASSERT_TRUE(std::isfinite(answer.distance_sq) && answer.distance_sq >= 0.0) << "case " << i;
        ASSERT_TRUE(std::isfinite(answer.distance_error)) << "case " << i;

        const double distance = std::sqrt(answer.distance_sq);
        const double off = deviation(pose, distance, answer.distance_error);
        ASSERT_LE(off, answer.distance_error) << "case " << i;
        // The point is also rounded to doubles of the query's size.
        const double slack = answer.distance_error + 4e-16 * magnitude(pose);
        const double reach = std::abs((answer.point - pose.query).norm() - distance);
        ASSERT_LE(reach, slack) << "case " << i;
        const double place = off_feature(pose, answer);
        ASSERT_LE(place, 4.0 * slack)
            << "case " << i << " feature " << static_cast<int>(answer.feature);
        worst_law = std::max(worst_law, off == 0.0 ? 0.0 : off / answer.distance_error);
        worst_place = std::max(worst_place, slack == 0.0 ? 0.0 : place / slack);
        worst_reach = std::max(worst_reach, slack == 0.0 ? 0.0 : reach / slack);
    }
    std::printf("%s: worst error / law %.3f, off the feature %.3f, off the distance %.3f\n",
                GetParam().name, worst_law, worst_place, worst_reach);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, ClosestPointTest,
    ::testing::Values(ShapeClass{"generic", generic}, ShapeClass{"needle", needle},
                      ShapeClass{"cap", cap}, ShapeClass{"two_equal_corners", two_equal_corners},
                      ShapeClass{"all_equal_corners", all_equal_corners},
                      ShapeClass{"collinear", collinear}, ShapeClass{"far_away", far_away},
                      ShapeClass{"tiny", tiny}, ShapeClass{"on_the_grid", on_the_grid}),
    [](const auto& shape) { return std::string(shape.param.name); });

TEST(ClosestPoint, names_the_feature_of_each_voronoi_region)
{
    const Triangle triangle{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
    const auto feature = [&triangle](double x, double y) {
        return closest_point_on_triangle({x, y, 1.0}, triangle).feature;
    };

    EXPECT_EQ(feature(-1, -1), TriangleFeature::corner_0);
    EXPECT_EQ(feature(6, -1), TriangleFeature::corner_1);
    EXPECT_EQ(feature(-1, 6), TriangleFeature::corner_2);
    EXPECT_EQ(feature(2, -1), TriangleFeature::edge_0);
    EXPECT_EQ(feature(4, 4), TriangleFeature::edge_1);
    EXPECT_EQ(feature(-1, 2), TriangleFeature::edge_2);
    EXPECT_EQ(feature(1, 1), TriangleFeature::interior);
}

TEST(ClosestPoint, is_exact_on_easy_numbers)
{
    const Triangle triangle{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};

    const ClosestPoint above = closest_point_on_triangle({1, 1, 3}, triangle);
    const ClosestPoint beside = closest_point_on_triangle({2, -3, 4}, triangle);

    EXPECT_EQ(above.distance_sq, 9.0);
    EXPECT_EQ(above.point, Vec3(1, 1, 0));
    EXPECT_EQ(beside.distance_sq, 25.0);
    EXPECT_EQ(beside.point, Vec3(2, 0, 0));
}

TEST(ClosestPoint, a_query_at_a_corner_is_at_distance_zero)
{
    const Triangle triangle{Vec3(0.1, 0.2, 0.3), Vec3(4, 0, 0), Vec3(0, 4, 0)};
    for (const Vec3& corner : triangle)
    {
        EXPECT_EQ(closest_point_on_triangle(corner, triangle).distance_sq, 0.0);
    }
}

} // namespace tactus::test
