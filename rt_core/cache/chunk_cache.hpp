// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/cache/cache_pool.hpp"
#include "rt_core/cache/index_search.hpp"
#include "rt_core/cache/wish_list.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_variant.hpp"
#include "rt_core/records/region_ranking.hpp"
#include "rt_core/records/work_counters.hpp"
#include "rt_core/spm/page_table.hpp"

#include <cstdint>
#include <span>
#include <utility>

namespace tactus
{

/// Which of a model's chunks and index pages are here, and what to ask for.
///
/// Every frame it looks for chunks whose influence box meets a ranked ball, where the certificates
/// of its searches (IndexSearch) are used up: first for pairs that touch or will soon, then for the
/// rest, each with a part of the budget that the other can't take. Such a chunk is touched when it
/// is here and asked for when it isn't. A page goes back when its slot is needed, no record of it
/// is refined, and it was not touched in the last two rounds, the least recently touched first.
/// What is wanted counts as touched kLevelAge frames later than what is only predicted of the same
/// class, and that as much later than what the next class wants: prefetching never evicts what is
/// of use, while present need may take the place of what was prefetched, and a touch that of what
/// others only want.
///
/// Slots are in a pool of all models. When it has no more for this one, the page that goes back may
/// be another model's that has more than what is kept for it.
///
/// Haptic thread; the other end of the door is the courier.
class ChunkCache
{
public:
    /// What is kept of a pool for one model.
    struct Kept
    {
        std::uint32_t pages{0};
        std::uint32_t index_pages{0};
    };

    /// The table is the model's; the pool is its table's. Both outlive the cache, which does not
    /// move.
    ChunkCache(CachePool& pool, const Kept& kept, const ModelHeader& header, PageSlots slots,
               PageTable& pages, const Kernels& kernels) noexcept;
    ChunkCache(const ChunkCache&) = delete;
    ChunkCache& operator=(const ChunkCache&) = delete;
    ChunkCache(ChunkCache&&) = delete;
    ChunkCache& operator=(ChunkCache&&) = delete;
    ~ChunkCache() = default;

    /// Which shortcuts requests take; all of them unless told.
    void set_variant(const FrameVariant& variant) noexcept { variant_ = variant; }

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

    /// A model that comes and goes has a cache that is closed at first: what arrives goes back at
    /// once.
    void close() noexcept { is_open_ = false; }
    void open() noexcept TACTUS_NONBLOCKING;
    /// Asks for the base mesh of a closed cache, and again where it doesn't come; it is to lie from
    /// this cell on. Until it has come the cells are the transport thread's.
    void want_base(std::uint32_t first_cell, std::uint32_t frame) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool has_base() const noexcept { return has_base_; }
    /// Whether its cells were given back instead since it was last asked. A while later it may be
    /// wanted again.
    [[nodiscard]] bool try_take_cells_back() noexcept
    {
        return std::exchange(has_cells_back_, false);
    }
    [[nodiscard]] bool may_want_base(std::uint32_t frame) const noexcept
    {
        return cells_back_ == 0 || frame - cells_back_ > pool_->wish_timeout_frames_;
    }
    /// Gives back what a closed cache has, looking at up to `most` slots from where the last call
    /// ended: the pages, in none of which a record counts as refined any more, the index pages and
    /// at last the base mesh. False until then.
    [[nodiscard]] bool try_empty(std::uint32_t most, std::uint32_t frame,
                                 WorkCounters& work) noexcept TACTUS_NONBLOCKING;

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
    [[nodiscard]] std::uint32_t index_pages_used() const noexcept { return index_pages_used_; }

private:
    friend class CacheValidator;
    friend class CachePool;

    using IndexMeta = CachePool::IndexMeta;
    /// How a chunk is wanted: what counts as its last use, and whose place it may take.
    struct Want
    {
        std::uint32_t touch{0};
        std::uint32_t evict_before{0};
        std::uint32_t age{0}; ///< So much longer another model's page was of no use.
        std::uint32_t level{0};
    };
    /// What a frame looks for.
    struct Look
    {
        IndexSearch& search;
        const BallLanes& lanes;
        const Budgets& most;
    };

