// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/id_table.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/cache/request_list.hpp"
#include "rt_core/cache/slot_queues.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/region_ranking.hpp"
#include "rt_core/records/work_counters.hpp"
#include "rt_core/spm/ids.hpp"
#include "rt_core/spm/page_pool.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace tactus
{

class ChunkCache;

/// Shared data of the caches of all models: slot owners, free capacity, and the queues. Haptic
/// thread, except the other ends of the queues.
class CachePool
{
public:
    /// Pool for up to `models` models, `streamed_models` of which are streamed. The queues hold all
    /// slots and base meshes, and as many requests.
    CachePool(Arena& arena, std::uint32_t page_slots, std::uint32_t index_slots,
              std::uint32_t models, std::uint32_t streamed_models = 0) noexcept;

    /// Sets the duration of a frame, 1 ms without a call: requests expire after kRequestTimeout_ns.
    void set_period(std::int64_t period_ns) noexcept;

    /// Begins a frame: passes queued events to their models' caches, in order. Stops before the
    /// first arrival beyond `budget` or kMaxArrivalsPerFrame, or the first link update beyond
    /// kMaxLinkUpdatesPerFrame. Then requests without an answer for too long expire.
    void adopt_arrivals(std::uint32_t budget, std::uint32_t frame,
                        WorkCounters& work) noexcept TACTUS_NONBLOCKING;
    /// Empties taken(), for a frame without adopt_arrivals().
    void forget_taken() noexcept { taken_count_ = 0; }
    /// Events taken in this frame, and the room for requests at its start: with the frame's
    /// arguments all of its inputs. Valid until the next adopt_arrivals().
    [[nodiscard]] QueueTake taken() const noexcept
    {
        return {taken_.first(taken_count_), request_room_at_start_};
    }

    /// Highest-priority class of which a chunk at a tool found no page slot in this frame;
    /// kPriorityClasses if there is none.
    [[nodiscard]] std::uint32_t refused_class() const noexcept { return refused_class_; }

    /// State of a slot for index pages.
    struct IndexMeta
    {
        IndexPageId page{};       ///< None: the slot is the transport thread's.
        std::uint32_t touched{0}; ///< Frame of the last use.
        std::uint32_t owner{0};
    };

    PagePool pages;
    IdTable index_slot_of; ///< Key: PagePool::first_key() + page.
    std::span<IndexMeta> index_metas;
    RequestPool chunk_requests;
    RequestPool index_requests;
    SlotQueues queues;

private:
    friend class ChunkCache;
    friend class CacheValidator;

    /// Largest number of pages checked for one eviction, beginning after the last one checked. The
    /// least recently touched is evicted.
    static constexpr std::uint32_t kEvictionLooks = 128;

    [[nodiscard]] bool try_request(ContentKey key, std::uint32_t owner,
                                   std::uint32_t generation) noexcept TACTUS_NONBLOCKING;
    /// Records that a chunk of this class at a tool found no page to evict.
    void refuse(PriorityClass of) noexcept
    {
        refused_class_ = std::min(refused_class_, static_cast<std::uint32_t>(of));
    }

    /// Cache of each model, by owner: one model's request may evict another's unused page.
    std::span<ChunkCache*> caches_;
    std::span<QueueEvent> taken_; ///< Events of this frame are the first `taken_count_`.
    std::uint32_t taken_count_{0};
    QueueEvent next_;      ///< Popped event beyond the last frame's limits.
    bool has_next_{false}; ///< `next_` is valid.
    std::uint32_t request_room_at_start_{0};
    std::uint32_t request_room_{0};
    std::uint32_t request_timeout_frames_{kRequestTimeoutFrames};
    std::uint32_t refused_class_{kPriorityClasses};
    std::uint32_t hand_{0};         ///< Next page to check for eviction.
    std::uint32_t barren_looks_{0}; ///< Pages checked since the last eviction.
};

} // namespace tactus
