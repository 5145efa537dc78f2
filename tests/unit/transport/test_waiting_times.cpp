// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/waiting_times.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{

namespace
{

constexpr std::int64_t kMillisecond_ns = 1'000'000;

} // namespace

TEST(WaitingTimes, without_any_everything_is_zero)
{
    const WaitingTimes sut;
    EXPECT_EQ(sut.total(), 0U);
    EXPECT_EQ(sut.quantile_ms(0.5), 0.0);
    EXPECT_EQ(sut.longest_ms(), 0.0);
}

TEST(WaitingTimes, a_quantile_is_at_most_a_step_above_the_truth)
{
    WaitingTimes sut;
    for (int i = 1; i <= 100; ++i)
    {
        sut.add(i * kMillisecond_ns);
    }
    EXPECT_GE(sut.quantile_ms(0.5), 50.0);
    EXPECT_LE(sut.quantile_ms(0.5), 50.25);
    EXPECT_GE(sut.quantile_ms(0.99), 99.0);
    EXPECT_LE(sut.quantile_ms(0.99), 99.25);
    EXPECT_EQ(sut.quantile_ms(1.0), 100.0) << "no more than the longest";
    EXPECT_EQ(sut.total(), 100U);
}

TEST(WaitingTimes, beyond_the_steps_the_longest_stands_for_all)
{
    WaitingTimes sut;
    sut.add(2'000 * kMillisecond_ns);
    sut.add(700 * kMillisecond_ns);
    EXPECT_EQ(sut.quantile_ms(0.5), 2'000.0);
    EXPECT_EQ(sut.longest_ms(), 2'000.0);
}

TEST(WaitingTimes, a_clock_that_stepped_back_counts_as_no_time)
{
    WaitingTimes sut;
    sut.add(-5);
    EXPECT_EQ(sut.total(), 1U);
    EXPECT_EQ(sut.longest_ms(), 0.0);
}

TEST(WaitingTimes, those_of_two_models_add_up)
{
    WaitingTimes sut;
    sut.add(kMillisecond_ns);
    WaitingTimes other;
    other.add(9 * kMillisecond_ns);

    sut += other;

    EXPECT_EQ(sut.total(), 2U);
    EXPECT_EQ(sut.sum_ns(), 10 * kMillisecond_ns);
    EXPECT_EQ(sut.quantile_ms(1.0), 9.0);
    EXPECT_LE(sut.quantile_ms(0.5), 1.25);
}

} // namespace tactus::test
