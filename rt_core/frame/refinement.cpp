// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/refinement.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/base/small_sort.hpp"
#include "rt_core/frame/frame_parts.hpp"
#include "rt_core/refine/split_shares.hpp"

#include <algorithm>
#include <tuple>

namespace tactus
{

namespace
{

/// Cost of a split near another surface, including its search, as a multiple of an ordinary split.
constexpr std::uint32_t kSurfaceSplit = 4;

/// Faults of full memory, which merges relieve.
constexpr FrameFault kNoRoom =
    FrameFault::forest_full | FrameFault::tree_full | FrameFault::cache_full;

} // namespace

std::uint32_t Refinement::run(FrameParts& parts, FrameAccount& account) noexcept
{
    auto& [budgets, shares, work, faults, scene] = account;
    ModelSet& models = parts.models;
    requests_.clear();
    for (Pair* pair : parts.pairs.by_priority())
    {
        pair->ask(requests_);
        had_no_room_ = had_no_room_ || pair->is_short();
        if (pair->needs_coarser_model())
        {
            // The next frame requests splits where tools need them.
            models[pair->parts().model.id].end_whole();
        }
    }
    std::fill_n(services_.begin(), requests_.size(), Service{});
    group(models);
    merge(parts, account);
    const std::uint32_t splits = std::min(budgets.splits, kMaxSplitsPerFrame);
    const SplitLimits limits{splits, pace_.splits_of(splits)};
    share_splits(parts, account, limits);
    const std::uint32_t before_filling = work.splits;
    for (const ModelId id : models.busy())
    {
        models[id].fill(splits, parts.rules.frame, work, faults);
        if (has_meshes_)
        {
            models[id].refit(work, faults);
        }
    }
    const std::uint32_t filled = work.splits - before_filling;
    serve_again(parts, account, limits);
    pace_.count(work.splits - filled);
    for (std::uint32_t i = 0; i < requests_.size(); ++i)
    {
        requests_[i].closure->late_for = lateness_of(i);
        faults |= requests_[i].closure->late_for;
    }
    had_no_room_ = (faults & kNoRoom) != FrameFault::none;
    const std::uint32_t refused = refused_class();
    for (const ModelId id : models.busy())
    {
        ModelSlot& slot = models.slot(id);
        slot.model->end_refinement(requests_of(slot), work);
    }
    return refused;
}

/// Merges records in all busy models, before any split. If capacity is short, the whole merge
/// budget is used.
void Refinement::merge(FrameParts& parts, FrameAccount& account) noexcept
{
    auto& [budgets, shares, work, faults, scene] = account;
    ModelSet& models = parts.models;
    constexpr std::uint32_t kLooksPerMerge = 5;
    Budgets steady = budgets;
    steady.merges = pace_.merges_of(std::min(budgets.merges, kMaxMergesPerFrame));
    steady.scanned = std::min(budgets.scanned, kLooksPerMerge * steady.merges);
    for (std::uint32_t i = 0; i < models.busy().size(); ++i)
    {
        ModelSlot& slot = models.slot(models.in_turn(i, parts.rules.frame));
        const VertexForest& forest = slot.model->forest;
        const bool exceeds_capacity =
            had_no_room_ || forest.active_in_pool() > 3 * (forest.capacity() / 4);
        slot.model->begin_refinement(requests_of(slot), exceeds_capacity ? budgets : steady, work);
        if (has_meshes_)
        {
            slot.model->refit(work, faults);
        }
    }
}

std::uint32_t Refinement::refused_class() const noexcept
{
    std::uint32_t refused = kPriorityClasses;
    for (std::uint32_t i = 0; i < requests_.size(); ++i)
    {
        if (has_fault(lateness_of(i), FrameFault::forest_full))
        {
            refused = std::min(refused, static_cast<std::uint32_t>(requests_[i].priority.of));
        }
    }
    return refused;
}

void Refinement::group(ModelSet& models) noexcept
{
    for (const ModelId id : models.busy())
    {
        models.slot(id).requests = 0;
    }
    by_model_.clear();
    for (const RefineRequest& request : requests_)
    {
        ++models.slot(request.model).requests;
        // Only makes by_model_ long enough; the last loop puts the requests in order.
        by_model_.push_back(request);
    }
    std::uint32_t before = 0;
    for (const ModelId id : models.busy())
    {
        models.slot(id).requests_end = before;
        before += models.slot(id).requests;
    }
    TACTUS_ASSERT(before == requests_.size()); // Models with requests are busy.
    for (const RefineRequest& request : requests_)
    {
        by_model_[models.slot(request.model).requests_end++] = request;
    }
}

std::span<const RefineRequest> Refinement::requests_of(const ModelSlot& slot) const noexcept
{
    return by_model_.view().subspan(slot.requests_end - slot.requests, slot.requests);
}

/// Gives each waiting request its share of the splits, class by class. Requests that got no share
/// for longest come first, then those with the most saved splits.
void Refinement::share_splits(FrameParts& parts, FrameAccount& account, SplitLimits limits) noexcept
{
    SplitShares shares(limits.now);
    StaticVector<std::uint32_t, kMaxRequests> waiting;
    for (std::uint32_t i = 0; i < requests_.size(); ++i)
    {
        const RefineRequest& request = requests_[i];
        if (request.is_late())
        {
            shares.add(request.priority.of);
            waiting.push_back(i);
        }
        else
        {
            request.closure->saved = shares.save_all(request.closure->saved);
            request.closure->waited = 0;
        }
    }
    const auto turn_of = [this](std::uint32_t i)
    {
        const RefineRequest& request = requests_[i];
        return std::tuple(request.priority.of, ~request.closure->waited, ~request.closure->saved,
                          i);
    };
    sort_without_recursion(waiting, [&turn_of](std::uint32_t a, std::uint32_t b)
                           { return turn_of(a) < turn_of(b); });
    for (const std::uint32_t i : waiting)
    {
        Closure& closure = *requests_[i].closure;
        const std::uint32_t before = account.work.splits;
        const SplitShares::Share share =
            shares.take(requests_[i].priority.of, closure.saved, before);
        serve(parts, account, i, {share.limit, std::min(share.limit, limits.later)});
        closure.saved = shares.save(closure.saved, share.equal, account.work.splits - before);
        closure.waited = share.equal == 0 ? closure.waited + 1 : 0;
    }
}

/// Serves late requests with the splits that are left, then requests that may wait.
void Refinement::serve_again(FrameParts& parts, FrameAccount& account, SplitLimits limits) noexcept
{
    const WorkCounters& work = account.work;
    for (std::uint32_t i = 0; i < requests_.size() && work.splits < limits.now; ++i)
    {
        // A request that stopped before its limit can only proceed if others have split since.
        const Service& last = services_[i];
        const bool may_go_on = last.limits.now < limits.now || last.splits != work.splits;
        // Near another surface, a repeated search is too expensive.
        const bool has_had_enough =
            requests_[i].is_near_surface() &&
            has_fault(last.found, FrameFault::split_budget_spent | FrameFault::chunk_late);
        if (may_go_on && !has_had_enough && requests_[i].is_late())
        {
            serve(parts, account, i, limits);
        }
    }
    for (std::uint32_t i = 0; i < requests_.size(); ++i)
    {
        // Even without splits, an open closure that is no longer needed is released.
        const bool may_wait = requests_[i].is_open() && !requests_[i].is_late();
        if (may_wait && services_[i].limits.later < limits.later)
        {
            serve(parts, account, i, limits);
        }
    }
}

void Refinement::serve(FrameParts& parts, FrameAccount& account, std::uint32_t request,
                       SplitLimits limits) noexcept
{
    auto& [budgets, shares, work, faults, scene] = account;
    Model& model = parts.models[requests_[request].model];
    work.budget.spend(WorkCost::refining);
    model.refit(work, faults); // The tree must include the splits and merges of other requests.
    SplitLimits own = limits;
    if (requests_[request].is_near_surface())
    {
        const std::uint32_t left = limits.now - std::min(limits.now, work.splits);
        own.now = std::min(limits.now, work.splits) + (left + kSurfaceSplit - 1) / kSurfaceSplit;
        own.later = std::min(own.now, limits.later);
    }
    const FrameFault found =
        model.refiner.refine(requests_[request], own, budgets, parts.rules.frame, work);
    services_[request] = {limits, work.splits, found};
    if (has_meshes_)
    {
        model.refit(work, faults);
    }
}

/// Faults of a request, which count only if faces within its reach are still coarse; an
/// inconsistent model always counts.
FrameFault Refinement::lateness_of(std::uint32_t request) const noexcept
{
    const FrameFault found = services_[request].found;
    if (!requests_[request].is_late())
    {
        return found & FrameFault::model_inconsistent;
    }
    return found == FrameFault::none ? FrameFault::split_budget_spent : found;
}

} // namespace tactus
