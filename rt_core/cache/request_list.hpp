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

class RequestList;

/// Requests of all models for one kind of slot, never more than the transport thread has slots. 28
/// B per slot. Haptic thread only.
class RequestPool
{
public:
    /// All slots start as the transport thread's.
    RequestPool(Arena& arena, std::uint32_t slots) noexcept
        : room_(slots), place_of_(arena, slots), requests_(arena.take<Request>(slots))
    {
    }

    /// Removes requests older than `timeout` frames, so that they may be repeated; `timeout` > 0.
    /// Each request is checked once in `timeout` calls.
    void expire(std::uint32_t frame, std::uint32_t timeout = kRequestTimeoutFrames) noexcept;

    /// Number of requests of all models.
    [[nodiscard]] std::uint32_t under_way() const noexcept { return place_of_.size(); }

private:
    friend class RequestList;
    friend class CacheValidator;

    struct Request
    {
        std::uint32_t key{IdTable::kAbsent}; ///< Key of the piece: PagePool::first_key() + its
                                             ///< number.
        std::uint32_t asked{0};              ///< Frame of the request.
        RequestList* list{nullptr};
    };

    void advance_cursor() noexcept { cursor_ = cursor_ + 1 == requests_.size() ? 0 : cursor_ + 1; }

    PoolRoom room_;
    IdTable place_of_;
    std::span<Request> requests_;
    std::uint32_t cursor_{0};
};

/// One model's requests in a pool, and the number of its slots: those that hold a piece and those
/// reserved for a requested one. Must not move.
class RequestList
{
public:
    /// The pool outlives the list; `least` slots are reserved for the model.
    RequestList(RequestPool& pool, std::uint32_t owner, std::uint32_t least) noexcept
        : pool_(&pool), first_key_(PagePool::first_key(owner)), share_(pool.room_.promise(least))
    {
    }
    RequestList(const RequestList&) = delete;
    RequestList& operator=(const RequestList&) = delete;
    RequestList(RequestList&&) = delete;
    RequestList& operator=(RequestList&&) = delete;
    ~RequestList() = default;

    [[nodiscard]] bool is_under_way(std::uint32_t number) const noexcept
    {
        return pool_->place_of_.find(first_key_ + number) != IdTable::kAbsent;
    }
    /// True if one more piece may be requested.
    [[nodiscard]] bool has_credit() const noexcept { return pool_->room_.left_for(share_) > 0; }
    void ask(std::uint32_t number, std::uint32_t frame) noexcept
    {
        TACTUS_ASSERT(!is_under_way(number));
        TACTUS_ASSERT(has_credit());
        pool_->room_.take(share_);
        while (pool_->requests_[pool_->cursor_].list != nullptr)
        {
            pool_->advance_cursor();
        }
        pool_->requests_[pool_->cursor_] = {first_key_ + number, frame, this};
        const bool inserted = pool_->place_of_.try_insert(first_key_ + number, pool_->cursor_);
        TACTUS_ASSERT(inserted);
        ++under_way_;
    }
    /// Records the arrival of a piece: ends its request and counts its slot as the model's.
    void arrive(std::uint32_t number, std::uint32_t frame) noexcept
    {
        const std::uint32_t place = pool_->place_of_.find(first_key_ + number);
        if (place != IdTable::kAbsent)
        {
            latency_.add(frame - pool_->requests_[place].asked);
            forget(place);
            return;
        }
        TACTUS_ASSERT(slots_had() < pool_->room_.capacity());
        pool_->room_.take_unasked(share_); // The request had expired, so its slot was not reserved.
    }
    /// True if a request expired since the last call.
    [[nodiscard]] bool take_expired() noexcept { return std::exchange(has_expired_, false); }
    void give_back_slot() noexcept { pool_->room_.give_back(share_); }
    /// True if the model has more than its reservation.
    [[nodiscard]] bool has_more_than_its_own() const noexcept
    {
        return share_.used > share_.promised;
    }
    [[nodiscard]] std::uint32_t slots_had() const noexcept { return share_.used - under_way_; }
    [[nodiscard]] std::uint32_t under_way() const noexcept { return under_way_; }

    /// Time from request to arrival, of pieces that arrived before their request expired.
    [[nodiscard]] const LoadLatency& latency() const noexcept { return latency_; }

private:
    friend class RequestPool;
    friend class CacheValidator;

    void forget(std::uint32_t place) noexcept
    {
        RequestPool::Request& request = pool_->requests_[place];
        pool_->place_of_.erase(request.key);
        request = RequestPool::Request{};
        --under_way_;
    }

    RequestPool* pool_;
    std::uint32_t first_key_;
    PoolShare share_;
    std::uint32_t under_way_{0};
    bool has_expired_{false};
    LoadLatency latency_;
};

inline void RequestPool::expire(std::uint32_t frame, std::uint32_t timeout) noexcept
{
    TACTUS_ASSERT(timeout > 0);
    const auto places = static_cast<std::uint32_t>(requests_.size());
    for (std::uint32_t looked = 0; looked <= places / timeout; ++looked)
    {
        advance_cursor();
        const Request& request = requests_[cursor_];
        if (request.list != nullptr && frame - request.asked > timeout)
        {
            RequestList& list = *request.list;
            list.forget(cursor_);
            list.give_back_slot();
            list.has_expired_ = true;
        }
    }
}

} // namespace tactus
