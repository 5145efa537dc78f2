// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/id_table.hpp"
#include "rt_core/base/pool_room.hpp"
#include "rt_core/cache/load_latency.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/spm/page_pool.hpp"

#include <cstdint>
#include <span>
#include <utility>

namespace tactus
{

class WishList;

/// The wishes of all models for one kind of slot. Never more pieces are asked for than the
/// transport thread has slots. 28 B a slot. Haptic thread only.
class WishPool
{
public:
    /// The transport thread has all slots at first.
    WishPool(Arena& arena, std::uint32_t slots) noexcept
        : room_(slots), place_of_(arena, slots), wishes_(arena.take<Wish>(slots))
    {
    }

    /// Forgets wishes that went unanswered for too long, so that they may be asked again. Looks at
    /// so many a call that each is looked at once in `timeout` calls. `timeout` > 0, in frames.
    void expire(std::uint32_t frame, std::uint32_t timeout = kWishTimeoutFrames) noexcept;

    /// Of all models.
    [[nodiscard]] std::uint32_t under_way() const noexcept { return place_of_.size(); }

private:
    friend class WishList;
    friend class CacheValidator;

    struct Wish
    {
        std::uint32_t key{IdTable::kAbsent}; ///< PagePool::first_key() + the piece's number.
        std::uint32_t asked{0};              ///< In this frame.
        WishList* list{nullptr};
    };

    void advance_cursor() noexcept { cursor_ = cursor_ + 1 == wishes_.size() ? 0 : cursor_ + 1; }

    PoolRoom room_;
    IdTable place_of_;
    std::span<Wish> wishes_;
    std::uint32_t cursor_{0};
};

/// One model's part of it: which pieces are under way, and how many of the slots the model has,
/// those that wishes wait for included. No more than other models leave. Does not move.
class WishList
{
public:
    /// The pool outlives the list; `least` slots are kept for the model.
    WishList(WishPool& pool, std::uint32_t owner, std::uint32_t least) noexcept
        : pool_(&pool), first_key_(PagePool::first_key(owner)), share_(pool.room_.promise(least))
    {
    }
    WishList(const WishList&) = delete;
    WishList& operator=(const WishList&) = delete;
    WishList(WishList&&) = delete;
    WishList& operator=(WishList&&) = delete;
    ~WishList() = default;

    [[nodiscard]] bool is_under_way(std::uint32_t number) const noexcept
    {
        return pool_->place_of_.find(first_key_ + number) != IdTable::kAbsent;
    }
    /// Whether one more piece may be asked for.
    [[nodiscard]] bool has_credit() const noexcept { return pool_->room_.left_for(share_) > 0; }
    void ask(std::uint32_t number, std::uint32_t frame) noexcept
    {
        TACTUS_ASSERT(!is_under_way(number));
        TACTUS_ASSERT(has_credit());
        pool_->room_.take(share_);
        while (pool_->wishes_[pool_->cursor_].list != nullptr)
        {
            pool_->advance_cursor();
        }
        pool_->wishes_[pool_->cursor_] = {first_key_ + number, frame, this};
        const bool inserted = pool_->place_of_.try_insert(first_key_ + number, pool_->cursor_);
        TACTUS_ASSERT(inserted);
        ++under_way_;
    }
    /// The piece has come, in a slot that is no longer the transport thread's.
    void arrive(std::uint32_t number, std::uint32_t frame) noexcept
    {
        const std::uint32_t place = pool_->place_of_.find(first_key_ + number);
        if (place != IdTable::kAbsent)
        {
            latency_.add(frame - pool_->wishes_[place].asked);
            forget(place);
            return;
        }
        TACTUS_ASSERT(slots_had() < pool_->room_.capacity());
        pool_->room_.take_unasked(share_); // Its wish had expired: the slot was anybody's.
    }
    /// Whether a wish expired since this was last asked.
    [[nodiscard]] bool take_expired() noexcept { return std::exchange(has_expired_, false); }
    void give_back_slot() noexcept { pool_->room_.give_back(share_); }
    /// Whether the model has more than what is kept for it.
    [[nodiscard]] bool has_more_than_its_own() const noexcept
    {
        return share_.used > share_.promised;
    }
    [[nodiscard]] std::uint32_t slots_had() const noexcept { return share_.used - under_way_; }
    [[nodiscard]] std::uint32_t under_way() const noexcept { return under_way_; }

    /// From asking to arriving, of what came before it expired.
    [[nodiscard]] const LoadLatency& latency() const noexcept { return latency_; }

private:
    friend class WishPool;
    friend class CacheValidator;

    void forget(std::uint32_t place) noexcept
    {
        WishPool::Wish& wish = pool_->wishes_[place];
        pool_->place_of_.erase(wish.key);
        wish = WishPool::Wish{};
        --under_way_;
    }

    WishPool* pool_;
    std::uint32_t first_key_;
    PoolShare share_;
    std::uint32_t under_way_{0};
    bool has_expired_{false};
    LoadLatency latency_;
};

inline void WishPool::expire(std::uint32_t frame, std::uint32_t timeout) noexcept
{
    TACTUS_ASSERT(timeout > 0);
    const auto places = static_cast<std::uint32_t>(wishes_.size());
    for (std::uint32_t looked = 0; looked <= places / timeout; ++looked)
    {
        advance_cursor();
        const Wish& wish = wishes_[cursor_];
        if (wish.list != nullptr && frame - wish.asked > timeout)
        {
            WishList& list = *wish.list;
            list.forget(cursor_);
            list.give_back_slot();
            list.has_expired_ = true;
        }
    }
}

} // namespace tactus
