// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/refine/coarsener.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/forest/vertex_forest.hpp"
#include "rt_core/query/other_surface.hpp"
#include "rt_core/spm/error_code.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus
{

namespace
{

/// Distance, as a share of the keep distance, that a tool may go beyond a record's slack before the
/// record is checked, so that it is not checked at every step.
constexpr double kPatience = 0.1;
/// Travel of one turn of the wheel, as a multiple of the largest keep distance at its set-up. A
/// record with more slack is first checked when that travel is used up.
constexpr double kHorizon = 4.0;

} // namespace

Coarsener::Coarsener(VertexForest& forest, PageTable& pages, const RefineScratch& scratch,
                     float quantum_m) noexcept
    : forest_(&forest)
    , pages_(&pages)
    , quantum_m_(static_cast<double>(quantum_m))
    , waits_(scratch.waits)
{
    TACTUS_ASSERT(waits_.size() == pages.capacity());
    heads_.fill(kNoRecord);
}

void Coarsener::add_travel(double farthest_m) noexcept
{
    TACTUS_ASSERT(farthest_m >= 0.0);
    travel_ += farthest_m;
}

/// Increases the travel so that every record in the wheel is due.
void Coarsener::mark_all_due() noexcept
{
    travel_ += horizon_m_;
}

void Coarsener::forget_all() noexcept
{
    heads_.fill(kNoRecord);
    horizon_m_ = 0.0;
    buckets_per_m_ = 0.0;
    cursor_ = 0;
    travel_ = 0.0;
}

void Coarsener::list_refined(std::uint32_t slot, RecordId id, const VsplitRecord& record,
                             std::span<const RefineRequest> requests) noexcept
{
    TACTUS_ASSERT(slot < waits_.size());
    if (horizon_m_ == 0.0)
    {
        set_up_wheel(requests);
    }
    const Place place{slot, place_in_chunk(id)};
    if (pages_->meta(slot).refined == place.bit())
    {
        waits_[slot] = PageWaits{}; // The slot may have been another model's.
    }
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        if (const FaceState state = record.before[i]; !state.is_base())
        {
            const Place before = place_of(state.record());
            ++waits_[before.slot].dependents[before.record];
        }
    }
    list_when_left(place, slack_of(record, requests));
}

void Coarsener::set_up_wheel(std::span<const RefineRequest> requests) noexcept
{
    double keep_m = quantum_m_;
    for_each_question(requests, [&](const RefineQuestion& question)
                      { keep_m = std::max(keep_m, question.keep_m); });
    horizon_m_ = kHorizon * keep_m;
    buckets_per_m_ = kBuckets / horizon_m_;
    cursor_ = bucket_of(travel_);
}

/// Lists a record: due now without slack, otherwise in the first bucket that begins when the slack
/// is used up.
void Coarsener::list_when_left(const Place& place, double slack_m) noexcept
{
    list(place, slack_m > 0.0 ? bucket_of(travel_ + slack_m) + 1 : cursor_);
}

void Coarsener::list(const Place& place, std::int64_t bucket) noexcept
{
    PageWaits& waits = waits_[place.slot];
    if ((waits.listed & place.bit()) != 0)
    {
        return; // Already in a bucket, where it will be checked.
    }
    waits.listed |= place.bit();
    const std::int64_t within = std::clamp(bucket, cursor_, cursor_ + kBuckets - 1);
    std::uint32_t& head = heads_[static_cast<std::size_t>(within) % kBuckets];
    waits.next[place.record] = std::exchange(head, place.slot * kRecordsPerChunk + place.record);
}

void Coarsener::run(std::span<const RefineRequest> requests, const Budgets& budgets,
                    WorkCounters& work) noexcept
{
    const std::int64_t now = bucket_of(travel_);
    // All records in the wheel are within one turn, so none is passed twice in a frame.
    cursor_ = std::max(cursor_, now - kBuckets);
    for (;; ++cursor_)
    {
        std::uint32_t& head = heads_[static_cast<std::size_t>(cursor_) % kBuckets];
        while (head != kNoRecord)
        {
            if (work.scanned >= budgets.scanned || work.merges >= budgets.merges ||
                (work.scanned > 0 && work.budget.is_spent()))
            {
                return;
            }
            const Place place{head / kRecordsPerChunk, head % kRecordsPerChunk};
            head = waits_[place.slot].next[place.record];
            examine(place, requests, work);
        }
        if (cursor_ >= now)
        {
            return;
        }
    }
}

/// Checks a record taken from the wheel: merges it, lists it where it is due next, or leaves it
/// unlisted while it is held or others refined its faces further.
void Coarsener::examine(const Place& place, std::span<const RefineRequest> requests,
                        WorkCounters& work) noexcept
{
    PageWaits& waits = waits_[place.slot];
    const PageTable::Meta& meta = pages_->meta(place.slot);
    TACTUS_ASSERT((waits.listed & place.bit()) != 0);
    TACTUS_ASSERT((meta.refined & place.bit()) != 0);
    waits.listed &= ~place.bit();
    if ((meta.held & place.bit()) != 0 || waits.dependents[place.record] != 0)
    {
        return;
    }
    ++work.scanned;
    work.budget.spend(WorkCost::scan);
    const VsplitRecord& record = pages_->slots().pages[place.slot].records[place.record];
    const double slack = slack_of(record, requests);
    if (slack > 0.0 && !is_needless(record, requests))
    {
        list_when_left(place, slack);
        return;
    }
    const bool is_merged =
        forest_->try_merge({(meta.chunk.value << kRecordsPerChunkLog2) + place.record});
    TACTUS_ASSERT(is_merged);
    ++work.merges;
    work.budget.spend(WorkCost::merge);
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        if (const FaceState state = record.before[i]; !state.is_base())
        {
            const Place before = place_of(state.record());
            TACTUS_ASSERT(waits_[before.slot].dependents[before.record] > 0);
            if (--waits_[before.slot].dependents[before.record] == 0)
            {
                list(before, cursor_);
            }
        }
    }
}

void Coarsener::mark_due(RecordId record) noexcept
{
    list(place_of(record), cursor_);
}

/// True if the faces without the record have errors within the tolerance of all questions.
bool Coarsener::is_needless(const VsplitRecord& record,
                            std::span<const RefineRequest> requests) const noexcept
{
    ErrorCode least = 255;
    for_each_question(requests, [&](const RefineQuestion& question)
                      { least = std::min(least, question.tolerance); });
    return least != 0 && std::ranges::max(record.error) <= least &&
           forest_->error_before(record) <= least &&
           !forest_->may_be_removed_near(
               record.position_m, static_cast<double>(error_in_quanta(record.reach)) * quantum_m_);
}

/// Distance that the tools have to go before all of them leave the record behind.
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
