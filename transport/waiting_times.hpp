// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace tactus
{

/// Histogram of the waiting times of pieces in steps of 0.25 ms up to 512 ms, and the longest time.
/// 16 KiB, no allocation. One thread.
class WaitingTimes
{
public:
    void add(std::int64_t waited_ns) noexcept
    {
        const std::int64_t waited = std::max<std::int64_t>(waited_ns, 0);
        const auto step = static_cast<std::size_t>(waited / kStep_ns);
        ++counts_[std::min(step, counts_.size() - 1)];
        ++total_;
        sum_ns_ += waited;
        longest_ns_ = std::max(longest_ns_, waited);
    }

    /// Upper end, in ms, of the first step up to which the histogram has at least `share` (0 to 1)
    /// of all times. 0 without times; the longest time if that step is the last.
    [[nodiscard]] double quantile_ms(double share) const noexcept
    {
        const auto enough =
            static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(total_)));
        std::uint64_t sum = 0;
        for (std::size_t step = 0; step + 1 < counts_.size(); ++step)
        {
            sum += counts_[step];
            if (sum >= enough && sum > 0)
            {
                const auto end_ns = static_cast<std::int64_t>(step + 1) * kStep_ns;
                return static_cast<double>(std::min(end_ns, longest_ns_)) * 1e-6;
            }
        }
        return longest_ms();
    }
    [[nodiscard]] double longest_ms() const noexcept
    {
        return static_cast<double>(longest_ns_) * 1e-6;
    }
    [[nodiscard]] std::uint64_t total() const noexcept { return total_; }
    [[nodiscard]] std::int64_t sum_ns() const noexcept { return sum_ns_; }

    WaitingTimes& operator+=(const WaitingTimes& other) noexcept
    {
        std::ranges::transform(counts_, other.counts_, counts_.begin(), std::plus<>());
        total_ += other.total_;
        sum_ns_ += other.sum_ns_;
        longest_ns_ = std::max(longest_ns_, other.longest_ns_);
        return *this;
    }

private:
    static constexpr std::int64_t kStep_ns = 250'000;

    /// Number of times in each step; the last step has all longer times.
    std::array<std::uint64_t, 2'049> counts_{};
    std::uint64_t total_{0};
    std::int64_t sum_ns_{0};
    std::int64_t longest_ns_{0};
};

} // namespace tactus
