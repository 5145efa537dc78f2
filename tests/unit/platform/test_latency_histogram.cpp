// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/latency_histogram.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace tactus
{

namespace
{

constexpr double kSteps = 1'024.0;

/// The value of that rank in sorted data, found without any histogram.
std::int64_t quantile_of_sorted(const std::vector<std::int64_t>& sorted, double q)
{
    const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(sorted.size())));
    return sorted[rank == 0 ? 0 : rank - 1];
}

TEST(LatencyHistogram, is_zero_when_empty)
{
    const LatencyHistogram sut;
    EXPECT_EQ(sut.count(), 0U);
    EXPECT_EQ(sut.quantile(0.5), Duration{});
    EXPECT_EQ(sut.max(), Duration{});
    EXPECT_EQ(sut.mean_ns(), 0.0);
}

TEST(LatencyHistogram, gives_one_value_back_at_every_quantile)
{
    LatencyHistogram sut;
    sut.record(nanoseconds(123'456'789));
    for (const double q : {-1.0, 0.0, 0.5, 1.0, 2.0})
    {
        EXPECT_EQ(sut.quantile(q), nanoseconds(123'456'789));
    }
    EXPECT_EQ(sut.mean_ns(), 123'456'789.0);
}

TEST(LatencyHistogram, is_exact_up_to_two_microseconds)
{
    for (std::int64_t ns = 0; ns < 2'048; ++ns)
    {
        LatencyHistogram sut;
        sut.record({ns});
        sut.record(milliseconds(1)); // So that the largest value does not hide the edge.
        EXPECT_EQ(sut.quantile(0.5), nanoseconds(ns));
    }
}

TEST(LatencyHistogram, keeps_three_digits_at_every_power_of_two_of_the_range)
{
    for (std::int64_t power = 1; power <= LatencyHistogram::kLongest.ns; power *= 2)
    {
        for (const std::int64_t ns : {power - 1, power, power + 1})
        {
            LatencyHistogram sut;
            sut.record({ns});
            sut.record(LatencyHistogram::kLongest);
            const std::int64_t found = sut.quantile(0.5).ns;
            EXPECT_GE(found, ns);
            EXPECT_LE(static_cast<double>(found - ns) * kSteps, static_cast<double>(ns));
        }
    }
}

TEST(LatencyHistogram, keeps_max_and_mean_true_beyond_the_range)
{
    LatencyHistogram sut;
    sut.record(nanoseconds(-5));
    sut.record(milliseconds(500'000));
    EXPECT_EQ(sut.max(), milliseconds(500'000));
    EXPECT_EQ(sut.quantile(0.5), Duration{});
    EXPECT_EQ(sut.quantile(1.0), milliseconds(500'000));
    EXPECT_EQ(sut.mean_ns(), 250e9);
}

TEST(LatencyHistogram, takes_a_quantile_that_is_not_a_number_for_the_least)
{
    LatencyHistogram sut;
    sut.record(nanoseconds(1));
    sut.record(nanoseconds(2));
    EXPECT_EQ(sut.quantile(std::numeric_limits<double>::quiet_NaN()), nanoseconds(1));
}

RC_GTEST_PROP(LatencyHistogram, agrees_with_sorted_data_to_three_digits, ())
{
    const auto octaves =
        *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 36)));
    std::vector<std::int64_t> values;
    for (const int octave : octaves)
    {
        const std::int64_t low = std::int64_t{1} << octave;
        values.push_back(*rc::gen::inRange<std::int64_t>(low, 2 * low));
    }
    LatencyHistogram sut;
    for (const std::int64_t value : values)
    {
        sut.record({value});
    }
    std::sort(values.begin(), values.end());
    for (const double q : {0.0, 0.5, 0.9, 0.99, 0.999, 1.0})
    {
        const std::int64_t exact = quantile_of_sorted(values, q);
        const std::int64_t found = sut.quantile(q).ns;
        RC_ASSERT(found >= exact);
        RC_ASSERT(static_cast<double>(found - exact) * kSteps <= static_cast<double>(exact));
    }
    const auto sum = std::accumulate(values.begin(), values.end(), std::int64_t{0});
    RC_ASSERT(sut.max().ns == values.back());
    RC_ASSERT(sut.count() == values.size());
    RC_ASSERT(sut.mean_ns() == static_cast<double>(sum) / static_cast<double>(values.size()));
}

} // namespace

} // namespace tactus
