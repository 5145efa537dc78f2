// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/refine/refiner.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/query/near_faces.hpp"
#include "rt_core/query/other_surface.hpp"
#include "rt_core/query/probe.hpp"
#include "rt_core/query/tree_walk.hpp"
#include "rt_core/query/unfinished_search.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// Splits of one refine() whose new faces are measured against another surface one by one. After
/// more splits one walk for all faces is cheaper.
constexpr std::uint32_t kMeasuredStars = 8;
/// Coarse faces to find near another surface: this many for each allowed split, and at least the
/// number below, as the records of some are not resident.
constexpr std::uint32_t kFacesPerSplit = 2;
constexpr std::uint32_t kLeastFaces = 16;

/// Order of the heap: highest priority first; among equals the lower slot, so that the order is the
/// same in every run. A function object, since a function would be called through a pointer.
constexpr auto comes_later = [](const auto& a, const auto& b) noexcept
{ return a.excess_m != b.excess_m ? a.excess_m > b.excess_m : a.prim > b.prim; };

double target_of(const RefineQuestion& question) noexcept
{
    const double look_ahead = question.later_m > 0.0 ? 0.0 : Refiner::kLookAhead;
    return question.reach_m + look_ahead * (question.reach_m - question.span_m) + question.ahead_m;
}

/// Excess of a face (RefineCandidate); `lower_m` is its distance minus error from the question's
/// centre.
double excess_of(const RefineQuestion& question, double lower_m) noexcept
{
    return lower_m - question.reach_m + question.later_m;
}

/// Part of a face's error that is subtracted from its distance.
double counted(const RefineQuestion& question, double error_m) noexcept
{
    return question.counts_errors ? error_m : 0.0;
}

/// Part of a face's error that is not subtracted from its distance.
double not_counted(const RefineQuestion& question, double error_m) noexcept
{
    return error_m - counted(question, error_m);
}

/// Lowers the certificate for a coarse face that stays, whose distance minus its error is
/// `lower_m`.
void leave(const RefineQuestion& question, double lower_m) noexcept
{
    question.memory->certified_m = std::min(question.memory->certified_m, lower_m);
}

/// Lowers the questions' certificates for a coarse face that stays, by its excess.
void leave_at(std::span<const RefineQuestion> questions, double excess_m) noexcept
{
    for (const RefineQuestion& question : questions)
    {
        leave(question, question.reach_m - question.later_m + excess_m);
    }
}

/// Lanes of coarse faces with errors above the tolerance, one bit each.
std::uint32_t lanes_above(ErrorCode tolerance, std::uint32_t coarse, const auto& errors) noexcept
{
    std::uint32_t open = coarse;
    for (std::uint32_t lanes = tolerance != 0 ? coarse : 0; lanes != 0; lanes &= lanes - 1)
    {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        open &= errors[lane] > tolerance ? ~0U : ~(1U << lane);
    }
    return open;
}

/// Distance to the triangle's box: a cheap lower bound on the distance to the triangle.
double box_distance_sq(const Vec3& point, const Triangle& triangle) noexcept
{
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double a = triangle[0][axis];
        const double b = triangle[1][axis];
        const double c = triangle[2][axis];
        const double below = std::min({a, b, c}) - point[axis];
        const double above = point[axis] - std::max({a, b, c});
        const double gap = std::max({below, above, 0.0});
        sum += gap * gap;
    }
    return sum;
}

} // namespace

Refiner::Refiner(VertexForest& forest, PageTable& pages, const AbTree& tree, RefineScratch& scratch,
                 float quantum_m) noexcept
    : forest_(&forest)
    , pages_(&pages)
    , tree_(&tree)
    , coarsener_(forest, pages, scratch, quantum_m)
    , quantum_m_(static_cast<double>(quantum_m))
    , scratch_(&scratch)
    , heap_(scratch.heap)
    , stack_(scratch.stack)
    , done_(scratch.done)
{
}

void Refiner::forget_all() noexcept
{
    coarsener_.forget_all();
    next_record_ = 0;
}

