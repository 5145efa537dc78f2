// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/math/expansion.hpp"
#include "rt_core/math/orientation.hpp"
#include "tests/shared/distance_oracle.hpp"
#include "tests/unit/geometry/integer_oracle.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace tactus::test
{
namespace
{

Quad wide(const DoubleDouble& value)
{
    return static_cast<Quad>(value.high) + static_cast<Quad>(value.low);
}

DoubleDouble some_number(Random& random)
{
    const double mantissa = random.between(-1.0, 1.0);
    const double high = mantissa * std::exp2(random.between(-40.0, 40.0));
    return two_sum(high, high * 0x1p-54 * random.between(-1.0, 1.0));
}

double off(Quad value, Quad truth)
{
    return std::abs(static_cast<double>(value - truth));
}

int sign_of(Integer value)
{
    return value > 0 ? 1 : (value < 0 ? -1 : 0);
}

std::int64_t whole(Random& random, int bits)
{
    return static_cast<std::int64_t>(random.bits() >> (64 - bits)) -
           (std::int64_t{1} << (bits - 1));
}

Vec3 as_vec3(const GridPoint& p)
{
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

Integer determinant(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d)
{
    const auto way = [&a](const GridPoint& p, std::size_t i) { return Integer{p[i]} - a[i]; };
    Integer sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const std::size_t j = (i + 1) % 3;
        const std::size_t k = (i + 2) % 3;
        sum += way(b, i) * (way(c, j) * way(d, k) - way(c, k) * way(d, j));
    }
    return sum;
}

} // namespace

TEST(DoubleDouble, keeps_a_hundred_bits)
{
    Random random(60);
    for (int i = 0; i < 100'000; ++i)
    {
        const DoubleDouble a = some_number(random);
        const DoubleDouble b = some_number(random);
        const double size = std::abs(a.high) + std::abs(b.high);
        ASSERT_LE(off(wide(a + b), wide(a) + wide(b)), 0x1p-102 * size) << i;
        ASSERT_LE(off(wide(a - b), wide(a) - wide(b)), 0x1p-102 * size) << i;
        ASSERT_LE(off(wide(a * b), wide(a) * wide(b)), 0x1p-102 * std::abs(a.high * b.high)) << i;
        ASSERT_LE(off(wide(a / b), wide(a) / wide(b)), 0x1p-100 * std::abs(a.high / b.high)) << i;
        ASSERT_EQ(a < b, wide(a) < wide(b)) << i;
    }
}

/// Sums of products of two whole numbers, which fit in 128 bits.
TEST(Expansion, is_exact_and_has_its_terms_in_order)
{
    Random random(61);
    for (int i = 0; i < 100'000; ++i)
    {
        const std::int64_t a = whole(random, 53);
        const std::int64_t b = whole(random, 53);
        const std::int64_t c = whole(random, 53);
        const std::int64_t d = random.one_in(2) ? a + whole(random, 4) : whole(random, 53);
        const auto sum = Expansion<2>(two_product(static_cast<double>(a), static_cast<double>(b))) +
                         Expansion<2>(two_product(static_cast<double>(d), -static_cast<double>(c)));
        Integer value = 0;
        for (std::size_t k = 0; k < sum.size(); ++k)
        {
            ASSERT_NE(sum[k], 0.0) << i;
            ASSERT_TRUE(k == 0 || std::abs(sum[k - 1]) < std::abs(sum[k])) << i;
            value += static_cast<Integer>(sum[k]);
        }
        const Integer truth = Integer{a} * b - Integer{d} * c;
        ASSERT_TRUE(value == truth) << "case " << i;
        ASSERT_EQ(sum.sign(), sign_of(truth)) << i;
    }
}

TEST(Orientation, side_of_plane_is_exact_where_floating_point_is_not)
{
    Random random(62);
    int undecided = 0;
    for (int i = 0; i < 200'000; ++i)
    {
        const auto point = [&random]() -> GridPoint {
            return {whole(random, 30), whole(random, 30), whole(random, 30)};
        };
        const GridPoint a = point();
        const GridPoint b = point();
        const GridPoint c = point();
        // Roughly in the plane: a combination of corners, possibly a step beside it.
        const std::int64_t s = whole(random, 6);
        const std::int64_t t = whole(random, 6);
        GridPoint d{};
        for (std::size_t k = 0; k < 3; ++k)
        {
            d[k] = a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k]);
        }
        d[random.below(3)] += whole(random, 2);
        const Integer truth = determinant(a, b, c, d);
        const int side = side_of_plane(as_vec3(a), as_vec3(b), as_vec3(c), as_vec3(d));
        ASSERT_EQ(side, sign_of(truth)) << "case " << i;
        const double exact = volume(as_vec3(a), as_vec3(b), as_vec3(c), as_vec3(d));
        const auto truth_rounded = static_cast<double>(truth);
        ASSERT_LE(std::abs(exact - truth_rounded), 4e-16 * std::abs(truth_rounded));
        undecided += truth == 0 ? 1 : 0;
    }
    EXPECT_GT(undecided, 10'000);
}

TEST(Orientation, sides_of_edges_are_those_of_planes_through_them)
{
    Random random(66);
    int undecided = 0;
    for (int i = 0; i < 100'000; ++i)
    {
        const auto point = [&random]
        {
            const int bits = random.one_in(2) ? 2 : 30; // Small ones often touch.
            return GridPoint{whole(random, bits), whole(random, bits), whole(random, bits)};
        };
        const std::array<GridPoint, 5> points{point(), point(), point(), point(), point()};
        const Vec3 a = as_vec3(points[0]);
        const Vec3 b = as_vec3(points[1]);
        const auto sides =
            sides_of_edges(a, b, {as_vec3(points[2]), as_vec3(points[3]), as_vec3(points[4])});
        for (std::size_t edge = 0; edge < 3; ++edge)
        {
            const Integer truth =
                determinant(points[0], points[1], points[2 + edge], points[2 + (edge + 1) % 3]);
            ASSERT_EQ(sides[edge], sign_of(truth)) << "case " << i;
            undecided += truth == 0 ? 1 : 0;
        }
    }
    EXPECT_GT(undecided, 1'000);
}

/// Cancellation from none to all but a few bits: two nearly equal vectors, and a third nearly equal
/// to them.
TEST(Orientation, a_volume_is_right_however_much_cancels)
{
    Random random(65);
    std::array<int, 3> cases{}; // Cases with 10, 30 and more bits lost.
    for (int i = 0; i < 200'000; ++i)
    {
        const int beside = 1 + static_cast<int>(random.below(30));
        const auto point = [&random](int bits) -> GridPoint {
            return {whole(random, bits), whole(random, bits), whole(random, bits)};
        };
        const GridPoint a = point(30);
        const GridPoint u = point(30);
        const GridPoint v = point(beside);
        const GridPoint w = point(beside);
        const std::int64_t s = whole(random, 6);
        const std::int64_t t = whole(random, 6);
        GridPoint b{};
        GridPoint c{};
        GridPoint d{};
        double terms = 1.0; // Product of the lengths.
        for (std::size_t k = 0; k < 3; ++k)
        {
            b[k] = a[k] + u[k];
            c[k] = a[k] + s * u[k] + v[k];
            d[k] = a[k] + t * u[k] + w[k];
        }
        for (const GridPoint& end : {b, c, d})
        {
            terms *= (as_vec3(end) - as_vec3(a)).norm();
        }
        const auto truth = static_cast<double>(determinant(a, b, c, d));
        const double found = volume(as_vec3(a), as_vec3(b), as_vec3(c), as_vec3(d));
        ASSERT_LE(std::abs(found - truth), 4e-16 * std::abs(truth)) << "case " << i;
        const double left = std::abs(truth) / terms;
        cases[left > 0x1p-10 ? 0 : (left > 0x1p-30 ? 1 : 2)] += truth == 0.0 ? 0 : 1;
    }
    EXPECT_GT(cases[0], 5'000);
    EXPECT_GT(cases[1], 5'000);
    EXPECT_GT(cases[2], 5'000);
}

/// Differences that no double holds: one coordinate of 62 bits with small ones.
TEST(Orientation, side_of_plane_is_exact_when_differences_round)
{
    Random random(63);
    for (int i = 0; i < 200'000; ++i)
    {
        const auto point = [&random]() -> GridPoint
        {
            const int bits = random.one_in(2) ? 8 : 50;
            const std::int64_t x = whole(random, bits) * (bits == 50 ? 4096 : 1);
            return {x, whole(random, 4), whole(random, 4)};
        };
        const GridPoint a = point();
        const GridPoint b = point();
        const GridPoint c = point();
        const GridPoint d = point();
        ASSERT_EQ(side_of_plane(as_vec3(a), as_vec3(b), as_vec3(c), as_vec3(d)),
                  sign_of(determinant(a, b, c, d)))
            << "case " << i;
    }
}

TEST(Orientation, side_of_line_is_exact_where_floating_point_is_not)
{
    Random random(64);
    for (int i = 0; i < 200'000; ++i)
    {
        const std::int64_t x = whole(random, 52);
        const std::int64_t y = whole(random, 52);
        const std::int64_t u = whole(random, 44);
        const std::int64_t v = whole(random, 44);
        const std::int64_t factor = whole(random, 7);
        const std::int64_t beside = whole(random, 2);
        const std::int64_t w = factor * u;
        const std::int64_t z = factor * v + beside;
        const Integer truth = Integer{u} * z - Integer{v} * w;
        const auto at = [&](std::int64_t p, std::int64_t q) {
            return Vec2{static_cast<double>(x + p), static_cast<double>(y + q)};
        };
        ASSERT_EQ(side_of_line(at(0, 0), at(u, v), at(w, z)), sign_of(truth)) << "case " << i;
    }
}

} // namespace tactus::test
