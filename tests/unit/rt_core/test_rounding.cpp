// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/math/rounding.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tactus::test
{

namespace
{

constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

/// Random finite float, uniform over bit patterns.
float any_float(Random& random)
{
    for (;;)
    {
        const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random.bits()));
        if (std::isfinite(value))
        {
            return value;
        }
    }
}

const std::vector<float>& special_floats()
{
    static const std::vector<float> values{0.0F,
                                           -0.0F,
                                           1.0F,
                                           -1.0F,
                                           std::numeric_limits<float>::denorm_min(),
                                           -std::numeric_limits<float>::denorm_min(),
                                           std::numeric_limits<float>::min(),
                                           -std::numeric_limits<float>::min(),
                                           std::numeric_limits<float>::max(),
                                           std::numeric_limits<float>::lowest()};
    return values;
}

void expect_next(float value)
{
    ASSERT_EQ(next_up(value), std::nextafter(value, kFloatInfinity)) << value;
}

/// Expects rounded values that are neighbours of the double on the right sides.
void expect_rounded(double value)
{
    const float up = round_up_to_float(value);
    const float down = round_down_to_float(value);
    ASSERT_GE(static_cast<double>(up), value) << value;
    ASSERT_LE(static_cast<double>(down), value) << value;
    ASSERT_LT(static_cast<double>(std::nextafter(up, -kFloatInfinity)), value) << value;
    ASSERT_GT(static_cast<double>(std::nextafter(down, kFloatInfinity)), value) << value;
}

} // namespace

TEST(Rounding, next_up_and_down_are_the_librarys_over_random_bit_patterns)
{
    Random random(10);
    for (const float value : special_floats())
    {
        expect_next(value);
    }
    for (int i = 0; i < 300'000; ++i)
    {
        ASSERT_NO_FATAL_FAILURE(expect_next(any_float(random)));
    }
}

TEST(Rounding, a_double_is_rounded_to_its_neighbour_on_the_asked_side)
{
    Random random(11);
    for (int i = 0; i < 300'000; ++i)
    {
        const double mantissa = random.between(-1.0, 1.0);
        const double value = std::ldexp(mantissa, static_cast<int>(random.below(270)) - 145);
        ASSERT_NO_FATAL_FAILURE(expect_rounded(value));
    }
    for (const double value : {1e-300, -1e-300, 5e-324, -5e-324, 1.0 + 1e-16, 1.0 - 1e-16})
    {
        expect_rounded(value);
    }
}

TEST(Rounding, a_float_stays_itself)
{
    Random random(12);
    for (const float value : special_floats())
    {
        EXPECT_EQ(round_up_to_float(static_cast<double>(value)), value);
        EXPECT_EQ(round_down_to_float(static_cast<double>(value)), value);
    }
    for (int i = 0; i < 100'000; ++i)
    {
        const float value = any_float(random);
        ASSERT_EQ(round_up_to_float(static_cast<double>(value)), value);
        ASSERT_EQ(round_down_to_float(static_cast<double>(value)), value);
    }
}

} // namespace tactus::test