void Refiner::begin(std::span<const RefineRequest> requests, const Budgets& budgets,
                    WorkCounters& work) noexcept
{
    requests_ = requests;
    questions_ = 0;
    for_each_question(requests_, [&](const RefineQuestion& /*question*/) { ++questions_; });
    for (const RefineRequest& request : requests)
    {
        if (request.questions.empty())
        {
            release(*request.closure);
        }
    }
    update_certificates();
    const std::uint32_t merges_before = work.merges;
    Budgets within = budgets;
    within.merges = std::min(budgets.merges, kMaxMergesPerFrame);
    coarsener_.run(requests_, within, work);
    for_each_question(requests_,
                      [&](const RefineQuestion& question)
                      {
                          if (work.merges != merges_before)
                          {
                              // Merged faces are beyond every keep distance, but no farther.
                              leave(question, question.keep_m);
                          }
                          work.skipped.add(Skip::regions, is_wanting(question) ? 0 : 1);
                      });
}

FrameFault Refiner::refine(const RefineRequest& request, SplitLimits limits, const Budgets& budgets,
                           std::uint32_t frame, WorkCounters& work) noexcept
{
    TACTUS_ASSERT(limits.now <= kMaxSplitsPerFrame);
    TACTUS_ASSERT(limits.later <= limits.now);
    FrameFault found = FrameFault::none;
    stars_left_ = kMeasuredStars;
    given_up_ = FrameFault::none;
    const std::uint32_t before = work.splits;
    const std::uint32_t splits = limits.now - std::min(limits.now, before);
    const std::uint32_t enough = std::max(kFacesPerSplit * splits, kLeastFaces);
    const bool is_all = gather(request, limits, enough, budgets, work, found);
    split_wanted(request, limits, frame, work, found);
    if (!is_all && work.splits == before && splits > 0)
    {
        // None of the faces found can be split now, but others may.
        (void)gather(request, limits, NearFaces::kAll, budgets, work, found);
        split_wanted(request, limits, frame, work, found);
    }
    return found | given_up_;
}

/// Finds the coarse faces for all of a request's questions; false if a search near another surface
/// ended with `enough` of them.
bool Refiner::gather(const RefineRequest& request, SplitLimits limits, std::uint32_t enough,
                     const Budgets& budgets, WorkCounters& work, FrameFault& found) noexcept
{
    heap_size_ = 0;
    bool is_all = true;
    for (const bool may_wait : {false, true})
    {
        // Faces are not searched if those found already exceed the allowed splits.
        const bool is_of_use = !may_wait || work.splits + heap_size_ < limits.later;
        for (const RefineQuestion& question : request.questions)
        {
            if (is_of_use && (question.later_m > 0.0) == may_wait && is_wanting(question))
            {
                is_all = gather(question, enough, budgets, work, found) && is_all;
            }
        }
    }
    return is_all;
}

/// Lowers certificates by their questions' motion, and adds the largest motion to the coarsener's
/// travel.
void Refiner::update_certificates() noexcept
{
    double farthest = 0.0;
    std::size_t count = 0;
    bool is_same = true;
    for_each_question(requests_,
                      [&](const RefineQuestion& question)
                      {
                          ++count;
                          update_certificate(question, farthest, is_same);
                      });
    is_same = is_same && count == question_count_;
    question_count_ = count;
    coarsener_.add_travel(farthest);
    if (!is_same)
    {
        coarsener_.mark_all_due();
    }
}

void Refiner::update_certificate(const RefineQuestion& question, double& farthest_m,
                                 bool& is_same) noexcept
{
    TACTUS_ASSERT(question.memory != nullptr);
    TACTUS_ASSERT(question.reach_m >= 0.0);
    TACTUS_ASSERT(question.keep_m >= question.reach_m);
    TACTUS_ASSERT(!is_beyond_kernels(question.center_m, tree_->quantum_m()));
    RefineMemory& memory = *question.memory;
    memory.probe = make_probe(question.center_m, tree_->quantum_m());
    if (!memory.is_known || memory.tolerance != question.tolerance)
    {
        memory.tolerance = question.tolerance;
        memory.center_m = question.center_m;
        memory.keep_m = question.keep_m;
        memory.certified_m = 0.0;
        memory.is_known = true;
        is_same = false;
        if (question.unfinished != nullptr)
        {
            question.unfinished->left.clear();
        }
        return;
    }
    const double moved = question.surface != nullptr
                             ? question.moved_m
                             : (question.center_m - memory.center_m).norm() * kWidened;
    farthest_m = std::max(farthest_m, moved + std::max(0.0, memory.keep_m - question.keep_m));
    memory.certified_m = tree_->is_complete() ? memory.certified_m - moved : 0.0;
    if (question.unfinished != nullptr)
    {
        drop_outdated_search(moved, question.reach_m - question.span_m, *question.unfinished);
    }
    memory.center_m = question.center_m;
    memory.keep_m = question.keep_m;
}

