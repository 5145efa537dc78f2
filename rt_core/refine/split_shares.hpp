// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/records/priority.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace tactus
{

/// Shares one frame's splits among the requests that wait for some.
///
/// Classes take splits in order of priority, each as many as it can use, except an eighth of all,
/// rounded up, for each lower class with a waiting request. Within a class each request in turn may
/// take an equal part of what the class has left and, if there is enough for all, its savings from
/// earlier frames. So a request with short bursts is not behind others that always need everything.
///
/// With at least eight splits a frame, each of n requests of a class may take one in ceil(n /
/// ceil(splits / 8)) frames, independent of the others' needs, if requests that got nothing for
/// longest go first (docs/internals/proofs.md).
class SplitShares
{
public:
    explicit SplitShares(std::uint32_t splits) noexcept : splits_(splits) {}

    /// Adds a waiting request, before the first take().
    void add(PriorityClass of) noexcept { ++waiting_[static_cast<std::size_t>(of)]; }

    /// Splits that one request may take.
    struct Share
    {
        std::uint32_t equal{0}; ///< Equal part of the class's splits.
        /// Upper limit on the frame's total splits, including the request's savings.
        std::uint32_t limit{0};
    };

    /// Share of the next waiting request of class `of`; calls go through the classes in order.
    /// `saved` are the request's savings, and `done` is the frame's number of splits so far.
    [[nodiscard]] Share take(PriorityClass of, std::uint32_t saved, std::uint32_t done) noexcept
    {
        const auto own = static_cast<std::size_t>(of);
        TACTUS_ASSERT(waiting_[own] > 0);
        const std::uint32_t left = splits_ - std::min(splits_, done);
        std::uint32_t kept = 0;
        for (std::size_t below = own + 1; below < kPriorityClasses; ++below)
        {
            kept += waiting_[below] > 0 ? (splits_ + 7) / 8 : 0;
        }
        const std::uint32_t free = left - std::min(left, kept);
        const std::uint32_t equal = (free + waiting_[own] - 1) / waiting_[own];
        --waiting_[own];
        const std::uint32_t others = std::min(waiting_[own], free - equal); // One for each of them.
        return {equal, done + equal + std::min(saved, free - equal - others)};
    }

    /// Savings of a request after a frame in which it had a share of `equal` splits and used
    /// `used`. At most half of a frame's splits, or it could delay all others for long.
    [[nodiscard]] std::uint32_t save(std::uint32_t saved, std::uint32_t equal,
                                     std::uint32_t used) const noexcept
    {
        return std::min(saved + equal - std::min(saved + equal, used), splits_ / 2);
    }
    /// Savings of a request after a frame in which it needed no split: an eighth of a frame's
    /// splits more.
    [[nodiscard]] std::uint32_t save_all(std::uint32_t saved) const noexcept
    {
        return save(saved, (splits_ + 7) / 8, 0);
    }

private:
    std::uint32_t splits_;
    std::array<std::uint32_t, kPriorityClasses> waiting_{};
};

} // namespace tactus
