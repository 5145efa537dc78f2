// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus
{

/// Counts durations from 1 ns to 100 s in steps of at most 1/1024 of the value (three significant
/// digits). So a minute of cycles and one rare stall fit the same table.
///
/// Up to 2,047 ns each nanosecond has a counter; above, each octave has 1,024. All 224 KiB are
/// allocated and touched at construction; recording allocates nothing and costs a few nanoseconds
/// with its counters in cache. Functions of all counters visit 28,000. One thread.
class LatencyHistogram
{
public:
    static constexpr Duration kLongest = milliseconds(100'000);
    /// Counters of the first octave; a later one has half as many.
    static constexpr std::uint32_t kSubBuckets = 2'048;

    LatencyHistogram();

    /// Counts a duration. Negative ones count as 0; those beyond kLongest share the last counter,
    /// but max() and mean_ns() stay true.
    void record(Duration duration) noexcept;

    /// Returns a histogram that includes the values which a stall kept from being measured
    /// (coordinated omission). For each value v, it adds v - interval, v - 2 interval, ... > 0: the
    /// waits of values that were due meanwhile, one each `interval` (> 0, asserted). A value beyond
    /// kLongest adds only those up to kLongest. Allocates, and takes time in proportion to the
    /// longest value over the interval; call after measuring.
    [[nodiscard]] LatencyHistogram corrected(Duration interval) const;

    /// Adds all values of `other`.
    void add(const LatencyHistogram& other) noexcept;

    /// Number of values up to `longest`; values up to 1/1024 longer may be included.
    [[nodiscard]] std::uint64_t count_to(Duration longest) const noexcept;

    /// Upper bound, at most 1/1024 too high, of the quantile `q`: the smallest recorded value v
    /// such that at least the fraction `q` of all values is at most v. `q` is clamped to [0, 1].
    /// Zero if empty.
    [[nodiscard]] Duration quantile(double q) const noexcept;

    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    [[nodiscard]] Duration max() const noexcept { return max_; }
    /// Smallest value; zero if empty.
    [[nodiscard]] Duration min() const noexcept { return min_; }
    /// Mean in nanoseconds, exact up to the last rounding; zero if empty.
    [[nodiscard]] double mean_ns() const noexcept;
    /// Population standard deviation in nanoseconds; each value counts as the longest that shares
    /// its counter.
    [[nodiscard]] double standard_deviation_ns() const noexcept;

private:
    void record(Duration duration, std::uint64_t times) noexcept;
    [[nodiscard]] Duration longest_of(std::size_t index) const noexcept;

    std::vector<std::uint64_t> counters_;
    std::uint64_t count_{0};
    std::uint64_t sum_ns_{0};
    Duration min_{};
    Duration max_{};
};

} // namespace tactus
