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
/// digits), so a minute of cycles and one rare stall fit the same table.
///
/// Up to 2,047 ns each nanosecond has a counter; above, each octave has 1,024. All 224 KiB are
/// allocated and touched at construction; recording allocates nothing and costs a few nanoseconds
/// once its counters are in cache. What reads or adds all of them goes through 28,000. One thread.
class LatencyHistogram
{
public:
    static constexpr Duration kLongest = milliseconds(100'000);
    /// Counters of the first octave; a later one has half as many.
    static constexpr std::uint32_t kSubBuckets = 2'048;

    LatencyHistogram();

    /// Negative durations count as 0; those beyond kLongest share the last counter, but max() and
    /// mean_ns() stay true.
    void record(Duration duration) noexcept;

    /// The same with what a stall kept from being measured (coordinated omission): where one is
    /// due every `interval` (> 0) and one of them took longer, those that were due meanwhile waited
    /// for the rest of it, and each counts: v - interval, v - 2 interval, ... as long as something
    /// is left. Of a value beyond kLongest only those up to kLongest. Allocates, in time by the
    /// longest value over the interval; for once the measuring has ended. The interval is asserted.
    [[nodiscard]] LatencyHistogram corrected(Duration interval) const;

    /// Everything that the other has recorded, as well.
    void add(const LatencyHistogram& other) noexcept;

    /// How many values are at most this long; one up to 1/1024 longer may count as well.
    [[nodiscard]] std::uint64_t count_to(Duration longest) const noexcept;

    /// An upper bound, at most 1/1024 above, of the smallest recorded value that at least the
    /// fraction `q` of all values do not exceed; `q` is clamped to [0, 1]. Zero when empty.
    [[nodiscard]] Duration quantile(double q) const noexcept;

    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    [[nodiscard]] Duration max() const noexcept { return max_; }
    /// Zero when empty.
    [[nodiscard]] Duration min() const noexcept { return min_; }
    /// In nanoseconds, exact up to the last rounding; zero when empty.
    [[nodiscard]] double mean_ns() const noexcept;
    /// In nanoseconds, of all values and not of a sample of them; each is taken for the longest
    /// that shares its counter.
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
