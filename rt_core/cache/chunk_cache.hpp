// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/cache/cache_pool.hpp"
#include "rt_core/cache/index_search.hpp"
#include "rt_core/cache/request_list.hpp"
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

/// Resident chunks and index pages of a model, and requests for missing ones.
///
/// Every frame searches for chunks whose influence box meets a ranked sphere: first for pairs that
/// touch or will soon, then for the others, for which a quarter of the budgets is kept. Boxes with
/// a valid certificate (IndexSearch) are skipped. A found chunk is touched if resident, otherwise
/// requested.
///
/// If a slot is needed, the least recently touched page is evicted that has no refined record and
/// was not touched in the last two rounds. A predicted chunk counts as touched kLevelAge frames
/// earlier than a needed one of its class, and the next class as much earlier again. So prefetching
/// never evicts pages in use. Present needs may replace prefetched pages, and needs of touching
/// pairs those of others.
///
/// All models share one pool of slots. If the pool has no more for this model, the evicted page may
/// be of another model with more slots than its reservation.
///
/// Haptic thread; the other end of the queues is the chunk loader's.
class ChunkCache
{
public:
    /// Reserved slots of a pool for one model.
    struct Kept
    {
        std::uint32_t pages{0};
        std::uint32_t index_pages{0};
    };

    /// `pages` is the model's page table; it and `pool` must outlive the cache, which must not
    /// move.
    ChunkCache(CachePool& pool, const Kept& kept, const ModelHeader& header, PageSlots slots,
               PageTable& pages, const Kernels& kernels) noexcept;
    ChunkCache(const ChunkCache&) = delete;
    ChunkCache& operator=(const ChunkCache&) = delete;
    ChunkCache(ChunkCache&&) = delete;
    ChunkCache& operator=(ChunkCache&&) = delete;
    ~ChunkCache() = default;

    /// Sets which shortcuts are used (FrameVariant); without a call all are.
    void set_variant(const FrameVariant& variant) noexcept { variant_ = variant; }