    void take(const DoorEvent& event, std::uint32_t frame) noexcept TACTUS_NONBLOCKING;
    void adopt(const DoorEvent& arrival, std::uint32_t frame) noexcept;
    void send_back(const DoorEvent& arrival, std::uint32_t frame) noexcept;
    void end_base(std::uint32_t frame) noexcept;
    [[nodiscard]] IndexSearch::Balls to_quanta(std::span<const RankedRegion> regions,
                                               bool are_urgent) const noexcept;
    [[nodiscard]] Want want_of(std::uint32_t level, std::uint32_t touch_level) const noexcept;
    void search(IndexSearch& search, const Budgets& most, WorkCounters& work,
                FrameFault& faults) noexcept;
    std::uint32_t look_at(IndexSearch::NearPage& near, const Look& look, WorkCounters& work,
                          FrameFault& faults) noexcept;
    void look_at_boxes(IndexSearch::NearPage& near, const IndexPage& index,
                       const QuantumBox& page_box, const Look& look, WorkCounters& work,
                       FrameFault& faults) noexcept;
    [[nodiscard]] bool try_touch(ChunkId chunk, const Want& want, WorkCounters& work) noexcept;
    [[nodiscard]] bool try_want(ChunkId chunk, const Want& want, const Budgets& most,
                                WorkCounters& work, FrameFault& faults) noexcept;
    [[nodiscard]] bool try_want_index_page(IndexPageId page, WorkCounters& work,
                                           FrameFault& faults) noexcept;
    void forget(IndexPageId page) noexcept;
    void begin_again() noexcept;
    /// What was not touched since was of no use in two rounds.
    [[nodiscard]] std::uint32_t unused_since() const noexcept;
    void give_page_back(const Want& want, WorkCounters& work) noexcept;
    [[nodiscard]] std::uint32_t find_index_page(IndexPageId page) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] std::uint32_t lends_before(const WishList& wishes, std::uint32_t frame,
                                             std::uint32_t age) const noexcept;
    void evict_index_page(std::uint32_t slot) noexcept;
    void evict(std::uint32_t slot, WorkCounters& work) noexcept;
    [[nodiscard]] bool try_evict_index_page() noexcept;

    /// Longer than two rounds and a load take, and no longer: while a hand moves on, what it left
    /// is in the way of what it will need.
    static constexpr std::uint32_t kLevelAge = 64;
    static_assert(kLevelAge * kWantedLevels < kFirstFrame,
                  "a touch dated back is no frame before the first");
    /// Of the budgets, what the less urgent balls always get.
    static constexpr std::uint32_t kPatientShare = 4;

    CachePool* pool_;
    ModelHeader header_;
    QuantumBox extent_; ///< Of all index pages' boxes.
    FrameVariant variant_;
    IndexSearch urgent_{kFirstFrame};  ///< For pairs that touch or will soon,
    IndexSearch patient_{kFirstFrame}; ///< and for the rest.
    PageSlots slots_;
    PageTable* pages_;
    const Kernels* kernels_;
    std::span<IndexMeta> index_meta_; ///< Of all models.
    std::uint32_t index_pages_used_{0};
    WishList chunk_wishes_;
    WishList index_wishes_;
    /// Others may take what was not touched since, where no more than that is kept.
    std::uint32_t lends_before_{kFirstFrame};
    std::uint32_t fill_cursor_{0}; ///< Next chunk of request_everything().
    bool is_open_{true};
    bool has_base_{false};          ///< Of one that comes and goes: its base mesh is here.
    bool has_cells_back_{false};    ///< Those lent for it, and nobody has asked yet.
    std::uint32_t base_asked_{0};   ///< In this frame; 0: not since it went.
    std::uint32_t cells_back_{0};   ///< In this frame for the last time; 0: never.
    std::uint32_t empty_cursor_{0}; ///< Next slot of try_empty().
    std::uint32_t frame_{kFirstFrame};
    std::uint64_t loads_{0};
    std::uint64_t evictions_{0};
};

} // namespace tactus
