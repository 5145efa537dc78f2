// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/cache/chunk_inbox.hpp"
#include "rt_core/cache/wish_list.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/region_ranking.hpp"
#include "rt_core/records/work_counters.hpp"
#include "rt_core/spm/page_table.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

/// Which of a model's chunks and index pages are here, and what to ask for.
///
/// Every frame it searches some index pages, round and round, for chunks whose influence box meets
/// a ranked ball. Such a chunk is touched when it is here and asked for when it isn't. A page goes
/// back when its slot is needed, no record of it is refined, and it was not touched in the last
/// two rounds, the least recently touched first. What a present ball needs counts as touched
/// kAheadAge frames after what only a predicted one does: prefetching never evicts what is of
/// use, while present need may take the place of what was prefetched.
///
/// Haptic thread; the other end of the inbox is the courier.
class ChunkCache
{
public:
    ChunkCache(Arena& arena, const ModelHeader& header, PageSlots slots, PageTable& pages,
               ChunkInbox& inbox) noexcept;

    /// How long a frame is; a period of 1 ms unless told. Wishes wait for answers kWishTimeout_ns.
    void set_period(std::int64_t period_ns) noexcept
    {
        TACTUS_ASSERT(period_ns > 0);
        wish_timeout_frames_ = static_cast<std::uint32_t>(
            std::clamp<std::int64_t>(kWishTimeout_ns / period_ns, 1, kFirstFrame));
    }

    /// Takes over what arrived, at most `budget` slots, and link updates on the way. Each is taken
    /// in its order; what is beyond kMaxArrivalsPerFrame or kMaxLinkUpdatesPerFrame waits.
    void adopt_arrivals(std::uint32_t budget, std::uint32_t frame,
                        WorkCounters& work) noexcept TACTUS_NONBLOCKING;

    /// What the last adopt_arrivals() took. With the frame's arguments this is all that decides
    /// what the frame does. Valid until the next call.
    [[nodiscard]] DoorTake taken() const noexcept
    {
        return {taken_.first(taken_count_), wish_room_at_start_};
    }

    /// Asks for what `regions` (of this model, most urgent first) lack.
    void request_missing(std::span<const RankedRegion> regions, const Budgets& budgets,
                         std::uint32_t frame, WorkCounters& work,
                         FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// Gives every page back in which no record is refined; for models whose cache is off. One look
    /// at each page.
    void evict_unpinned(WorkCounters& work) noexcept TACTUS_NONBLOCKING;

    /// Asks for chunks in order until all of the model is here, after request_missing().
    void request_everything(const Budgets& budgets, WorkCounters& work,
                            FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// Frame numbers start here, so that ages can be subtracted.
    static constexpr std::uint32_t kFirstFrame = 4'096;

    /// In frames, from wishing for a chunk to having it.
    [[nodiscard]] const LoadLatency& latency() const noexcept { return chunk_wishes_.latency(); }
    /// Wishes that wait for an answer.
    [[nodiscard]] std::uint32_t wishes_under_way() const noexcept
    {
        return chunk_wishes_.under_way() + index_wishes_.under_way();
    }
    [[nodiscard]] std::uint64_t loads() const noexcept { return loads_; }
    [[nodiscard]] std::uint64_t evictions() const noexcept { return evictions_; }
    [[nodiscard]] std::uint32_t index_pages_used() const noexcept { return index_slot_of_.size(); }

private:
    friend class CacheValidator;

    struct IndexMeta
    {
        IndexPageId page{};
        std::uint32_t touched{0};
    };
    using Balls = StaticVector<QuantumBall, kMaxRankedRegions>;
    struct RankedBalls
    {
        Balls present;
        Balls ahead; ///< Where the proxy may be after a lead time.
    };
    /// How a chunk is wanted: what counts as its last use, and whose place it may take.
    struct Urgency
    {
        std::uint32_t touch{0};
        std::uint32_t evict_before{0};
    };

    void adopt(const DoorEvent& arrival, std::uint32_t frame) noexcept;
    [[nodiscard]] bool try_wish(ContentKey key, std::uint32_t generation) noexcept;
    [[nodiscard]] RankedBalls to_quanta(std::span<const RankedRegion> regions) const noexcept;
    [[nodiscard]] static bool meets(const Balls& balls, const QuantumBox& box) noexcept;
    void search_page(IndexPageId page, const RankedBalls& balls, const Budgets& budgets,
                     std::uint32_t frame, WorkCounters& work, FrameFault& faults) noexcept;
    void want_chunk(ChunkId chunk, const Urgency& urgency, const Budgets& budgets,
                    WorkCounters& work, FrameFault& faults) noexcept;
    void want_index_page(IndexPageId page, std::uint32_t frame, WorkCounters& work,
                         FrameFault& faults) noexcept;
    [[nodiscard]] bool try_evict_page(std::uint32_t touched_before, WorkCounters& work) noexcept;
    void evict(std::uint32_t slot, WorkCounters& work) noexcept;
    [[nodiscard]] bool try_evict_index_page() noexcept;

    /// Longer than two rounds and a load take, and no longer: while a hand moves on, what it left
    /// is in the way of what it will need.
    static constexpr std::uint32_t kAheadAge = 64;
    static_assert(kAheadAge < kFirstFrame, "a touch dated back is no frame before the first");

    ModelHeader header_;
    PageSlots slots_;
    PageTable* pages_;
    ChunkInbox* inbox_;
    IdTable index_slot_of_;
    std::span<IndexMeta> index_meta_;
    WishList chunk_wishes_;
    WishList index_wishes_;
    std::span<DoorEvent> taken_; ///< The first `taken_count_` are of this frame.
    std::uint32_t taken_count_{0};
    std::uint32_t wish_room_at_start_{0};
    std::uint32_t wish_room_{0};
    std::uint32_t wish_timeout_frames_{kWishTimeoutFrames};
    std::uint32_t cursor_{0};      ///< Next index page to look at.
    std::uint32_t fill_cursor_{0}; ///< Next chunk of request_everything().
    std::uint32_t frame_{kFirstFrame};
    std::uint32_t round_began_{kFirstFrame};      ///< Frame in which the cursor last passed zero,
    std::uint32_t last_round_began_{kFirstFrame}; ///< and the time before.
    std::uint64_t loads_{0};
    std::uint64_t evictions_{0};
};

} // namespace tactus
