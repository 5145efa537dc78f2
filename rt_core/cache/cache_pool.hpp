// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/id_table.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/cache/slot_door.hpp"
#include "rt_core/cache/wish_list.hpp"
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

/// Shared data of the caches of all models: slot owners, free capacity, and the door. Haptic
/// thread, except the other ends of the door.
class CachePool
{
public:
    /// Pool for up to `models` models, `guests` of which are streamed. The door holds all slots and
    /// base meshes, and as many requests.
    CachePool(Arena& arena, std::uint32_t page_slots, std::uint32_t index_slots,
              std::uint32_t models, std::uint32_t guests = 0) noexcept;

    /// Sets the duration of a frame; 1 ms without a call. Requests wait kWishTimeout_ns for
    /// answers.
    void set_period(std::int64_t period_ns) noexcept;

    /// Begins a frame: the caches adopt their arrivals in order, up to the first slot beyond
    /// `budget` and kMaxArrivalsPerFrame, or the first link update beyond kMaxLinkUpdatesPerFrame.
    /// Requests without an answer for too long expire.
    void adopt_arrivals(std::uint32_t budget, std::uint32_t frame,
                        WorkCounters& work) noexcept TACTUS_NONBLOCKING;
    /// Begins a frame that has taken nothing yet.
    void forget_taken() noexcept { taken_count_ = 0; }
    /// Events that the last frame took. With the frame's arguments they decide all that the frame
    /// does. Valid until the next adoption.
    [[nodiscard]] DoorTake taken() const noexcept
    {
        return {taken_.first(taken_count_), wish_room_at_start_};
    }

    /// Most urgent class for which a chunk at a tool found no page in this frame; kUrgencyClasses:
    /// none.
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
    WishPool chunk_wishes;
    WishPool index_wishes;
    SlotDoor door;

private:
    friend class ChunkCache;
    friend class CacheValidator;

    /// Pages checked for one eviction, from where the last check ended; the oldest of them is
    /// evicted.
    static constexpr std::uint32_t kEvictionLooks = 128;

    [[nodiscard]] bool try_wish(ContentKey key, std::uint32_t owner,
                                std::uint32_t generation) noexcept TACTUS_NONBLOCKING;
    /// Records that a chunk of this class at a tool found no page to evict.
    void refuse(UrgencyClass of) noexcept
    {
        refused_class_ = std::min(refused_class_, static_cast<std::uint32_t>(of));
    }

    /// Caches by owner, while alive: one cache may take an unused page of another.
    std::span<ChunkCache*> caches_;
    std::span<DoorEvent> taken_; ///< Events of this frame are the first `taken_count_`.
    std::uint32_t taken_count_{0};
    DoorEvent next_;       ///< Event for which the last frame had no room.
    bool has_next_{false}; ///< `next_` is valid.
    std::uint32_t wish_room_at_start_{0};
    std::uint32_t wish_room_{0};
    std::uint32_t wish_timeout_frames_{kWishTimeoutFrames};
    std::uint32_t refused_class_{kUrgencyClasses};
    std::uint32_t hand_{0};         ///< Next page to check for eviction.
    std::uint32_t barren_looks_{0}; ///< Checks since the last eviction.
};

} // namespace tactus
