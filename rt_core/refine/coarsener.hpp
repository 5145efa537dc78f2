// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/forest/vertex_forest.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/work_counters.hpp"
#include "rt_core/refine/refine_question.hpp"
#include "rt_core/refine/refine_scratch.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// Merges the records that the tools have left behind: the first phase of a refinement.
///
/// A record is left behind when its star, with all errors in it, is beyond every question's keep
/// distance, or when the faces without it are within every question's tolerance. Until a tool has
/// come that far nobody looks: the record waits in a wheel of buckets,
/// in that of the travel at which it may be left behind, and a frame looks into those that the
/// tools have passed.
///
///     passed, empty | cursor: due ...... | travel | later ......... one turn is the horizon
///
/// A record can be merged while no other one has refined a face of its star. So of each is counted
/// how many faces others have; with some it is taken from the wheel, and whoever takes the last one
/// back puts it there again, due at once. So no merge is tried in vain, and what is in the wheel is
/// refined.
///
/// Haptic thread. Every loop is bounded by the budgets and by limits.hpp.
class Coarsener
{
public:
    Coarsener(VertexForest& forest, PageTable& pages, const RefineScratch& scratch,
              float quantum_m) noexcept;

    /// The questions have moved, or their keep distances have shrunk, by at most that much.
    void follow(double farthest_m) noexcept TACTUS_NONBLOCKING;
    /// The questions are other ones: every record is due.
    void look_at_all() noexcept TACTUS_NONBLOCKING;
    /// The record, of the page in `slot`, was refined.
    void look_when_left(std::uint32_t slot, RecordId id, const VsplitRecord& record,
                        std::span<const RefineRequest> requests) noexcept TACTUS_NONBLOCKING;
    /// The record is not held any more, and due.
    void look_soon(RecordId record) noexcept TACTUS_NONBLOCKING;

    /// The forest has left: nothing is refined any more.
    void forget_all() noexcept TACTUS_NONBLOCKING;

    /// One frame: looks at up to `budgets.scanned` refined records and merges up to
    /// `budgets.merges`.
    void run(std::span<const RefineRequest> requests, const Budgets& budgets,
             WorkCounters& work) noexcept TACTUS_NONBLOCKING;

private:
    static constexpr std::uint32_t kBuckets = 256;
    static constexpr std::uint32_t kNoRecord = 0xFFFF'FFFFU;

    /// A record's page slot and its place there.
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
    /// In which bucket's stretch of the way a travel lies.
    [[nodiscard]] std::int64_t bucket_of(double travel_m) const noexcept
    {
        return static_cast<std::int64_t>(travel_m * buckets_per_m_);
    }
    void set_up_wheel(std::span<const RefineRequest> requests) noexcept;
    void list(const Place& place, std::int64_t bucket) noexcept;
    void list_when_left(const Place& place, double slack_m) noexcept;
    void look_at(const Place& place, std::span<const RefineRequest> requests,
                 WorkCounters& work) noexcept;
    [[nodiscard]] double slack_of(const VsplitRecord& record,
                                  std::span<const RefineRequest> requests) const noexcept;
    [[nodiscard]] bool is_needless(const VsplitRecord& record,
                                   std::span<const RefineRequest> requests) const noexcept;

    VertexForest* forest_;
    PageTable* pages_;
    double quantum_m_;
    std::span<PageWaits> waits_;
    /// The first record of each bucket, a turn of them from `cursor_` on. 1 KiB.
    std::array<std::uint32_t, kBuckets> heads_{};
    double horizon_m_{0.0}; ///< The way of one turn; 0: nothing was refined yet.
    double buckets_per_m_{0.0};
    std::int64_t cursor_{0}; ///< All buckets before are empty.
    double travel_{0.0};     ///< How far the questions have gone, in metres, since the start.
};

} // namespace tactus
