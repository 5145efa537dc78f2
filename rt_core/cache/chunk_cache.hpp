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
/// Every frame searches for chunks whose influence box meets a ranked sphere, where the
/// certificates of its searches (IndexSearch) are used up: first for pairs that touch or will soon,
/// then for the rest, each with a part of the budget that the other can't take. Such a chunk is
/// touched if resident and otherwise requested. A page may be evicted if its slot is needed, no
/// record of it is refined, and it was not touched in the last two rounds; the least recently
/// touched goes first. Within a class a chunk that is needed counts as touched kLevelAge frames
/// later than one that is predicted, and that one as much later than a chunk of the next class.
/// Prefetching therefore never evicts pages in use, while present needs may replace prefetched
/// pages, and touching pairs those of other pairs.
///
/// All models share one pool of slots. If it has no more for this model, the evicted page may be
/// another model's that has more than its reservation.
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

    /// `pages` is the model's table, `pool` that of its slots; both outlive the cache, which does
    /// not move.
    ChunkCache(CachePool& pool, const Kept& kept, const ModelHeader& header, PageSlots slots,
               PageTable& pages, const Kernels& kernels) noexcept;
    ChunkCache(const ChunkCache&) = delete;
    ChunkCache& operator=(const ChunkCache&) = delete;
    ChunkCache(ChunkCache&&) = delete;
    ChunkCache& operator=(ChunkCache&&) = delete;
    ~ChunkCache() = default;

    /// Sets the shortcuts of requests; without a call all are on.
    void set_variant(const FrameVariant& variant) noexcept { variant_ = variant; }

    /// Requests what `regions` (of this model, highest priority first) lack.
    void request_missing(std::span<const RankedRegion> regions, const Budgets& budgets,
                         std::uint32_t frame, WorkCounters& work,
                         FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// Evicts every page in which no record is refined, for models whose cache is off. One check
    /// per page.
    void evict_unpinned(WorkCounters& work) noexcept TACTUS_NONBLOCKING;

    /// Requests chunks in order until the whole model is resident; called after request_missing().
    void request_everything(const Budgets& budgets, WorkCounters& work,
                            FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// Closes the cache of a streamed model: arrivals are returned at once. Such a cache starts
    /// closed.
    void close() noexcept { is_open_ = false; }
    void open() noexcept TACTUS_NONBLOCKING;
    /// Requests the base mesh of a closed cache into cells from `first_cell` on, again if it does
    /// not arrive. The cells are the transport thread's until then.
    void want_base(std::uint32_t first_cell, std::uint32_t frame) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool has_base() const noexcept { return has_base_; }
    /// True if the cells were returned without a mesh since the last call. The mesh may be
    /// requested again a while later.
    [[nodiscard]] bool try_take_cells_back() noexcept
    {
        return std::exchange(has_cells_back_, false);
    }
    [[nodiscard]] bool may_want_base(std::uint32_t frame) const noexcept
    {
        return cells_back_ == 0 || frame - cells_back_ > pool_->request_timeout_frames_;
    }
    /// Returns all that a closed cache has, up to `most` slots per call, continuing where the last
    /// call ended: the pages, with no refined records, then the index pages, then the base mesh.
    /// False until all is returned.
    [[nodiscard]] bool try_empty(std::uint32_t most, std::uint32_t frame,
                                 WorkCounters& work) noexcept TACTUS_NONBLOCKING;

    /// First frame number, so that ages can be subtracted.
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
    /// Need for a chunk: its effective last use, and the pages that it may replace.
    struct Want
    {
        std::uint32_t touch{0};
        std::uint32_t evict_before{0};
        std::uint32_t age{0}; ///< Additional time for which another model's page must be unused.
        std::uint32_t level{0};
    };
    /// Objects of a frame's search.
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
    /// Pages not touched since were unused for two rounds.
    [[nodiscard]] std::uint32_t unused_since() const noexcept;
    void give_page_back(const Want& want, WorkCounters& work) noexcept;
    [[nodiscard]] std::uint32_t find_index_page(IndexPageId page) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] std::uint32_t lends_before(const RequestList& requests, std::uint32_t frame,
                                             std::uint32_t age) const noexcept;
    void evict_index_page(std::uint32_t slot) noexcept;
    void evict(std::uint32_t slot, WorkCounters& work) noexcept;
    [[nodiscard]] bool try_evict_index_page() noexcept;

    /// Longer than two rounds and a load take, but no longer: while a tool moves on, pages that it
    /// left occupy room that it will need.
    static constexpr std::uint32_t kLevelAge = 64;
    static_assert(kLevelAge * kWantedLevels < kFirstFrame,
                  "a touch dated back is no frame before the first");
    /// Share of the budgets that spheres of lower priority always get.
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
    std::span<IndexMeta> index_meta_; ///< Slots of all models.
    std::uint32_t index_pages_used_{0};
    RequestList chunk_requests_;
    RequestList index_requests_;
    /// Others may take pages not touched since, beyond the reservation.
    std::uint32_t lends_before_{kFirstFrame};
    std::uint32_t fill_cursor_{0}; ///< Next chunk of request_everything().
    bool is_open_{true};
    bool has_base_{false};          ///< The base mesh of a streamed model is resident.
    bool has_cells_back_{false};    ///< Cells were returned, not yet reported.
    std::uint32_t base_asked_{0};   ///< Frame of the request; 0: none.
    std::uint32_t cells_back_{0};   ///< Frame of the last return; 0: none.
    std::uint32_t empty_cursor_{0}; ///< Next slot of try_empty().
    std::uint32_t frame_{kFirstFrame};
    std::uint64_t loads_{0};
    std::uint64_t evictions_{0};
};

} // namespace tactus
