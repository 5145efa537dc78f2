// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/latency_histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

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

/// The largest value that shares the counter.
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
    const Duration kept = std::max(duration, Duration{});
    const auto value = static_cast<std::uint64_t>(kept.ns);
    ++counters_[index_of(std::min(value, kLongestNs))];
    ++count_;
    sum_ns_ += value;
    max_ = std::max(max_, kept);
}

Duration LatencyHistogram::quantile(double q) const noexcept
{
    if (count_ == 0)
    {
        return {};
    }
    const double share = q > 0.0 ? std::min(q, 1.0) : 0.0; // Also when q is not a number.
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
    // The last counter holds everything beyond the range as well.
    const bool last = index + 1 == counters_.size();
    const auto edge = static_cast<std::int64_t>(upper_edge(index));
    return last ? max_ : std::min(max_, Duration{edge});
}

double LatencyHistogram::mean_ns() const noexcept
{
    return count_ == 0 ? 0.0 : static_cast<double>(sum_ns_) / static_cast<double>(count_);
}

} // namespace tactus
