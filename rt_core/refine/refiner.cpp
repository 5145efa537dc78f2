// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/refine/refiner.hpp"

#include "rt_core/math/triangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus
{

namespace
{

constexpr double kInfinity = std::numeric_limits<double>::infinity();

} // namespace

Refiner::Refiner(Arena& arena, VertexForest& forest, PageTable& pages, const AbTree& tree,
                 float quantum_m) noexcept
    : forest_(&forest)
    , pages_(&pages)
    , tree_(&tree)
    , quantum_m_(quantum_m)
    , heap_(arena.take<Candidate>(kRefineHeap))
    , held_(arena.take<RecordId>(kMaxHeldRecords))
    , stack_(arena.take<RecordId>(kMaxDepth))
    , done_(arena.take<RecordId>(kMaxSplitsPerFrame))
{
}

void Refiner::coarsen(std::span<const RefineQuestion> questions, const Budgets& budgets,
                      WorkCounters& work) noexcept
{
    const std::uint32_t refined = forest_->refined_records();
    const std::uint32_t scanned_before = work.scanned;
    // One round over the pages at most; a page with nothing refined costs one look.
    for (std::uint32_t looked = 0; looked <= pages_->capacity() && refined > 0; ++looked)
    {
        if (work.scanned - scanned_before >= std::min(budgets.scanned, refined) ||
            work.merges >= budgets.merges || !forest_->has_room_for_changes())
        {
            return;
        }
        scan_slot(questions, budgets, work);
    }
}

void Refiner::refine(std::span<const RefineQuestion> questions, const Budgets& budgets,
                     std::uint32_t frame, WorkCounters& work, FrameFault& faults) noexcept
{
    gather(questions, budgets, work, faults);
    if (!pending_.is_none())
    {
        if (!pending_is_wanted(questions))
        {
            release_held();
        }
        else if (!advance(pending_, questions, budgets, frame, work, faults))
        {
            return;
        }
    }
    while (heap_size_ > 0)
    {
        const Candidate candidate = pop();
        if (!is_current(candidate))
        {
            continue;
        }
        const std::uint32_t next = forest_->next_of(candidate.prim);
        if (next >= kNextPending)
        {
            faults |= FrameFault::chunk_late;
            continue;
        }
        if (!advance({next}, questions, budgets, frame, work, faults))
        {
            return;
        }
    }
}

/// Whether the face for which the pending closure was begun still waits and is still in reach.
bool Refiner::pending_is_wanted(std::span<const RefineQuestion> questions) const noexcept
{
    const VsplitRecord* record = pages_->find_linked(pending_);
    if (record == nullptr)
    {
        return false;
    }
    for (std::uint32_t i = 0; i < record->fan_size; ++i)
    {
        const PrimId prim = forest_->find(record->star[2 + i]);
        if (!prim.is_none() && forest_->face(prim).state == record->before[i] &&
            key_of(prim, questions) < kInfinity)
        {
            return true;
        }
    }
    return false;
}

/// Splits towards `target`; false when nothing more can be split in this frame.
bool Refiner::advance(RecordId target, std::span<const RefineQuestion> questions,
                      const Budgets& budgets, std::uint32_t frame, WorkCounters& work,
                      FrameFault& faults) noexcept
{
    done_count_ = 0;
    const ClosureOutcome outcome = split_with_closure(target, frame, budgets, work, faults);
    for (std::uint32_t i = 0; i < done_count_; ++i)
    {
        consider_star(done_[i], questions);
    }
    if (outcome == ClosureOutcome::complete || outcome == ClosureOutcome::blocked)
    {
        if (target == pending_)
        {
            release_held();
        }
        return true;
    }
    pending_ = target;
    for (std::uint32_t i = 0; i < done_count_; ++i)
    {
        hold(done_[i]);
    }
    faults |=
        outcome == ClosureOutcome::full ? FrameFault::forest_full : FrameFault::split_budget_spent;
    return false;
}

/// Looks at the refined records of one page, finest last in first, within the scan budget.
void Refiner::scan_slot(std::span<const RefineQuestion> questions, const Budgets& budgets,
                        WorkCounters& work) noexcept
{
    const PageTable::Meta& meta = pages_->meta(scan_slot_);
    while (scan_place_ > 0 && work.scanned < budgets.scanned && work.merges < budgets.merges &&
           forest_->has_room_for_changes())
    {
        const std::uint64_t below = scan_place_ >= kRecordsPerChunk
                                        ? ~std::uint64_t{0}
                                        : (std::uint64_t{1} << scan_place_) - 1;
        const std::uint64_t left = meta.refined & ~meta.held & below;
        if (left == 0)
        {
            scan_place_ = 0;
            break;
        }
        scan_place_ = static_cast<std::uint32_t>(63 - std::countl_zero(left));
        const RecordId id{(meta.chunk.value << kRecordsPerChunkLog2) + scan_place_};
        ++work.scanned;
        if (is_left_behind(pages_->resident(id), questions) && forest_->try_merge(id))
        {
            ++work.merges;
        }
    }
    if (scan_place_ == 0)
    {
        scan_slot_ = scan_slot_ == 0 ? pages_->capacity() - 1 : scan_slot_ - 1;
        scan_place_ = kRecordsPerChunk;
    }
}

bool Refiner::is_left_behind(const VsplitRecord& record,
                             std::span<const RefineQuestion> questions) const noexcept
{
    const auto reach = static_cast<double>(error_in_quanta(record.reach) * quantum_m_);
    const Vec3 vertex = to_vec3(record.position_m);
    return std::all_of(questions.begin(), questions.end(),
                       [&](const RefineQuestion& question)
                       { return (vertex - question.center_m).norm() - reach > question.keep_m; });
}

/// Finds the coarse faces in reach: in the tree, and among the faces that coarsening changed.
void Refiner::gather(std::span<const RefineQuestion> questions, const Budgets& budgets,
                     WorkCounters& work, FrameFault& faults) noexcept
{
    heap_size_ = 0;
    for (const RefineQuestion& question : questions)
    {
        WalkBudget budget{budgets.nodes, budgets.triangles};
        TreeWalk walk(*tree_, question.center_m, budget);
        const double reach_sq = question.reach_m * question.reach_m;
        for (std::uint32_t block = walk.next_block(reach_sq, true); block != kNoNode;
             block = walk.next_block(reach_sq, true))
        {
            const BlockSide& side = tree_->side(block);
            if (!budget.take_triangles(static_cast<std::uint32_t>(std::popcount(side.coarse))))
            {
                faults |= FrameFault::node_budget_spent;
                break;
            }
            for (std::uint32_t lanes = side.coarse; lanes != 0; lanes &= lanes - 1)
            {
                const PrimId prim = side.prims[static_cast<std::size_t>(std::countr_zero(lanes))];
                if (!forest_->is_changed(prim))
                {
                    consider(prim, {&question, 1});
                }
            }
        }
        faults |= walk.left().empty() ? FrameFault::none : FrameFault::node_budget_spent;
        work.nodes_visited += budget.nodes_visited;
        work.triangles_tested += budget.triangles_tested;
    }
    for (const PrimId prim : forest_->changed_prims())
    {
        if (!forest_->face(prim).id.is_none())
        {
            consider(prim, questions);
        }
    }
}

void Refiner::consider(PrimId prim, std::span<const RefineQuestion> questions) noexcept
{
    const double key = key_of(prim, questions);
    if (key < kInfinity)
    {
        push({key, prim, forest_->face(prim).state});
    }
}

/// Distance minus error of a coarse face that is in some question's reach, else infinity.
double Refiner::key_of(PrimId prim, std::span<const RefineQuestion> questions) const noexcept
{
    const ErrorCode code = forest_->error_of(prim);
    if (code == 0)
    {
        return kInfinity;
    }
    const auto error = static_cast<double>(error_in_quanta(code) * quantum_m_);
    const Triangle triangle = to_triangle(forest_->corners_of(prim));
    double key = kInfinity;
    for (const RefineQuestion& question : questions)
    {
        const ClosestPoint closest = closest_point_on_triangle(question.center_m, triangle);
        const double lower = std::sqrt(closest.distance_sq) - closest.distance_error - error;
        key = lower <= question.reach_m ? std::min(key, lower) : key;
    }
    return key;
}

namespace
{

/// Nearest first; among equals the lower slot, so that the order is the same in every run.
template <typename Candidate>
bool comes_later(const Candidate& a, const Candidate& b) noexcept
{
    return a.key != b.key ? a.key > b.key : a.prim > b.prim;
}

} // namespace

/// Full: the face waits for the next frame, when nearer ones are done.
void Refiner::push(const Candidate& candidate) noexcept
{
    if (heap_size_ < heap_.size())
    {
        heap_[heap_size_++] = candidate;
        std::push_heap(heap_.data(), heap_.data() + heap_size_, comes_later<Candidate>);
    }
}

Refiner::Candidate Refiner::pop() noexcept
{
    std::pop_heap(heap_.data(), heap_.data() + heap_size_, comes_later<Candidate>);
    return heap_[--heap_size_];
}

bool Refiner::is_current(const Candidate& candidate) const noexcept
{
    const VertexForest::ActiveFace& face = forest_->face(candidate.prim);
    return !face.id.is_none() && face.state == candidate.state;
}

/// Depth-first over the records that must be split before `target`; the stack is never deeper than
/// the deepest record.
Refiner::ClosureOutcome Refiner::split_with_closure(RecordId target, std::uint32_t frame,
                                                    const Budgets& budgets, WorkCounters& work,
                                                    FrameFault& faults) noexcept
{
    std::uint32_t depth = 0;
    stack_[depth++] = target;
    while (depth > 0)
    {
        const RecordId id = stack_[depth - 1];
        const VsplitRecord* record = pages_->find_linked(id);
        if (record == nullptr)
        {
            faults |= FrameFault::chunk_late;
            return ClosureOutcome::blocked;
        }
        pages_->touch(pages_->find(chunk_of(id)), frame);
        if (const RecordId missing = forest_->missing_dependency(*record); !missing.is_none())
        {
            TACTUS_ASSERT(depth < stack_.size());
            stack_[depth++] = missing;
            continue;
        }
        if (work.splits >= std::min(budgets.splits, kMaxSplitsPerFrame))
        {
            return ClosureOutcome::budget_spent;
        }
        const auto changed = static_cast<std::uint32_t>(forest_->changed_prims().size());
        if (!forest_->has_room_for_changes() || !tree_->has_room_for(changed + kMaxStarFaces))
        {
            return ClosureOutcome::full;
        }
        switch (forest_->split(id))
        {
        case VertexForest::SplitOutcome::full:
            return ClosureOutcome::full;
        case VertexForest::SplitOutcome::inconsistent:
            faults |= FrameFault::model_inconsistent;
            return ClosureOutcome::blocked;
        case VertexForest::SplitOutcome::done:
            ++work.splits;
            done_[done_count_++] = id;
            --depth;
        }
    }
    return ClosureOutcome::complete;
}

/// The faces that a split changed may be wanted themselves.
void Refiner::consider_star(RecordId id, std::span<const RefineQuestion> questions) noexcept
{
    const VsplitRecord& record = pages_->resident(id);
    for (std::uint32_t place = 0; place < record.star_end(); ++place)
    {
        if (record.star[place].is_none())
        {
            continue;
        }
        const PrimId prim = forest_->find(record.star[place]);
        if (!prim.is_none() && forest_->face(prim).state == FaceState::after(id, place))
        {
            consider(prim, questions);
        }
    }
}

void Refiner::hold(RecordId record) noexcept
{
    if (held_count_ < held_.size())
    {
        held_[held_count_++] = record;
        pages_->set_held(record, true);
    }
}

void Refiner::release_held() noexcept
{
    for (std::uint32_t i = 0; i < held_count_; ++i)
    {
        pages_->set_held(held_[i], false);
    }
    held_count_ = 0;
    pending_ = RecordId{};
}

} // namespace tactus
