// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/id_table.hpp"
#include "rt_core/cache/load_latency.hpp"
#include "rt_core/limits.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace tactus
{

/// Book-keeping of wishes for one kind of slot: how many slots the transport thread has free, and
/// which pieces are under way. Never more pieces are asked for than it has slots.
class WishList
{
public:
    /// The transport thread has all `slots` at first.
    WishList(Arena& arena, std::uint32_t slots) noexcept
        : under_way_(arena, slots)
        , asked_(arena.take<std::uint32_t>(slots))
        , numbers_(arena.take<std::uint32_t>(slots))
        , slots_at_transport_(slots)
    {
        if (!arena.is_measuring())
        {
            std::ranges::fill(numbers_, IdTable::kAbsent);
        }
    }

    [[nodiscard]] bool is_under_way(std::uint32_t number) const noexcept
    {
        return under_way_.find(number) != IdTable::kAbsent;
    }
    /// Whether one more piece may be asked for.
    [[nodiscard]] bool has_credit() const noexcept
    {
        return under_way_.size() < slots_at_transport_;
    }
    void ask(std::uint32_t number, std::uint32_t frame) noexcept
    {
        TACTUS_ASSERT(!is_under_way(number));
        TACTUS_ASSERT(has_credit());
        // One place of the ring is free: fewer are under way than there are slots.
        while (numbers_[cursor_] != IdTable::kAbsent)
        {
            advance_cursor();
        }
        numbers_[cursor_] = number;
        asked_[cursor_] = frame;
        const bool inserted = under_way_.try_insert(number, cursor_);
        TACTUS_ASSERT(inserted);
    }
    /// The piece has come, in a slot that is no longer the transport thread's.
    void arrive(std::uint32_t number, std::uint32_t frame) noexcept
    {
        if (const std::uint32_t place = under_way_.find(number); place != IdTable::kAbsent)
        {
            latency_.add(frame - asked_[place]);
        }
        forget(number);
        TACTUS_ASSERT(slots_at_transport_ > 0);
        --slots_at_transport_;
    }
    void give_back_slot() noexcept
    {
        TACTUS_ASSERT(slots_at_transport_ < numbers_.size());
        ++slots_at_transport_;
    }

    /// Forgets wishes that went unanswered for too long, so that they may be asked again. Looks at
    /// so many a call that each is looked at once in `timeout` calls. `timeout` > 0, in frames.
    void expire(std::uint32_t frame, std::uint32_t timeout = kWishTimeoutFrames) noexcept
    {
        TACTUS_ASSERT(timeout > 0);
        const auto places = static_cast<std::uint32_t>(numbers_.size());
        for (std::uint32_t looked = 0; looked <= places / timeout; ++looked)
        {
            advance_cursor();
            const std::uint32_t number = numbers_[cursor_];
            if (number != IdTable::kAbsent && frame - asked_[cursor_] > timeout)
            {
                forget(number);
            }
        }
    }
    [[nodiscard]] std::uint32_t under_way() const noexcept { return under_way_.size(); }

    /// From asking to arriving, of what came before it expired.
    [[nodiscard]] const LoadLatency& latency() const noexcept { return latency_; }

private:
    friend class CacheValidator;

    void forget(std::uint32_t number) noexcept
    {
        const std::uint32_t place = under_way_.find(number);
        if (place != IdTable::kAbsent)
        {
            TACTUS_ASSERT(numbers_[place] == number);
            numbers_[place] = IdTable::kAbsent;
            under_way_.erase(number);
        }
    }
    void advance_cursor() noexcept { cursor_ = cursor_ + 1 == numbers_.size() ? 0 : cursor_ + 1; }

    IdTable under_way_;
    std::span<std::uint32_t> asked_;
    std::span<std::uint32_t> numbers_;
    std::uint32_t slots_at_transport_;
    std::uint32_t cursor_{0};
    LoadLatency latency_;
};

} // namespace tactus