/// Drops an unfinished search whose bound, less the motion since, does not cover the needed
/// distance.
void Refiner::drop_outdated_search(double moved_m, double needed_m,
                                   UnfinishedSearch& unfinished) noexcept
{
    unfinished.moved_m += moved_m;
    if (!(unfinished.bound_m - unfinished.moved_m > needed_m))
    {
        unfinished.left.clear();
    }
}

/// Finds the coarse faces within target_of() the question, and sets its certificate to the distance
/// that was searched.
bool Refiner::gather(const RefineQuestion& question, std::uint32_t enough, const Budgets& budgets,
                     WorkCounters& work, FrameFault& found) noexcept
{
    question.memory->certified_m = tree_->is_complete() ? target_of(question) : 0.0;
    if (question.surface != nullptr)
    {
        return gather_near_surface(question, enough);
    }
    WalkBudget budget{walk_left(budgets.nodes, work.nodes_visited),
                      walk_left(budgets.triangles, work.triangles_tested)};
    budget.frame = &work.budget;
    gather_near_sphere(question, budget);
    found |= budget.is_spent ? FrameFault::node_budget_spent : FrameFault::none;
    work.nodes_visited += budget.nodes_visited;
    work.triangles_tested += budget.triangles_tested;
    return true;
}

void Refiner::gather_near_sphere(const RefineQuestion& question, WalkBudget& budget) noexcept
{
    const float bound = round_up_to_float(target_of(question) / quantum_m_);
    TreeWalk walk(*tree_, question.memory->probe, budget);
    for (std::uint32_t block = walk.next_block(bound, true); block != kNoNode;
         block = walk.next_block(bound, true))
    {
        if (!budget.take_triangles(
                static_cast<std::uint32_t>(std::popcount(tree_->side(block).coarse))))
        {
            leave(question, 0.0);
            break;
        }
        gather_block(block, question);
    }
    for (const WalkItem& item : walk.left())
    {
        leave(question, static_cast<double>(item.gap) * quantum_m_);
    }
}

bool Refiner::gather_near_surface(const RefineQuestion& question, std::uint32_t enough) noexcept
{
    NearFaces near(*tree_, *question.surface, question.tolerance);
    near.find(target_of(question) - question.span_m, enough, question.unfinished);
    std::uint32_t faces = 0;
    leave(question, near.rest_m() + question.span_m);
    for (const NearFaces::Block& block : near.blocks())
    {
        const BlockSide& side = tree_->side(block.index);
        faces += count_lanes(block.lanes);
        for (std::uint32_t lanes = block.lanes; lanes != 0; lanes &= lanes - 1)
        {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
            const double bound =
                static_cast<double>(error_in_quanta(side.errors[lane])) * quantum_m_;
            take(side.prims[lane],
                 near.gap_m(block, lane) + not_counted(question, bound) + question.span_m,
                 question);
        }
    }
    return faces < enough;
}

void Refiner::gather_block(std::uint32_t index, const RefineQuestion& question) noexcept
{
    const BlockGeometry& block = tree_->block(index);
    const BlockSide& side = tree_->side(index);
    const std::uint32_t coarse = lanes_above(side, question.tolerance);
    FaceBounds bounds; // NOLINT(cppcoreguidelines-pro-type-member-init): the kernel fills it.
    bound_faces(tree_->kernels(), block, coarse, question.memory->probe, bounds);
    for (std::uint32_t lanes = coarse; lanes != 0; lanes &= lanes - 1)
    {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        const double bound = static_cast<double>(error_in_quanta(side.errors[lane])) * quantum_m_;
        take(side.prims[lane],
             static_cast<double>(bounds.lower[lane]) * quantum_m_ - counted(question, bound),
             question);
    }
}

