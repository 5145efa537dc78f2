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

/// What the caches of all models share: who has which slot, who may have one more, and the door.
/// Haptic thread, but for the other ends of the door.
class CachePool
{
public:
    /// Of up to `models` models, of which `guests` may come and go; with a door of so many slots
    /// and their base meshes that has room for as many wishes.
    CachePool(Arena& arena, std::uint32_t page_slots, std::uint32_t index_slots,
              std::uint32_t models, std::uint32_t guests = 0) noexcept;

    /// How long a frame is; a period of 1 ms unless told. Wishes wait for answers kWishTimeout_ns.
    void set_period(std::int64_t period_ns) noexcept;

    /// The frame begins: the caches take over what arrived for them, in its order, up to the first
    /// slot beyond `budget` and kMaxArrivalsPerFrame, or the first link update beyond
    /// kMaxLinkUpdatesPerFrame. Wishes that waited for too long are forgotten.
    void adopt_arrivals(std::uint32_t budget, std::uint32_t frame,
                        WorkCounters& work) noexcept TACTUS_NONBLOCKING;
    /// The frame begins: it has taken nothing yet.
    void forget_taken() noexcept { taken_count_ = 0; }
    /// What the last one took. With the frame's arguments this is all that decides what the frame
    /// does. Valid until the next one.
    [[nodiscard]] DoorTake taken() const noexcept
    {
        return {taken_.first(taken_count_), wish_room_at_start_};
    }

    /// The most urgent class for which a chunk where a tool is found no page in this frame;
    /// kUrgencyClasses: none.
    [[nodiscard]] std::uint32_t refused_class() const noexcept { return refused_class_; }

    /// What is known of a slot of index pages.
    struct IndexMeta
    {
        IndexPageId page{};       ///< None: the slot is the transport thread's.
        std::uint32_t touched{0}; ///< Frame number of the last use.
        std::uint32_t owner{0};
    };

    PagePool pages;
    IdTable index_slot_of; ///< By PagePool::first_key() + page.
    std::span<IndexMeta> index_metas;
    WishPool chunk_wishes;
    WishPool index_wishes;
    SlotDoor door;

private:
    friend class ChunkCache;
    friend class CacheValidator;

    /// Pages that are looked at for one to give back, from where the last look ended: the oldest of
    /// them goes.
    static constexpr std::uint32_t kEvictionLooks = 128;

    [[nodiscard]] bool try_wish(ContentKey key, std::uint32_t owner,
                                std::uint32_t generation) noexcept TACTUS_NONBLOCKING;
    /// No page could be given back for want of this class where a tool is.
    void refuse(UrgencyClass of) noexcept
    {
        refused_class_ = std::min(refused_class_, static_cast<std::uint32_t>(of));
    }

    /// By owner, while it lives: one cache may take a page of another that is of no use there.
    std::span<ChunkCache*> caches_;
    std::span<DoorEvent> taken_; ///< The first `taken_count_` are of this frame.
    std::uint32_t taken_count_{0};
    DoorEvent next_;       ///< That the last frame had no room for.
    bool has_next_{false}; ///< There is one.
    std::uint32_t wish_room_at_start_{0};
    std::uint32_t wish_room_{0};
    std::uint32_t wish_timeout_frames_{kWishTimeoutFrames};
    std::uint32_t refused_class_{kUrgencyClasses};
    std::uint32_t hand_{0};         ///< The next page to look at for giving back,
    std::uint32_t barren_looks_{0}; ///< and so many looks since the last one that was.
};

} // namespace tactus
