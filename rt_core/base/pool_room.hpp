// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <cstdint>

namespace tactus
{

/// Reserved and taken slots of one owner in a pool.
struct PoolShare
{
    std::uint32_t promised{0}; ///< Slots reserved for this owner.
    std::uint32_t used{0};
};

/// Counts the slots of a pool with several owners. Each owner may have a promise, slots that no
/// other owner can take; all others may take the rest. A single owner has all slots.
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
    /// Promises all of `slots` to an owner that has none so far. False, with nothing changed, if
    /// fewer are neither taken nor promised.
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
    /// Ends the promise of an owner that has no slot in use.
    void end_promise(PoolShare& share) noexcept
    {
        TACTUS_ASSERT(share.used == 0);
        kept_ -= share.promised;
        share.promised = 0;
    }
    /// Number of slots that the owner may still take.
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
    /// Takes a slot that can't be refused. The free slots may then be fewer than those promised.
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
    std::int64_t kept_{0}; ///< Number of promised slots that are not taken.
};

} // namespace tactus
