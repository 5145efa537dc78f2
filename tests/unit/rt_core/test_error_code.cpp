// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/error_code.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::test
{

TEST(ErrorCode, zero_is_exact_and_each_other_stands_for_a_power_of_two_rounded_up_by_little)
{
    EXPECT_EQ(error_in_quanta(0), 0.0F);
    EXPECT_EQ(error_in_quanta(1), 1.0F / 256.0F);
    for (unsigned code = 1; code < 256; ++code)
    {
        const float stored = error_in_quanta(static_cast<ErrorCode>(code));
        const long double exact = std::exp2((static_cast<long double>(code) - 1.0L) / 4.0L - 8.0L);
        EXPECT_GE(static_cast<long double>(stored), exact * (1.0L - 1e-17L)) << code;
        EXPECT_LE(static_cast<long double>(stored), exact * (1.0L + 4e-7L)) << code;
        EXPECT_GT(stored, error_in_quanta(static_cast<ErrorCode>(code - 1))) << code;
        EXPECT_EQ(encode_error(static_cast<double>(stored)), code);
    }
}

TEST(ErrorCode, encoding_never_rounds_down_and_is_the_least_code)
{
    Random random(4);
    for (int i = 0; i < 100'000; ++i)
    {
        const double quanta = std::exp2(random.between(-20.0, 55.0));
        const ErrorCode code = encode_error(quanta);
        ASSERT_GE(code, 1) << i;
        ASSERT_GE(static_cast<double>(error_in_quanta(code)), quanta) << i;
        if (code > 1)
        {
            ASSERT_LT(static_cast<double>(error_in_quanta(static_cast<ErrorCode>(code - 1))),
                      quanta)
                << i;
        }
    }
}

TEST(ErrorCode, the_largest_code_within_a_bound_is_the_last_that_is_not_above_it)
{
    EXPECT_EQ(largest_code_within(0.0), 0);
    EXPECT_EQ(largest_code_within(std::nextafter(1.0 / 256.0, 0.0)), 0);
    EXPECT_EQ(largest_code_within(1.0 / 256.0), 1);
    EXPECT_EQ(largest_code_within(1e300), 255);
    for (std::uint32_t code = 1; code < 255; ++code)
    {
        const auto bound = static_cast<double>(error_in_quanta(static_cast<ErrorCode>(code)));
        EXPECT_EQ(largest_code_within(bound), code);
        EXPECT_EQ(largest_code_within(std::nextafter(bound, 0.0)), code - 1);
    }
}

TEST(ErrorCode, encoding_never_calls_a_face_exact)
{
    EXPECT_EQ(encode_error(0.0), 1);
    EXPECT_EQ(encode_error(1e-300), 1);
    EXPECT_EQ(encode_error(1.0 / 256.0), 1);
    EXPECT_EQ(encode_error(std::nextafter(1.0 / 256.0, 1.0)), 2);
}

TEST(ErrorCode, the_last_code_holds_the_largest_model)
{
    EXPECT_GT(static_cast<double>(error_in_quanta(255)), std::sqrt(3.0) * std::exp2(24.0));
    EXPECT_EQ(encode_error(1e300), 255);
}

} // namespace tactus::test
