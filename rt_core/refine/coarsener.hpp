// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/forest/vertex_forest.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/work_counters.hpp"
#include "rt_core/refine/refine_question.hpp"
#include "rt_core/refine/refine_scratch.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

/// Merges the records that the tools have left behind: the first phase of a refinement.
///
/// A record is left behind when its star, with all errors in it, is beyond every question's keep
/// distance. Until a tool has come that far nobody looks: each page remembers after how much more
/// travel of the tools one of its records may be left behind.
///
/// Haptic thread. Every loop is bounded by the budgets and by limits.hpp.
class Coarsener
{
public:
    /// Of the scratch it uses the stack while run() runs.
    Coarsener(VertexForest& forest, PageTable& pages, const RefineScratch& scratch,
              float quantum_m) noexcept;

    /// The questions have moved, or their keep distances have shrunk, by at most that much.
    void follow(double farthest_m) noexcept TACTUS_NONBLOCKING;
    /// The questions are other ones: every page is due.
    void look_at_all() noexcept TACTUS_NONBLOCKING;
    /// A record of the page in `slot` was refined.
    void look_when_left(std::uint32_t slot, const VsplitRecord& record,
                        std::span<const RefineRequest> requests) noexcept TACTUS_NONBLOCKING;
    /// The record's page is due, and the record may be asked again.
    void look_soon(RecordId record) noexcept TACTUS_NONBLOCKING;

    /// One frame: looks at up to `budgets.scanned` refined records and merges up to
    /// `budgets.merges`. One comparison a page for those that are not due.
    void run(std::span<const RefineRequest> requests, const Budgets& budgets,
             WorkCounters& work) noexcept TACTUS_NONBLOCKING;

private:
    void scan_page(std::uint32_t slot, std::span<const RefineRequest> requests,
                   const Budgets& budgets, WorkCounters& work) noexcept;
    [[nodiscard]] bool merge_back(RecordId first, std::span<const RefineRequest> requests,
                                  const Budgets& budgets, WorkCounters& work) noexcept;
    [[nodiscard]] double slack_of(const VsplitRecord& record,
                                  std::span<const RefineRequest> requests) const noexcept;

    /// Or was, as long as no other takes the slot.
    [[nodiscard]] bool is_of_this_model(std::uint32_t slot) const noexcept
    {
        return pages_->meta(slot).owner == pages_->owner();
    }

    VertexForest* forest_;
    PageTable* pages_;
    double quantum_m_;
    std::span<RecordId> stack_;
    /// By page slot of all models: the travel from which on some record in it may be left behind.
    std::span<double> look_at_;
    /// By page slot, one bit a record: left behind, but another refined record depends on it.
    std::span<std::uint64_t> needed_;
    double next_look_{0.0}; ///< The least of them, or less.
    double travel_{0.0};    ///< How far the questions have gone, in metres, since the start.
    std::uint32_t scan_slot_{0};
};

} // namespace tactus