    /// Touches the chunks that the spheres `regions` need and requests missing ones, with their
    /// index pages. The regions are of this model, highest priority first.
    void request_missing(std::span<const RankedRegion> regions, const Budgets& budgets,
                         std::uint32_t frame, WorkCounters& work,
                         FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// Evicts every page in which no record is refined, for models whose cache is off. One check
    /// per page.
    void evict_unpinned(WorkCounters& work) noexcept TACTUS_NONBLOCKING;

    /// Requests chunks in order until the whole model is resident; called after request_missing().
    void request_everything(const Budgets& budgets, WorkCounters& work,
                            FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// Closes a streamed model's cache: pieces that arrive are returned at once.
    void close() noexcept { is_open_ = false; }
    void open() noexcept TACTUS_NONBLOCKING;
    /// Requests the base mesh of a closed cache into the cells from `first_cell` on, and repeats an
    /// expired request. The transport thread owns the cells until an answer arrives.
    void want_base(std::uint32_t first_cell, std::uint32_t frame) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool has_base() const noexcept { return has_base_; }
    /// True if the transport thread returned the cells without a base mesh since the last call.
    [[nodiscard]] bool try_take_cells_back() noexcept
    {
        return std::exchange(has_cells_back_, false);
    }
    [[nodiscard]] bool may_want_base(std::uint32_t frame) const noexcept
    {
        return cells_back_ == 0 || frame - cells_back_ > pool_->request_timeout_frames_;
    }
    /// Returns a closed cache's slots to the transport thread: pages, whose refined bits it clears,
    /// then index pages, then the base mesh. Checks `most` slots per call, continuing where the
    /// last call ended. True once all are returned.
    [[nodiscard]] bool try_empty(std::uint32_t most, std::uint32_t frame,
                                 WorkCounters& work) noexcept TACTUS_NONBLOCKING;

    /// Number of the first frame, larger than any age that is subtracted from a frame number.
    static constexpr std::uint32_t kFirstFrame = 4'096;

    /// Frames from the request of a chunk to its arrival.
    [[nodiscard]] const LoadLatency& latency() const noexcept { return chunk_requests_.latency(); }
    /// Requests without an answer yet.
    [[nodiscard]] std::uint32_t requests_under_way() const noexcept
    {
        return chunk_requests_.under_way() + index_requests_.under_way();
    }
    [[nodiscard]] std::uint64_t loads() const noexcept { return loads_; }
    [[nodiscard]] std::uint64_t evictions() const noexcept { return evictions_; }
    [[nodiscard]] std::uint32_t index_pages_used() const noexcept { return index_pages_used_; }

private:
    friend class CacheValidator;
    friend class CachePool;

    using IndexMeta = CachePool::IndexMeta;
    /// Priority of a needed chunk, as frame numbers.
    struct Want
    {
        std::uint32_t touch{0};
        std::uint32_t evict_before{0};
        /// Frames added to the time that another model's page must be unused.
        std::uint32_t age{0};
        std::uint32_t level{0};
    };
    /// A search of this frame, its spheres and its budgets.
    struct Look
    {
        IndexSearch& search;
        const SphereLanes& lanes;
        const Budgets& most;
    };

    void take(const QueueEvent& event, std::uint32_t frame) noexcept TACTUS_NONBLOCKING;
    void adopt(const QueueEvent& arrival, std::uint32_t frame) noexcept;
    void send_back(const QueueEvent& arrival, std::uint32_t frame) noexcept;
    void end_base(std::uint32_t frame) noexcept;
    [[nodiscard]] IndexSearch::Spheres to_quanta(std::span<const RankedRegion> regions,
                                                 bool are_urgent) const noexcept;
    [[nodiscard]] Want want_of(std::uint32_t level, std::uint32_t touch_level) const noexcept;
    void search(IndexSearch& search, const Budgets& most, WorkCounters& work,
                FrameFault& faults) noexcept;
    std::uint32_t search_page(IndexSearch::NearPage& near, const Look& look, WorkCounters& work,
                              FrameFault& faults) noexcept;
    void search_boxes(IndexSearch::NearPage& near, const IndexPage& index,
                      const QuantumBox& page_box, const Look& look, WorkCounters& work,
                      FrameFault& faults) noexcept;
    [[nodiscard]] bool try_touch(ChunkId chunk, const Want& want, WorkCounters& work) noexcept;
    [[nodiscard]] bool try_want(ChunkId chunk, const Want& want, const Budgets& most,
                                WorkCounters& work, FrameFault& faults) noexcept;
    [[nodiscard]] bool try_want_index_page(IndexPageId page, WorkCounters& work,
                                           FrameFault& faults) noexcept;
    void forget(IndexPageId page) noexcept;
    void begin_again() noexcept;
    /// Frame before which a page's last touch means that it was unused for two rounds.
    [[nodiscard]] std::uint32_t unused_since() const noexcept;
    void give_page_back(const Want& want, WorkCounters& work) noexcept;
    [[nodiscard]] std::uint32_t find_index_page(IndexPageId page) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] std::uint32_t lends_before(const RequestList& requests, std::uint32_t frame,
                                             std::uint32_t age) const noexcept;
    void evict_index_page(std::uint32_t slot) noexcept;
    void evict(std::uint32_t slot, WorkCounters& work) noexcept;
    [[nodiscard]] bool try_evict_index_page() noexcept;

    /// Frames by which a touch is dated back per level: just longer than two rounds and a load
    /// take. Pages that a tool has left would otherwise keep slots that it needs ahead.
    static constexpr std::uint32_t kLevelAge = 64;
    static_assert(kLevelAge * kWantedLevels < kFirstFrame,
                  "a touch dated back is no frame before the first");
    /// Divisor of the budgets: a quarter is kept for spheres of lower priority.
    static constexpr std::uint32_t kPatientShare = 4;

    CachePool* pool_;
    ModelHeader header_;
    QuantumBox extent_; ///< Box of all index pages' boxes.
    FrameVariant variant_;
    IndexSearch urgent_{kFirstFrame};  ///< Search for pairs that touch or will soon.
    IndexSearch patient_{kFirstFrame}; ///< Search for all other pairs.
    PageSlots slots_;
    PageTable* pages_;
    const Kernels* kernels_;
    std::span<IndexMeta> index_meta_; ///< State of all models' slots.
    std::uint32_t index_pages_used_{0};
    RequestList chunk_requests_;
    RequestList index_requests_;
    /// Frame before which a page's last touch lets other models take it, beyond this model's
    /// reservation.
    std::uint32_t lends_before_{kFirstFrame};
    std::uint32_t fill_cursor_{0}; ///< Next chunk of request_everything().
    bool is_open_{true};
    bool has_base_{false};          ///< The base mesh of a streamed model is resident.
    bool has_cells_back_{false};    ///< Cells were returned, not yet reported.
    std::uint32_t base_asked_{0};   ///< Frame of the base mesh's request; 0: none.
    std::uint32_t cells_back_{0};   ///< Frame of the cells' last return; 0: none.
    std::uint32_t empty_cursor_{0}; ///< Next slot of try_empty().
    std::uint32_t frame_{kFirstFrame};
    std::uint64_t loads_{0};
    std::uint64_t evictions_{0};
};

} // namespace tactus
