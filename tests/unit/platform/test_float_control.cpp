// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/float_control.hpp"

#include <gtest/gtest.h>

#include <limits>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace tactus
{
namespace
{

TEST(FloatControl, finds_the_default_state_untouched)
{
    EXPECT_TRUE(reset_float_control());
    EXPECT_TRUE(reset_float_control());
}

TEST(FloatControl, does_not_take_raised_flags_for_a_change)
{
    volatile double zero = 0.0;
    volatile double infinite = 1.0 / zero;
    EXPECT_GT(infinite, 1.0);
    EXPECT_TRUE(reset_float_control());
}

#if defined(__x86_64__)
TEST(FloatControl, reports_and_mends_flushed_denormals)
{
    volatile float least = std::numeric_limits<float>::min();
    _mm_setcsr(_mm_getcsr() | 0x8040U); // FTZ and DAZ, as set by fast-maths start-up code.
    volatile float half = least / 2.0F;
    EXPECT_FALSE(half > 0.0F);
    EXPECT_FALSE(reset_float_control());
    half = least / 2.0F;
    EXPECT_TRUE(half > 0.0F);
    EXPECT_TRUE(reset_float_control());
}

TEST(FloatControl, reports_and_mends_another_rounding)
{
    _mm_setcsr(_mm_getcsr() | 0x6000U); // Rounding towards zero.
    EXPECT_FALSE(reset_float_control());
    volatile double third = 2.0;
    third = third / 3.0;
    EXPECT_EQ(third, 2.0 / 3.0);
}
#endif

} // namespace
} // namespace tactus
