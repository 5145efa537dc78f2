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

/// Measures the wait of one request for a piece. The request becomes overdue at its first
/// repetition after a second in which a server was present and the piece did not arrive. Times are
/// in ns.
class RequestClock
{
public:
    static constexpr std::int64_t kOverdue_ns = 1'000'000'000;

    RequestClock() = default;
    explicit RequestClock(std::int64_t now_ns)
        : opened_ns_(now_ns), requested_ns_(now_ns), hosted_ns_(now_ns)
    {
    }

    /// Records a repetition; true if the request becomes overdue by it, once. After a pause of more
    /// than `forgotten_ns` since the last repetition the second begins again.
    [[nodiscard]] bool request(std::int64_t now_ns, std::int64_t forgotten_ns)
    {
        if (now_ns - requested_ns_ > forgotten_ns)
        {
            hosted_ns_ = now_ns;
        }
        requested_ns_ = now_ns;
        const bool runs_out = !is_overdue_ && now_ns - hosted_ns_ >= kOverdue_ns;
        is_overdue_ = is_overdue_ || runs_out;
        return runs_out;
    }
    /// Records that no server is present: the second begins again.
    void wait_for_server(std::int64_t now_ns) { hosted_ns_ = now_ns; }

    [[nodiscard]] bool is_overdue() const { return is_overdue_; }
    /// True if the request is overdue and was repeated within the last `forgotten_ns`, so still
    /// wanted.
    [[nodiscard]] bool is_missed(std::int64_t now_ns, std::int64_t forgotten_ns) const
    {
        return is_overdue_ && now_ns - requested_ns_ <= forgotten_ns;
    }
    [[nodiscard]] std::int64_t waited_ns(std::int64_t now_ns) const { return now_ns - opened_ns_; }

private:
    std::int64_t opened_ns_{0};
    std::int64_t requested_ns_{0}; ///< Time of the first request or of the last repetition.
    /// Start of the second after which a repetition makes the request overdue.
    std::int64_t hosted_ns_{0};
    bool is_overdue_{false};
};

} // namespace tactus