/// Adds a coarse face to the heap, or lowers the certificate if it is beyond the target. `lower_m`
/// is a lower bound on its distance minus error.
void Refiner::take(PrimId prim, double lower_m, const RefineQuestion& question) noexcept
{
    if (lower_m <= target_of(question))
    {
        push({excess_of(question, lower_m), prim, forest_->face(prim).state}, {&question, 1});
    }
    else
    {
        leave(question, lower_m);
    }
}

void Refiner::split_wanted(const RefineRequest& request, SplitLimits limits, std::uint32_t frame,
                           WorkCounters& work, FrameFault& found) noexcept
{
    const std::span<const RefineQuestion> own = request.questions;
    Closure& closure = *request.closure;
    double pending_excess = excess_of_pending(request);
    if (!(pending_excess < kInfinity))
    {
        release(closure);
    }
    bool can_go_on = true;
    while (can_go_on && (heap_size_ > 0 || pending_excess < kInfinity))
    {
        Wanted wanted{closure.target, pending_excess};
        if (heap_size_ > 0 && heap_[0].excess_m < pending_excess)
        {
            const Candidate candidate = pop();
            if (!is_current(candidate))
            {
                continue;
            }
            wanted = {RecordId{forest_->next_of(candidate.prim)}, candidate.excess_m};
        }
        else
        {
            pending_excess = kInfinity;
            if (pages_->is_refined(wanted.record))
            {
                release(closure); // Split meanwhile for a nearer face or another pair.
                continue;
            }
        }
        if (wanted.record.value >= kNextPending)
        {
            found |= FrameFault::chunk_late;
            leave_at(own, wanted.excess_m);
            continue;
        }
        can_go_on = try_advance(wanted, request, wanted.excess_m <= 0.0 ? limits.now : limits.later,
                                frame, work, found);
    }
    // The certificate ends at the nearest face that was not reached.
    leave_at(own, std::min(pending_excess, heap_size_ > 0 ? heap_[0].excess_m : kInfinity));
}

/// Least excess of the faces for which the open closure was begun; infinity if none of them is
/// coarse and within the target any more.
double Refiner::excess_of_pending(const RefineRequest& request) const noexcept
{
    const RecordId target = request.closure->target;
    const VsplitRecord* record = target.is_none() ? nullptr : pages_->find_linked(target);
    double excess = kInfinity;
    for (std::uint32_t i = 0; record != nullptr && i < record->fan_size; ++i)
    {
        const PrimId prim = forest_->find(record->star[2 + i]);
        if (prim.is_none() || forest_->face(prim).state != record->before[i])
        {
            continue;
        }
        for (const RefineQuestion& question : request.questions)
        {
            if (forest_->error_of(prim) <= question.tolerance)
            {
                continue;
            }
            const double lower = lower_bound(prim, question);
            excess = lower <= target_of(question) ? std::min(excess, excess_of(question, lower))
                                                  : excess;
        }
    }
    return excess;
}

/// Splits towards a wanted record; false if nothing more can be split for the request.
bool Refiner::try_advance(const Wanted& wanted, const RefineRequest& request, std::uint32_t limit,
                          std::uint32_t frame, WorkCounters& work, FrameFault& found) noexcept
{
    Closure& closure = *request.closure;
    const ClosureOutcome outcome =
        split_with_closure(wanted.record, request.questions, limit, frame, work, found);
    if (outcome != ClosureOutcome::complete)
    {
        leave_at(request.questions, wanted.excess_m);
    }
    if (outcome == ClosureOutcome::complete || outcome == ClosureOutcome::blocked)
    {
        if (wanted.record == closure.target)
        {
            release(closure);
        }
        return true;
    }
    closure.target = wanted.record;
    for (std::uint32_t i = 0; i < done_count_; ++i)
    {
        hold(done_[i], closure);
    }
    found |=
        outcome == ClosureOutcome::full ? FrameFault::forest_full : FrameFault::split_budget_spent;
    return false;
}

