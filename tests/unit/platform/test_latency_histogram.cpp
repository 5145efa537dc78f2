// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/latency_histogram.hpp"

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

/// Value of that rank in sorted data, without a histogram.
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
        sut.record(milliseconds(1)); // Otherwise the largest value would hide the edge.
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

TEST(LatencyHistogram, counts_what_a_stall_kept_from_being_measured)
{
    LatencyHistogram sut;
    sut.record(microseconds(10));
    sut.record(microseconds(3'500)); // Three more would have begun at 1, 2 and 3 ms of it.
    sut.record(microseconds(1'000)); // The next one begins in time.
    const LatencyHistogram corrected = sut.corrected(milliseconds(1));
    EXPECT_EQ(corrected.count(), 6U);
    EXPECT_EQ(corrected.count_to(microseconds(490)), 1U);
    EXPECT_EQ(corrected.count_to(microseconds(510)), 2U);
    EXPECT_EQ(corrected.count_to(microseconds(1'010)), 3U);
    EXPECT_EQ(corrected.count_to(microseconds(1'510)), 4U);
    EXPECT_EQ(corrected.count_to(microseconds(2'510)), 5U);
    EXPECT_EQ(corrected.min(), microseconds(10));
    EXPECT_EQ(corrected.max(), microseconds(3'500));
    EXPECT_EQ(sut.count(), 3U);
}

TEST(LatencyHistogram, has_nothing_to_correct_when_nothing_was_late)
{
    LatencyHistogram sut;
    EXPECT_EQ(sut.corrected(milliseconds(1)).count(), 0U);
    sut.record({});
    sut.record(milliseconds(1));
    EXPECT_EQ(sut.corrected(milliseconds(1)).count(), 2U);
}

TEST(LatencyHistogram, corrects_a_value_beyond_its_range_as_one_at_its_end)
{
    LatencyHistogram sut;
    sut.record(LatencyHistogram::kLongest * 10);
    const LatencyHistogram corrected = sut.corrected(milliseconds(10'000));
    EXPECT_EQ(corrected.count(), 10U);
    EXPECT_EQ(corrected.max(), LatencyHistogram::kLongest * 10);
}

TEST(LatencyHistogram, takes_over_all_that_another_has_recorded)
{
    LatencyHistogram sut;
    LatencyHistogram other;
    other.record(microseconds(7));
    other.record(microseconds(70));
    sut.add(LatencyHistogram{});
    EXPECT_EQ(sut.count(), 0U);
    sut.add(other);
    EXPECT_EQ(sut.min(), microseconds(7)); // Not the zero of an empty one.
    sut.record(microseconds(1));
    sut.add(other);
    EXPECT_EQ(sut.count(), 5U);
    EXPECT_EQ(sut.min(), microseconds(1));
    EXPECT_EQ(sut.max(), microseconds(70));
    EXPECT_EQ(sut.mean_ns(), 31e3);
}

TEST(LatencyHistogram, counts_up_to_any_length)
{
    LatencyHistogram sut;
    EXPECT_EQ(sut.count_to(LatencyHistogram::kLongest), 0U);
    for (const std::int64_t us : {1, 1, 5, 500'000'000})
    {
        sut.record(microseconds(us));
    }
    EXPECT_EQ(sut.count_to(nanoseconds(-1)), 0U);
    EXPECT_EQ(sut.count_to(nanoseconds(999)), 0U);
    EXPECT_EQ(sut.count_to(microseconds(1)), 2U);
    EXPECT_EQ(sut.count_to(microseconds(6)), 3U);
    EXPECT_EQ(sut.count_to(microseconds(500'000'000)), 4U);
    EXPECT_EQ(sut.min(), microseconds(1));
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
