// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/axis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <random>

namespace tactus::plot::test
{

namespace
{

std::vector<std::string> texts_of(const Axis& axis, std::size_t most)
{
    std::vector<std::string> texts;
    std::ranges::transform(axis.ticks(most), std::back_inserter(texts), &Tick::text);
    return texts;
}

TEST(Axis, even_ends_are_round_and_hold_zero)
{
    const Axis sut = Axis::linear(3.0, 17.0);
    EXPECT_EQ(sut.share(0.0), 0.0);
    EXPECT_NEAR(sut.share(20.0), 1.0, 1e-12);
    EXPECT_NEAR(sut.share(10.0), 0.5, 1e-12);
    EXPECT_EQ(texts_of(sut, 5), (std::vector<std::string>{"0", "5", "10", "15", "20"}));
}

TEST(Axis, values_below_zero_have_room)
{
    const Axis sut = Axis::linear(-4.0, 6.0);
    EXPECT_EQ(sut.share(-4.0), 0.0);
    EXPECT_EQ(sut.share(6.0), 1.0);
    EXPECT_EQ(texts_of(sut, 5), (std::vector<std::string>{"-4", "-2", "0", "2", "4", "6"}));
}

TEST(Axis, a_few_decades_are_marked_at_two_and_five)
{
    const Axis sut = Axis::logarithmic(0.03, 0.7);
    EXPECT_EQ(texts_of(sut, 9),
              (std::vector<std::string>{"0.02", "0.05", "0.1", "0.2", "0.5", "1"}));
    EXPECT_NEAR(sut.share(0.2) - sut.share(0.1), sut.share(0.1) - sut.share(0.05), 1e-12);
}

TEST(Axis, many_decades_are_marked_at_some)
{
    const Axis sut = Axis::logarithmic(1e-6, 1e6);
    EXPECT_EQ(texts_of(sut, 6), (std::vector<std::string>{"10\u207B\u2076", "0.0001", "0.01", "1",
                                                          "100", "10\u2009000", "10\u2076"}));
}

TEST(Axis, zero_has_a_column_before_the_logarithm)
{
    const Axis sut = Axis::fitted({0.0, 1e-3, 1e-1}, true);
    EXPECT_GT(sut.zero_share(), 0.0);
    EXPECT_GT(sut.share(0.0), 0.0);
    EXPECT_LT(sut.share(0.0), sut.zero_share());
    EXPECT_GE(sut.share(1e-3), sut.zero_share());
    EXPECT_EQ(sut.share(1e-1), 1.0);
    EXPECT_EQ(texts_of(sut, 9).front(), "0");
    EXPECT_TRUE(sut.can_show(0.0));
}

TEST(Axis, without_zeros_there_is_no_such_column)
{
    const Axis sut = Axis::fitted({1e-3, 1e-1}, true);
    EXPECT_EQ(sut.zero_share(), 0.0);
    EXPECT_FALSE(sut.can_show(0.0));
    EXPECT_EQ(sut.share(1e-3), 0.0);
}

TEST(Axis, shows_no_value_that_has_no_place)
{
    const double infinity = std::numeric_limits<double>::infinity();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> values{2.0, infinity, nan, -3.0, -infinity, 4.0};
    const Axis logarithmic = Axis::fitted(values, true);
    const Axis even = Axis::fitted(values, false);
    for (const double value : {infinity, nan, -infinity})
    {
        EXPECT_FALSE(logarithmic.can_show(value));
        EXPECT_FALSE(even.can_show(value));
    }
    EXPECT_FALSE(logarithmic.can_show(-3.0));
    EXPECT_TRUE(even.can_show(-3.0));
    EXPECT_EQ(logarithmic.share(2.0), 0.0);
    EXPECT_LT(logarithmic.share(4.0), 1.0 + 1e-12);
}

TEST(Axis, one_value_and_none_at_all_make_an_axis_too)
{
    for (const std::vector<double>& values : {std::vector<double>{}, {0.0}, {7.0}, {0.0, 7.0}})
    {
        for (const bool is_logarithmic : {false, true})
        {
            const Axis sut = Axis::fitted(values, is_logarithmic);
            EXPECT_GE(sut.ticks(5).size(), 2U);
            for (const double value : values)
            {
                EXPECT_TRUE(sut.can_show(value));
                EXPECT_GE(sut.share(value), 0.0);
                EXPECT_LE(sut.share(value), 1.0);
            }
        }
    }
}

TEST(Axis, ticks_rise_and_lie_where_their_values_do)
{
    constexpr unsigned kSeed = 20'261'122;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> exponent(-9.0, 9.0);
    for (int i = 0; i < 2'000; ++i)
    {
        const double a = std::pow(10.0, exponent(random));
        const double b = std::pow(10.0, exponent(random));
        for (const bool is_logarithmic : {false, true})
        {
            const Axis sut = Axis::fitted({a, b}, is_logarithmic);
            const std::vector<Tick> ticks = sut.ticks(6);
            ASSERT_GE(ticks.size(), 2U) << a << ' ' << b;
            ASSERT_LE(ticks.size(), 13U) << a << ' ' << b;
            ASSERT_TRUE(std::ranges::is_sorted(ticks, {}, &Tick::share)) << a << ' ' << b;
            ASSERT_LT(sut.share(std::min(a, b)), sut.share(std::max(a, b)) + 1e-12);
            ASSERT_GE(ticks.front().share, 0.0);
            ASSERT_LE(ticks.back().share, 1.0);
        }
    }
}

TEST(NumberText, is_short_and_true)
{
    EXPECT_EQ(number_text(0.0), "0");
    EXPECT_EQ(number_text(12.0), "12");
    EXPECT_EQ(number_text(12.5), "12.5");
    EXPECT_EQ(number_text(1'234.0), "1\u2009234");
    EXPECT_EQ(number_text(-1'234.0), "-1\u2009234");
    EXPECT_EQ(number_text(0.25), "0.25");
    EXPECT_EQ(number_text(1e-4), "0.0001");
    EXPECT_EQ(number_text(9.9999e4), "99\u2009999");
    EXPECT_EQ(number_text(1e6), "10\u2076");
    EXPECT_EQ(number_text(-1e6), "-10\u2076");
    EXPECT_EQ(number_text(2.5e-6), "2.5\u00D710\u207B\u2076");
    EXPECT_EQ(number_text(9.9999e-6), "10\u207B\u2075");
    EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "none");
}

} // namespace

} // namespace tactus::plot::test
