// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/point_triangle.hpp"
#include "tests/shared/distance_oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace tactus::test
{

namespace
{

void expect_oracle(const std::array<Vec3, 3>& t, const PointColumns& points)
{
    const DistanceTriangle sut(t[0], t[1], t[2]);
    std::vector<double> squared(points.size());
    sut.squared_distances(points, 0, squared.data());
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const auto expected = static_cast<double>(QuadDistanceOracle::distance(points[i], t));
        ASSERT_NEAR(std::sqrt(squared[i]), expected, 2e-7);
    }
}

/// Draws in a fixed order, since that of arguments is the compiler's choice.
Vec3 any_vector(auto& draw, std::mt19937& random)
{
    const double x = draw(random);
    const double y = draw(random);
    const double z = draw(random);
    return {x, y, z};
}

PointColumns random_points(std::mt19937& random, int extent, const std::array<Vec3, 3>& t)
{
    std::uniform_int_distribution<int> draw(0, extent);
    PointColumns points;
    for (int i = 0; i < 8; ++i)
    {
        const Vec3 p = any_vector(draw, random);
        points.push_back(p);
        points.push_back((t[0] + t[1] + t[2]) / 3 + 1e-4 * p);
    }
    return points;
}

} // namespace

TEST(DistanceTriangle, agrees_with_extended_precision_on_random_triangles)
{
    std::mt19937 random(31);
    for (const int extent : {3, 100, 65'535, 16'777'215})
    {
        std::uniform_int_distribution<int> draw(0, extent);
        for (int run = 0; run < 300; ++run)
        {
            std::array<Vec3, 3> t;
            for (auto& corner : t)
            {
                corner = any_vector(draw, random);
            }
            expect_oracle(t, random_points(random, extent, t));
        }
    }
}

TEST(DistanceTriangle, agrees_with_extended_precision_on_needles)
{
    std::mt19937 random(32);
    std::uniform_int_distribution<int> draw(0, 16'777'215);
    std::uniform_int_distribution<int> near(-2, 2);
    for (int run = 0; run < 1000; ++run)
    {
        const Vec3 a = any_vector(draw, random);
        const Vec3 b = any_vector(draw, random);
        const Vec3 nudge = any_vector(near, random);
        const Vec3 middle = 0.5 * (a + b);
        const Vec3 rounded(std::round(middle.x()), std::round(middle.y()), std::round(middle.z()));
        const std::array<Vec3, 3> needle{a, b, a + nudge};
        const std::array<Vec3, 3> cap{a, b, rounded + nudge};
        expect_oracle(needle, random_points(random, 16'777'215, needle));
        expect_oracle(cap, random_points(random, 16'777'215, cap));
    }
}

TEST(DistanceTriangle, every_instruction_set_gives_the_same_bits)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> draw(-1e6, 1e6);
    KernelTriangle triangle{};
    std::vector<double> numbers(sizeof(KernelTriangle) / sizeof(double));
    for (int run = 0; run < 200; ++run)
    {
        std::ranges::generate(numbers, [&] { return draw(random); });
        std::memcpy(&triangle, numbers.data(), sizeof triangle);
        std::array<std::vector<double>, 3> at;
        for (auto& axis : at)
        {
            axis.resize(67); // Not a multiple of any number of lanes.
            std::ranges::generate(axis, [&] { return draw(random); });
        }
        std::vector<double> expected(67);
        kPortableSquaredDistances(triangle, at[0].data(), at[1].data(), at[2].data(), 1, 67,
                                  expected.data());
        for (const SquaredDistances kernel : available_distance_kernels())
        {
            std::vector<double> squared(67);
            kernel(triangle, at[0].data(), at[1].data(), at[2].data(), 1, 67, squared.data());
            ASSERT_EQ(std::memcmp(squared.data(), expected.data(), 67 * sizeof(double)), 0);
        }
    }
}

TEST(DistanceTriangle, without_area_is_its_sides)
{
    const Vec3 a(10, 20, 30);
    const Vec3 b(13, 24, 30);
    PointColumns points;
    points.push_back(Vec3(10, 20, 35));
    points.push_back(Vec3(0, 20, 30));
    std::vector<double> squared(2);
    DistanceTriangle(a, b, a).squared_distances(points, 0, squared.data());
    EXPECT_DOUBLE_EQ(squared[0], 25);
    EXPECT_DOUBLE_EQ(squared[1], 100);
    DistanceTriangle(a, a, a).squared_distances(points, 1, squared.data());
    EXPECT_DOUBLE_EQ(squared[0], 25);
    EXPECT_DOUBLE_EQ(squared[1], 100);
}

} // namespace tactus::test
