// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/latency_histogram.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace tactus
{

// A value of b significant bits keeps its 11 leading ones: octave o = b - 11 (0 for small values)
// and sub = value >> o. In octave 0 sub runs over 0..2047; in every later octave its top bit is
// set, so 1024 counters are enough and the index is o * 1024 + sub:
//
//     0 ......... 2047 | 2048 .. 3071 | 3072 .. 4095 | ...     index
//     0 ..... 2047 ns  | to 4095 ns   | to 8191 ns   | ...     value
namespace
{

constexpr unsigned kSubBits = 10;
static_assert(LatencyHistogram::kSubBuckets == 2U << kSubBits);

constexpr unsigned octave_of(std::uint64_t value) noexcept
{
    const auto bits = static_cast<unsigned>(std::bit_width(value));
    return bits > kSubBits + 1 ? bits - (kSubBits + 1) : 0;
}

constexpr std::size_t index_of(std::uint64_t value) noexcept
{
    const unsigned octave = octave_of(value);
    return (std::size_t{octave} << kSubBits) + static_cast<std::size_t>(value >> octave);
}

/// Largest value that this counter counts.
constexpr std::uint64_t upper_edge(std::size_t index) noexcept
{
    const std::size_t octave = index < (2U << kSubBits) ? 0 : (index >> kSubBits) - 1;
    const std::uint64_t sub = index - (octave << kSubBits);
    return ((sub + 1) << octave) - 1;
}

constexpr std::uint64_t kLongestNs = static_cast<std::uint64_t>(LatencyHistogram::kLongest.ns);
static_assert(upper_edge(index_of(2'047)) == 2'047 && upper_edge(index_of(2'048)) == 2'049);
static_assert(upper_edge(index_of(kLongestNs)) >= kLongestNs);

} // namespace

LatencyHistogram::LatencyHistogram() : counters_(index_of(kLongestNs) + 1, 0) {}

void LatencyHistogram::record(Duration duration) noexcept
{
    record(duration, 1);
}

void LatencyHistogram::record(Duration duration, std::uint64_t times) noexcept
{
    const Duration kept = std::max(duration, Duration{});
    const auto value = static_cast<std::uint64_t>(kept.ns);
    counters_[index_of(std::min(value, kLongestNs))] += times;
    min_ = count_ == 0 ? kept : std::min(min_, kept);
    max_ = std::max(max_, kept);
    count_ += times;
    sum_ns_ += value * times;
}

/// Longest value in a counter; the last counter also holds all values beyond the range.
Duration LatencyHistogram::longest_of(std::size_t index) const noexcept
{
    const bool is_last = index + 1 == counters_.size();
    return is_last ? max_ : std::min(max_, Duration{static_cast<std::int64_t>(upper_edge(index))});
}

LatencyHistogram LatencyHistogram::corrected(Duration interval) const
{
    TACTUS_ASSERT(interval.ns > 0);
    LatencyHistogram all = *this;
    for (std::size_t i = index_of(static_cast<std::uint64_t>(interval.ns)); i < counters_.size();
         ++i)
    {
        // The counter's shortest value, so that a value of whole intervals leaves no rest.
        const std::int64_t shortest =
            counters_[i] > 0 ? static_cast<std::int64_t>(upper_edge(i - 1)) + 1 : 0;
        for (std::int64_t left = shortest - interval.ns; left > 0; left -= interval.ns)
        {
            all.record({left}, counters_[i]);
        }
    }
    return all;
}

void LatencyHistogram::add(const LatencyHistogram& other) noexcept
{
    if (other.count_ == 0)
    {
        return;
    }
    for (std::size_t i = 0; i < counters_.size(); ++i)
    {
        counters_[i] += other.counters_[i];
    }
    min_ = count_ == 0 ? other.min_ : std::min(min_, other.min_);
    max_ = std::max(max_, other.max_);
    count_ += other.count_;
    sum_ns_ += other.sum_ns_;
}

std::uint64_t LatencyHistogram::count_to(Duration longest) const noexcept
{
    if (longest.ns < 0)
    {
        return 0;
    }
    if (longest >= max_)
    {
        return count_;
    }
    const std::size_t end = index_of(std::min(static_cast<std::uint64_t>(longest.ns), kLongestNs));
    return std::accumulate(counters_.begin(), counters_.begin() + std::ptrdiff_t(end + 1),
                           std::uint64_t{0});
}

Duration LatencyHistogram::quantile(double q) const noexcept
{
    if (count_ == 0)
    {
        return {};
    }
    const double share = q > 0.0 ? std::min(q, 1.0) : 0.0; // NaN counts as 0.
    const double wanted = std::ceil(share * static_cast<double>(count_));
    const std::uint64_t rank =
        std::clamp(static_cast<std::uint64_t>(wanted), std::uint64_t{1}, count_);
    std::uint64_t seen = 0;
    std::size_t index = 0;
    while (seen + counters_[index] < rank)
    {
        seen += counters_[index];
        ++index;
    }
    return longest_of(index);
}

double LatencyHistogram::mean_ns() const noexcept
{
    return count_ == 0 ? 0.0 : static_cast<double>(sum_ns_) / static_cast<double>(count_);
}

double LatencyHistogram::standard_deviation_ns() const noexcept
{
    const double mean = mean_ns();
    double sum = 0.0;
    for (std::size_t i = 0; i < counters_.size(); ++i)
    {
        const double away = static_cast<double>(longest_of(i).ns) - mean;
        sum += static_cast<double>(counters_[i]) * away * away;
    }
    return count_ == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(count_));
}

} // namespace tactus
