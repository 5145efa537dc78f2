// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/refine/coarsener.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/spm/error_code.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus
{

namespace
{

/// A record may stay while a tool goes this much farther than it has to, as a share of the keep
/// distance, so that a page has not to be looked at for each of its records.
constexpr double kPatience = 0.1;

} // namespace

Coarsener::Coarsener(VertexForest& forest, PageTable& pages, const RefineScratch& scratch,
                     float quantum_m) noexcept
    : forest_(&forest)
    , pages_(&pages)
    , quantum_m_(static_cast<double>(quantum_m))
    , stack_(scratch.stack)
    , look_at_(scratch.look_at)
    , needed_(scratch.needed)
{
    TACTUS_ASSERT(look_at_.size() == pages.capacity());
}

void Coarsener::follow(double farthest_m) noexcept
{
    TACTUS_ASSERT(farthest_m >= 0.0);
    travel_ += farthest_m;
}

void Coarsener::look_at_all() noexcept
{
    for (std::uint32_t slot = 0; slot < pages_->capacity(); ++slot)
    {
        look_at_[slot] = is_of_this_model(slot) ? travel_ : look_at_[slot];
    }
    next_look_ = travel_;
}

void Coarsener::look_when_left(std::uint32_t slot, const VsplitRecord& record,
                               std::span<const RefineRequest> requests) noexcept
{
    TACTUS_ASSERT(slot < look_at_.size());
    look_at_[slot] = std::min(look_at_[slot], travel_ + slack_of(record, requests));
    next_look_ = std::min(next_look_, look_at_[slot]);
}

void Coarsener::run(std::span<const RefineRequest> requests, const Budgets& budgets,
                    WorkCounters& work) noexcept
{
    if (travel_ < next_look_)
    {
        return;
    }
    // One round over the pages at most. Most are not due: a comparison each.
    double next = kInfinity;
    for (std::uint32_t looked = 0; looked < pages_->capacity(); ++looked)
    {
        const bool is_own = is_of_this_model(scan_slot_);
        if (is_own && look_at_[scan_slot_] <= travel_)
        {
            if (work.scanned >= budgets.scanned || work.merges >= budgets.merges)
            {
                return;
            }
            scan_page(scan_slot_, requests, budgets, work);
        }
        next = is_own ? std::min(next, look_at_[scan_slot_]) : next;
        scan_slot_ = scan_slot_ == 0 ? pages_->capacity() - 1 : scan_slot_ - 1;
    }
    next_look_ = std::max(next, travel_);
}

/// Looks at the refined records of one page, finest last in first. Unless the budget ends it, the
/// page is not due again before the tools have come far enough to leave one of them behind.
void Coarsener::scan_page(std::uint32_t slot, std::span<const RefineRequest> requests,
                          const Budgets& budgets, WorkCounters& work) noexcept
{
    const PageTable::Meta& meta = pages_->meta(slot);
    look_at_[slot] = kInfinity;
    needed_[slot] &= meta.refined;
    std::uint64_t left = meta.refined & ~meta.held & ~needed_[slot];
    const Page& page = pages_->slots().pages[slot];
    while (left != 0)
    {
        const auto place = static_cast<std::uint32_t>(63 - std::countl_zero(left));
        left &= ~(std::uint64_t{1} << place);
        if (work.scanned >= budgets.scanned)
        {
            look_at_[slot] = travel_;
            return;
        }
        const double slack = slack_of(page.records[place], requests);
        if (slack > 0.0)
        {
            ++work.scanned;
            look_at_[slot] = std::min(look_at_[slot], travel_ + slack);
            continue;
        }
        if (!merge_back({(meta.chunk.value << kRecordsPerChunkLog2) + place}, requests, budgets,
                        work))
        {
            look_at_[slot] = travel_;
            return;
        }
        left &= meta.refined;
    }
}

/// Merges a record that was left behind, then those that it was the last to depend on. False when
/// the budget is spent.
bool Coarsener::merge_back(RecordId first, std::span<const RefineRequest> requests,
                           const Budgets& budgets, WorkCounters& work) noexcept
{
    std::uint32_t depth = 0;
    stack_[depth++] = first;
    while (depth > 0)
    {
        const RecordId id = stack_[--depth];
        if (!pages_->is_refined(id))
        {
            continue; // Several faces of one record asked for it; it is merged.
        }
        if (work.scanned >= budgets.scanned || work.merges >= budgets.merges)
        {
            look_soon(id);
            for (const RecordId waiting : stack_.first(depth))
            {
                look_soon(waiting);
            }
            return false;
        }
        ++work.scanned;
        const std::uint32_t slot = pages_->find(chunk_of(id));
        TACTUS_ASSERT(slot < needed_.size());
        const VsplitRecord& record = pages_->slots().pages[slot].records[place_in_chunk(id)];
        const std::uint64_t bit = std::uint64_t{1} << place_in_chunk(id);
        needed_[slot] &= ~bit;
        if (const double slack = slack_of(record, requests); slack > 0.0)
        {
            look_at_[slot] = std::min(look_at_[slot], travel_ + slack);
            continue;
        }
        if (!forest_->try_merge(id))
        {
            needed_[slot] |= bit; // Asked again when the record that needs it is merged.
            continue;
        }
        ++work.merges;
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            const FaceState state = record.before[i];
            if (state.is_base() || !pages_->is_refined(state.record()))
            {
                continue;
            }
            if (depth < stack_.size() && !pages_->is_held(state.record()))
            {
                stack_[depth++] = state.record();
            }
            else
            {
                look_soon(state.record());
            }
        }
    }
    return true;
}

void Coarsener::look_soon(RecordId record) noexcept
{
    const std::uint32_t slot = pages_->find(chunk_of(record));
    TACTUS_ASSERT(slot < needed_.size());
    needed_[slot] &= ~(std::uint64_t{1} << place_in_chunk(record));
    look_at_[slot] = travel_;
    next_look_ = travel_;
}

/// How much farther the tools have to go before the record is left behind by all of them.
double Coarsener::slack_of(const VsplitRecord& record,
                           std::span<const RefineRequest> requests) const noexcept
{
    const double reach = static_cast<double>(error_in_quanta(record.reach)) * quantum_m_;
    const Vec3 vertex = to_vec3(record.position_m);
    double slack = 0.0;
    for_each_question(requests,
                      [&](const RefineQuestion& question)
                      {
                          const double keep = question.keep_m + reach;
                          const double distance_sq = (vertex - question.center_m).squaredNorm();
                          if (distance_sq > keep * keep)
                          {
                              return;
                          }
                          const double own_keep = question.keep_m - question.span_m;
                          const double left = question.surface == nullptr
                                                  ? keep - std::sqrt(distance_sq)
                                                  : own_keep - question.surface->lower_bound_m(
                                                                   {vertex, reach}, own_keep);
                          slack =
                              left >= 0.0 ? std::max(slack, left + kPatience * own_keep) : slack;
                      });
    return slack;
}

} // namespace tactus
