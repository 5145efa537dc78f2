// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/work_counters.hpp"
#include "rt_core/refine/refine_question.hpp"
#include "rt_core/refine/refine_scratch.hpp"
#include "rt_core/spm/ids.hpp"
#include "rt_core/spm/page_table.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

class VertexForest;

/// Merges the records that the tools have left behind: the first phase of a refinement.
///
/// A record is left behind if its star, errors added, is beyond every question's keep distance, or
/// if the faces after its merge are within every question's tolerance. The record's slack is the
/// travel of the tools before the former can happen. The record waits in a wheel of buckets by
/// travel, and a frame checks the buckets that the tools have passed.
///
///     passed, empty | cursor: due ...... | travel | later ......... one turn is the horizon
///
/// A record can be merged only while no other record has refined a face of its star, so those faces
/// are counted. While there are any, the record is out of the wheel; the merge of the last one
/// lists it again, due at once. So no merge is tried in vain, and every record in the wheel is
/// refined.
///
/// Haptic thread. Every loop is bounded by the budgets and by limits.hpp.
class Coarsener
{
public:
    Coarsener(VertexForest& forest, PageTable& pages, const RefineScratch& scratch,
              float quantum_m) noexcept;

    /// Adds `farthest_m` to the travel: a bound on every question's motion since the last frame,
    /// plus the shrinkage of its keep distance.
    void add_travel(double farthest_m) noexcept TACTUS_NONBLOCKING;
    /// Makes every record due, because the questions changed.
    void mark_all_due() noexcept TACTUS_NONBLOCKING;
    /// Lists a record that was just refined; `slot` is its page's.
    void list_refined(std::uint32_t slot, RecordId id, const VsplitRecord& record,
                      std::span<const RefineRequest> requests) noexcept TACTUS_NONBLOCKING;
    /// Lists a record that is no longer held: due at once, unless it is in a bucket already.
    void mark_due(RecordId record) noexcept TACTUS_NONBLOCKING;

    /// Resets the wheel; no record may be refined any more (VertexForest::leave()).
    void forget_all() noexcept TACTUS_NONBLOCKING;

    /// One frame: checks up to `budgets.scanned` refined records and merges up to `budgets.merges`.
    void run(std::span<const RefineRequest> requests, const Budgets& budgets,
             WorkCounters& work) noexcept TACTUS_NONBLOCKING;

private:
    static constexpr std::uint32_t kBuckets = 256;
    static constexpr std::uint32_t kNoRecord = 0xFFFF'FFFFU;

    /// A record's page slot and its place in the page.
    struct Place
    {
        std::uint32_t slot{0};
        std::uint32_t record{0};

        [[nodiscard]] std::uint64_t bit() const noexcept { return std::uint64_t{1} << record; }
    };

    [[nodiscard]] Place place_of(RecordId record) const noexcept
    {
        return {pages_->find(chunk_of(record)), place_in_chunk(record)};
    }
    /// Number of the bucket for a travel, not yet modulo kBuckets.
    [[nodiscard]] std::int64_t bucket_of(double travel_m) const noexcept
    {
        return static_cast<std::int64_t>(travel_m * buckets_per_m_);
    }
    void set_up_wheel(std::span<const RefineRequest> requests) noexcept;
    void list(const Place& place, std::int64_t bucket) noexcept;
    void list_when_left(const Place& place, double slack_m) noexcept;
    void examine(const Place& place, std::span<const RefineRequest> requests,
                 WorkCounters& work) noexcept;
    [[nodiscard]] double slack_of(const VsplitRecord& record,
                                  std::span<const RefineRequest> requests) const noexcept;
    [[nodiscard]] bool is_needless(const VsplitRecord& record,
                                   std::span<const RefineRequest> requests) const noexcept;

    VertexForest* forest_;
    PageTable* pages_;
    double quantum_m_;
    std::span<PageWaits> waits_;
    /// First record of each bucket, for one turn from `cursor_` on. 1 KiB.
    std::array<std::uint32_t, kBuckets> heads_{};
    double horizon_m_{0.0}; ///< Travel of one turn; 0: nothing was refined yet.
    double buckets_per_m_{0.0};
    std::int64_t cursor_{0}; ///< All buckets before it are empty.
    double travel_{0.0};     ///< Travel of the questions since the start, in metres.
};

} // namespace tactus