/// Splits, depth first, the records that must be split before `target`, then `target`. The stack
/// never exceeds the model's largest depth.
Refiner::ClosureOutcome Refiner::split_with_closure(RecordId target,
                                                    std::span<const RefineQuestion> own,
                                                    std::uint32_t limit, std::uint32_t frame,
                                                    WorkCounters& work, FrameFault& found) noexcept
{
    TACTUS_ASSERT(!target.is_none());
    done_count_ = 0;
    std::uint32_t depth = 0;
    stack_[depth++] = target;
    while (depth > 0)
    {
        const RecordId id = stack_[depth - 1];
        const std::uint32_t slot = pages_->find(chunk_of(id));
        const VsplitRecord* record =
            slot == IdTable::kAbsent ? nullptr : pages_->find_linked(id, slot);
        if (record == nullptr)
        {
            found |= FrameFault::chunk_late;
            return ClosureOutcome::blocked;
        }
        pages_->touch(slot, frame);
        if (const RecordId missing = forest_->missing_dependency(*record); !missing.is_none())
        {
            TACTUS_ASSERT(depth < stack_.size());
            stack_[depth++] = missing;
            continue;
        }
        // One split is allowed even with a spent budget: every frame makes progress.
        if (work.splits >= limit || (work.splits > 0 && work.budget.is_spent()))
        {
            return ClosureOutcome::budget_spent;
        }
        if (!tree_->has_room_for(kMaxStarFaces))
        {
            return ClosureOutcome::full;
        }
        VertexForest::StarGeometry star;
        switch (forest_->split(id, *record, star))
        {
        case VertexForest::SplitOutcome::full:
            return ClosureOutcome::full;
        case VertexForest::SplitOutcome::inconsistent:
            found |= FrameFault::model_inconsistent;
            return ClosureOutcome::blocked;
        case VertexForest::SplitOutcome::done:
            ++work.splits;
            work.budget.spend(WorkCost::split + questions_ * WorkCost::question);
            TACTUS_ASSERT(done_count_ < done_.size());
            done_[done_count_++] = id;
            --depth;
            coarsener_.list_refined(slot, id, *record,
                                    is_filling_ ? std::span<const RefineRequest>{} : requests_);
            consider_star(id, *record, star, own, limit - work.splits);
        }
    }
    return ClosureOutcome::complete;
}

Refiner::Progress Refiner::fill(std::uint32_t records, std::uint32_t limit, std::uint32_t frame,
                                WorkCounters& work, FrameFault& faults) noexcept
{
    TACTUS_ASSERT(next_record_ <= records);
    TACTUS_ASSERT(limit <= kMaxSplitsPerFrame);
    while (next_record_ < records && work.splits < limit)
    {
        if (!pages_->is_refined({next_record_}))
        {
            FrameFault found = FrameFault::none; // A chunk that is still loading is no fault here.
            is_filling_ = true;
            const ClosureOutcome outcome =
                split_with_closure({next_record_}, {}, limit, frame, work, found);
            is_filling_ = false;
            faults |= found & FrameFault::model_inconsistent;
            if (outcome != ClosureOutcome::complete)
            {
                return outcome == ClosureOutcome::full ? Progress::full : Progress::under_way;
            }
        }
        ++next_record_;
    }
    return next_record_ == records ? Progress::complete : Progress::under_way;
}

