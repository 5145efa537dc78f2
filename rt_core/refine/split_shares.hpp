// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/records/urgency.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace tactus
{

/// How one frame's splits are shared among the requests that wait for some.
///
/// The more urgent class takes what it can use, but for an eighth of all, rounded up, for each
/// class below in which somebody waits. Within a class everyone in turn may take an equal part of
/// what the class has left, and while there is enough for all what it saved before: a request that
/// needs little, in bursts, is not behind others that always need all. So with at least eight
/// splits a frame each of n requests of a class may take one in ceil(n / ceil(splits / 8)) frames,
/// whatever the others ask for, if those go first for which nothing was left longest
/// (docs/accuracy.md).
class SplitShares
{
public:
    explicit SplitShares(std::uint32_t splits) noexcept : splits_(splits) {}

    /// A request that waits, before the first take().
    void add(UrgencyClass of) noexcept { ++waiting_[static_cast<std::size_t>(of)]; }

    /// What one request may take.
    struct Share
    {
        std::uint32_t equal{0}; ///< Its part.
        std::uint32_t limit{0}; ///< With what it saved: splits that the frame may have done then.
    };

    /// The next request of a class, classes in order, which saved so many splits, in a frame that
    /// has `done` so many.
    [[nodiscard]] Share take(UrgencyClass of, std::uint32_t saved, std::uint32_t done) noexcept
    {
        const auto own = static_cast<std::size_t>(of);
        TACTUS_ASSERT(waiting_[own] > 0);
        const std::uint32_t left = splits_ - std::min(splits_, done);
        std::uint32_t kept = 0;
        for (std::size_t below = own + 1; below < kUrgencyClasses; ++below)
        {
            kept += waiting_[below] > 0 ? (splits_ + 7) / 8 : 0;
        }
        const std::uint32_t free = left - std::min(left, kept);
        const std::uint32_t equal = (free + waiting_[own] - 1) / waiting_[own];
        --waiting_[own];
        const std::uint32_t others = std::min(waiting_[own], free - equal); // One for each.
        return {equal, done + equal + std::min(saved, free - equal - others)};
    }

    /// What a request has saved after a frame in which it used so many. Half of a frame's splits at
    /// most, or it could hold up all others for long.
    [[nodiscard]] std::uint32_t save(std::uint32_t saved, std::uint32_t equal,
                                     std::uint32_t used) const noexcept
    {
        return std::min(saved + equal - std::min(saved + equal, used), splits_ / 2);
    }
    /// What one has saved that asked for none: it might have had an eighth.
    [[nodiscard]] std::uint32_t save_all(std::uint32_t saved) const noexcept
    {
        return save(saved, (splits_ + 7) / 8, 0);
    }

private:
    std::uint32_t splits_;
    std::array<std::uint32_t, kUrgencyClasses> waiting_{};
};

} // namespace tactus
