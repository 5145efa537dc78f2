// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/cache/cache_pool.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/cache/chunk_cache.hpp"

#include <algorithm>

namespace tactus
{

CachePool::CachePool(Arena& arena, std::uint32_t page_slots, std::uint32_t index_slots,
                     std::uint32_t models, std::uint32_t streamed_models) noexcept
    : pages(arena, page_slots)
    , index_slot_of(arena, index_slots)
    , index_metas(arena.take<IndexMeta>(index_slots))
    , chunk_requests(arena, page_slots)
    , index_requests(arena, index_slots)
    , queues(arena, std::size_t{page_slots} + index_slots + streamed_models,
             std::size_t{page_slots} + index_slots + streamed_models)
    , caches_(arena.take<ChunkCache*>(models))
    , taken_(arena.take<QueueEvent>(kMaxArrivalsPerFrame + kMaxLinkUpdatesPerFrame))
{
}

void CachePool::set_period(std::int64_t period_ns) noexcept
{
    TACTUS_ASSERT(period_ns > 0);
    request_timeout_frames_ = static_cast<std::uint32_t>(
        std::clamp<std::int64_t>(kRequestTimeout_ns / period_ns, 1, ChunkCache::kFirstFrame));
}

void CachePool::adopt_arrivals(std::uint32_t budget, std::uint32_t frame,
                               WorkCounters& work) noexcept
{
    // Read once a frame: the transport thread makes room at any time, and the number of requests
    // must not depend on that time.
    request_room_ = static_cast<std::uint32_t>(queues.wanted.capacity() - queues.wanted.size());
    request_room_at_start_ = request_room_;
    refused_class_ = kPriorityClasses;
    forget_taken();
    const std::uint32_t arrivals_end =
        std::min(budget - std::min(budget, work.pages_adopted), kMaxArrivalsPerFrame);
    std::uint32_t arrivals = 0;
    std::uint32_t updates = 0;
    while (has_next_ || queues.arrived.try_pop(next_))
    {
        const bool is_update = next_.kind == QueueEventKind::link_update;
        has_next_ = is_update ? updates == kMaxLinkUpdatesPerFrame : arrivals == arrivals_end;
        if (has_next_)
        {
            break;
        }
        TACTUS_ASSERT(next_.owner < caches_.size());
        caches_[next_.owner]->take(next_, frame);
        taken_[taken_count_++] = next_;
        ++(is_update ? updates : arrivals);
    }
    work.pages_adopted += arrivals;
    chunk_requests.expire(frame, request_timeout_frames_);
    index_requests.expire(frame, request_timeout_frames_);
}

/// Sends a request; false if the queues had no room for one more at the start of the frame, or too
/// many are under way.
bool CachePool::try_request(ContentKey key, std::uint32_t owner, std::uint32_t generation) noexcept
{
    const std::uint32_t open = chunk_requests.under_way() + index_requests.under_way();
    if (request_room_ == 0 || open >= SlotQueues::kOpenRequests)
    {
        return false;
    }
    --request_room_;
    const bool pushed = queues.wanted.try_push({key, generation, static_cast<std::uint8_t>(owner)});
    TACTUS_ASSERT(pushed);
    return true;
}

} // namespace tactus
