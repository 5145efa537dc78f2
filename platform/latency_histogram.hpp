// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/time.hpp"

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
/// once its counters are in cache. One thread.
class LatencyHistogram
{
public:
    static constexpr Duration kLongest = milliseconds(100'000);

    LatencyHistogram();

    /// Negative durations count as 0; those beyond kLongest share the last counter, but max() and
    /// mean() stay true.
    void record(Duration duration) noexcept;

    /// An upper bound, at most 1/1024 above, of the smallest recorded value that at least the
    /// fraction `q` of all values do not exceed; `q` is clamped to [0, 1]. Zero when empty.
    [[nodiscard]] Duration quantile(double q) const noexcept;

    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    [[nodiscard]] Duration max() const noexcept { return max_; }
    /// In nanoseconds, exact up to the last rounding; zero when empty.
    [[nodiscard]] double mean_ns() const noexcept;

private:
    std::vector<std::uint64_t> counters_;
    std::uint64_t count_{0};
    std::uint64_t sum_ns_{0};
    Duration max_{};
};

} // namespace tactus
