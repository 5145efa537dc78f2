// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/limits.hpp"
#include "rt_core/math/triangle.hpp"
#include "tests/shared/distance_oracle.hpp"
#include "tests/shared/shape_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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

/// Triangle with stored coordinates: floats on a grid, as in a model; often with such a query.
TrianglePair on_the_grid(Random& random)
{
    const auto point = [&random]
    {
        const double x = random.below(1U << 16U);
        const double y = random.below(1U << 16U);
        return Vec3(Vec3(x, y, random.below(16)) * 0x1p-16);
    };
    return {{point(), point(), point()}, {point(), point(), point()}};
}

/// The second triangle of a pair with a point near it or of the first.
Pose some_pose(const TrianglePair& pair, Random& random)
{
    const Triangle& triangle = pair.second;
    const double longest =
        std::max((triangle[1] - triangle[0]).norm(), (triangle[2] - triangle[0]).norm());
    const double size = longest > 0.0 ? longest : 1.0; // For three equal corners.
    return {triangle, random.one_in(4) ? pair.first[0] : query_near(random, triangle, size)};
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

class ClosestPointTest : public ::testing::TestWithParam<PairClass>
{
};

std::string shape_name(const testing::TestParamInfo<PairClass>& shape)
{
    return shape.param.name;
}

} // namespace

TEST_P(ClosestPointTest, keeps_its_error_law_and_reports_a_point_of_the_triangle)
{
    Random random(16);
    double worst_law = 0.0;
    double worst_place = 0.0;
    double worst_reach = 0.0;
    for (int i = 0; i < 180'000; ++i)
    {
        const Pose pose = some_pose(GetParam().make(random), random);
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

INSTANTIATE_TEST_SUITE_P(Shapes, ClosestPointTest, ::testing::ValuesIn(pair_classes()), shape_name);
INSTANTIATE_TEST_SUITE_P(Stored, ClosestPointTest,
                         ::testing::Values(PairClass{"on_the_grid", on_the_grid}), shape_name);

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