/// Checks the faces that a split changed, which may be wanted themselves: at once for the request's
/// own questions, in their own turn for others. Near another surface they are left to the next walk
/// if other faces already need all remaining splits or most of them.
void Refiner::consider_star(RecordId id, const VsplitRecord& record,
                            const VertexForest::StarGeometry& star,
                            std::span<const RefineQuestion> own, std::uint32_t splits_left) noexcept
{
    const std::uint32_t outdated = outdated_in(star);
    LooseFaces coarse = coarse_in(record, star, outdated);
    if (coarse.lanes == 0)
    {
        return;
    }
    const std::uint32_t all = coarse.lanes;
    StarBounds excess{};
    excess.fill(kInfinity);
    const Vec3 vertex = to_vec3(record.position_m);
    const double reach = static_cast<double>(error_in_quanta(record.reach)) * quantum_m_;
    const auto consider = [&](const RefineQuestion& question)
    {
        if (is_filling_ && question.surface != nullptr)
        {
            leave(question, 0.0); // The question searches again, in one walk for all splits.
            return;
        }
        const double nearest = (vertex - question.center_m).norm() * kRootRoundedDown - reach;
        if (nearest > target_of(question))
        {
            leave(question, nearest);
            return;
        }
        const bool is_own = &question >= own.data() && &question < own.data() + own.size();
        const bool can_wait =
            is_own ? heap_size_ >= splits_left || stars_left_ == 0 : is_wanting(question);
        if (question.surface != nullptr && can_wait)
        {
            leave(question, nearest);
            return;
        }
        stars_left_ -= question.surface != nullptr && is_own ? 1U : 0U;
        coarse.lanes = lanes_above(question.tolerance, all, record.error) | outdated;
        if (coarse.lanes == 0)
        {
            return;
        }
        StarBounds lower; // NOLINT(cppcoreguidelines-pro-type-member-init): it is filled.
        question.surface != nullptr ? bound_star_near_surface(question, coarse, lower)
                                    : bound_star_near_sphere(question, coarse, lower);
        for (std::uint32_t lanes = coarse.lanes; lanes != 0; lanes &= lanes - 1)
        {
            const auto place = static_cast<std::size_t>(std::countr_zero(lanes));
            if (is_own && lower[place] <= target_of(question))
            {
                excess[place] = std::min(excess[place], excess_of(question, lower[place]));
            }
            else
            {
                leave(question, lower[place]);
            }
        }
    };
    for_each_question(requests_, consider);
    for (std::uint32_t place = 0; place < kMaxStarFaces; ++place)
    {
        if (excess[place] < kInfinity)
        {
            push({excess[place], star.prims[place], FaceState::after(id, place)}, own);
        }
    }
}

/// Coarse faces of a star, and those of the places in `outdated`.
LooseFaces Refiner::coarse_in(const VsplitRecord& record, const VertexForest::StarGeometry& star,
                              std::uint32_t outdated) const noexcept
{
    LooseFaces coarse{star.geometry};
    for (std::uint32_t place = 0; place < kMaxStarFaces; ++place)
    {
        coarse.errors_m[place] =
            static_cast<double>(error_in_quanta(record.error[place])) * quantum_m_;
        coarse.lanes |= record.error[place] != 0 ? 1U << place : 0U;
    }
    coarse.lanes = (coarse.lanes | outdated) & star.geometry.faces;
    return coarse;
}

/// Places of a star's outdated faces, one bit each.
std::uint32_t Refiner::outdated_in(const VertexForest::StarGeometry& star) const noexcept
{
    std::uint32_t outdated = 0;
    for (std::uint32_t lanes = forest_->has_removed() ? star.geometry.faces : 0; lanes != 0;
         lanes &= lanes - 1)
    {
        const auto place = static_cast<std::uint32_t>(std::countr_zero(lanes));
        outdated |= forest_->is_outdated(star.prims[place]) ? 1U << place : 0U;
    }
    return outdated;
}

/// Writes lower bounds on distances minus errors of a star's coarse faces.
void Refiner::bound_star_near_sphere(const RefineQuestion& question, const LooseFaces& coarse,
                                     StarBounds& lower_m) const noexcept
{
    FaceBounds bounds; // NOLINT(cppcoreguidelines-pro-type-member-init): the kernel fills it.
    bound_faces(tree_->kernels(), coarse.geometry, coarse.lanes, question.memory->probe, bounds);
    for (std::uint32_t lanes = coarse.lanes; lanes != 0; lanes &= lanes - 1)
    {
        const auto place = static_cast<std::size_t>(std::countr_zero(lanes));
        lower_m[place] = static_cast<double>(bounds.lower[place]) * quantum_m_ -
                         counted(question, coarse.errors_m[place]);
    }
}

