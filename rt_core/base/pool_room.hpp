// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <cstdint>

namespace tactus
{

/// What one owner has of a pool, in slots.
struct PoolShare
{
    std::uint32_t promised{0}; ///< Kept for it, whatever others need.
    std::uint32_t used{0};
};

/// Counts the slots of a pool with several owners. To each some are promised, which nobody else can
/// take; the rest is for whoever needs it. An owner that is alone has all of them.
class PoolRoom
{
public:
    explicit PoolRoom(std::uint32_t capacity) noexcept : capacity_(capacity), free_(capacity) {}

    /// Promises a new owner `slots`, or as many as are neither taken nor promised.
    [[nodiscard]] PoolShare promise(std::uint32_t slots) noexcept
    {
        const std::int64_t left = std::max<std::int64_t>(free_ - kept_, 0);
        const PoolShare share{std::min(slots, static_cast<std::uint32_t>(left)), 0};
        kept_ += share.promised;
        return share;
    }
    /// Promises all of `slots` to an owner that has nothing so far. False, with nothing changed,
    /// where fewer are neither taken nor promised.
    [[nodiscard]] bool try_promise(PoolShare& share, std::uint32_t slots) noexcept
    {
        TACTUS_ASSERT(share.promised == 0);
        TACTUS_ASSERT(share.used == 0);
        if (free_ - kept_ < slots)
        {
            return false;
        }
        share.promised = slots;
        kept_ += slots;
        return true;
    }
    /// The owner has nothing any more, and nothing is kept for it.
    void end_promise(PoolShare& share) noexcept
    {
        TACTUS_ASSERT(share.used == 0);
        kept_ -= share.promised;
        share.promised = 0;
    }
    /// How many more the owner may take.
    [[nodiscard]] std::uint32_t left_for(const PoolShare& share) const noexcept
    {
        const std::int64_t own = share.used < share.promised ? share.promised - share.used : 0;
        return static_cast<std::uint32_t>(std::max<std::int64_t>(free_ - kept_ + own, 0));
    }
    void take(PoolShare& share) noexcept
    {
        TACTUS_ASSERT(left_for(share) > 0);
        take_unasked(share);
    }
    /// The same for what can't be refused: there may be less than nothing left afterwards.
    void take_unasked(PoolShare& share) noexcept
    {
        kept_ -= share.used < share.promised ? 1 : 0;
        ++share.used;
        --free_;
    }
    void give_back(PoolShare& share) noexcept
    {
        TACTUS_ASSERT(share.used > 0);
        --share.used;
        ++free_;
        kept_ += share.used < share.promised ? 1 : 0;
    }

    [[nodiscard]] std::uint32_t capacity() const noexcept { return capacity_; }
    [[nodiscard]] std::uint32_t used() const noexcept
    {
        return static_cast<std::uint32_t>(capacity_ - free_);
    }

private:
    std::uint32_t capacity_;
    std::int64_t free_;
    std::int64_t kept_{0}; ///< Of the free ones, what is promised and not taken.
};

} // namespace tactus