/// The same near another surface; infinity for faces beyond both the target and the certificate.
void Refiner::bound_star_near_surface(const RefineQuestion& question, const LooseFaces& coarse,
                                      StarBounds& lower_m) const noexcept
{
    const double farthest = std::max(target_of(question), question.memory->certified_m);
    NearFaces near(*tree_, *question.surface, question.tolerance);
    near.find(coarse, farthest - question.span_m);
    leave(question, near.rest_m() + question.span_m);
    lower_m.fill(kInfinity);
    for (const NearFaces::Block& block : near.blocks())
    {
        for (std::uint32_t lanes = block.lanes; lanes != 0; lanes &= lanes - 1)
        {
            const auto place = static_cast<std::uint32_t>(std::countr_zero(lanes));
            const double gap = near.gap_m(block, place) + question.span_m;
            lower_m[place] = gap + not_counted(question, coarse.errors_m[place]);
        }
    }
}

/// Distance minus error of a coarse face, or a lower bound on it that is beyond the target.
double Refiner::lower_bound(PrimId prim, const RefineQuestion& question) const noexcept
{
    const double error = counted(
        question, static_cast<double>(error_in_quanta(forest_->error_of(prim))) * quantum_m_);
    const Triangle triangle = to_triangle(forest_->corners_of(prim));
    const double box_lower =
        std::sqrt(box_distance_sq(question.center_m, triangle)) * kRootRoundedDown - error;
    if (box_lower > target_of(question))
    {
        return box_lower;
    }
    const ClosestPoint closest = closest_point_on_triangle(question.center_m, triangle);
    const double lower = std::sqrt(closest.distance_sq) - closest.distance_error - error;
    if (question.surface == nullptr || lower > target_of(question))
    {
        return lower;
    }
    const double enough = target_of(question) - question.span_m + error;
    const double from_surface = question.surface->lower_bound_m(sphere_round(triangle), enough);
    return std::max(lower, from_surface - error + question.span_m);
}

/// Adds a face to the heap. If the heap is full, the face waits for the next frame. Faces needed
/// only ahead may take half of the heap, and dropping one is no fault.
void Refiner::push(const Candidate& candidate, std::span<const RefineQuestion> questions) noexcept
{
    TACTUS_ASSERT(!candidate.prim.is_none());
    TACTUS_ASSERT(candidate.excess_m < kInfinity);
    const std::size_t room = candidate.excess_m <= 0.0 ? heap_.size() : heap_.size() / 2;
    if (heap_size_ >= room)
    {
        leave_at(questions, candidate.excess_m);
        given_up_ |= candidate.excess_m <= 0.0 ? FrameFault::refine_heap_full : FrameFault::none;
        return;
    }
    heap_[heap_size_++] = candidate;
    std::push_heap(heap_.data(), heap_.data() + heap_size_, comes_later);
}

Refiner::Candidate Refiner::pop() noexcept
{
    TACTUS_ASSERT(heap_size_ > 0);
    std::pop_heap(heap_.data(), heap_.data() + heap_size_, comes_later);
    return heap_[--heap_size_];
}

bool Refiner::is_current(const Candidate& candidate) const noexcept
{
    const VertexForest::ActiveFace& face = forest_->face(candidate.prim);
    return !face.id.is_none() && face.state == candidate.state;
}

/// Holds a record: it is not merged before its closure is complete. If RefineScratch::held is full,
/// it may be merged and must then be split again.
void Refiner::hold(RecordId record, Closure& closure) noexcept
{
    const std::uint32_t place = scratch_->free_held;
    if (place == Closure::kNone)
    {
        given_up_ |= FrameFault::held_records_full;
        return;
    }
    HeldRecord& held = scratch_->held[place];
    scratch_->free_held = held.next;
    held = {record, closure.first_held};
    closure.first_held = place;
    pages_->set_held(record, true);
}

void Refiner::release(Closure& closure) noexcept
{
    TACTUS_ASSERT(closure.first_held == Closure::kNone || !closure.target.is_none());
    while (closure.first_held != Closure::kNone)
    {
        HeldRecord& held = scratch_->held[closure.first_held];
        pages_->set_held(held.record, false);
        coarsener_.mark_due(held.record);
        std::swap(closure.first_held, held.next);
        std::swap(held.next, scratch_->free_held);
    }
    closure.target = RecordId{};
}

} // namespace tactus
