// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/forest/vertex_forest.hpp"
#include "rt_core/query/tree_walk.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/work_counters.hpp"
#include "rt_core/refine/coarsener.hpp"
#include "rt_core/refine/refine_question.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

/// Moves one model's refined front to what the questions need: first merges what was left behind
/// (Coarsener), then splits what they lack, nearest first, until the certificate holds or the
/// budget is spent.
///
/// A face is split while it is coarse and its distance minus its error is within a question's
/// reach. When none is left every original face in reach is active: the ball is certified. It is
/// refined a little beyond the reach (kLookAhead), so that a slow tool has frames without any work
/// here. Records split for a closure that the budget cut short are held: not merged until the
/// closure is complete or nobody wants it, so a small budget makes progress in every frame.
///
/// Haptic thread. Every loop is bounded by the budgets and by limits.hpp.
class Refiner
{
public:
    Refiner(Arena& arena, VertexForest& forest, PageTable& pages, const AbTree& tree,
            float quantum_m) noexcept;

    /// One frame: looks at up to `budgets.scanned` refined records, merges up to `budgets.merges`
    /// and splits up to `budgets.splits`. The tree's boxes are those of the last refit. Pages whose
    /// records a closure needs are touched.
    void run(std::span<const RefineQuestion> questions, const Budgets& budgets, std::uint32_t frame,
             WorkCounters& work, FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    enum class Progress : std::uint8_t
    {
        under_way,
        full,     ///< A pool has no room.
        complete, ///< All records are refined.
    };
    /// Splits records one after the other with what run() left of the budget, for the same
    /// questions; faces that they lack for it afterwards are split with what is left then.
    [[nodiscard]] Progress refine_everything(std::uint32_t records,
                                             std::span<const RefineQuestion> questions,
                                             const Budgets& budgets, std::uint32_t frame,
                                             WorkCounters& work,
                                             FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// How far beyond the reach is refined, as a share of it.
    static constexpr double kLookAhead = 0.05;

private:
    /// A coarse face that is wanted, and the state in which it was looked at.
    struct Candidate
    {
        /// Distance minus error minus reach, the least over the questions; above zero it is only
        /// looked ahead for.
        double excess_m{0.0};
        PrimId prim{};
        FaceState state;
    };
    /// A record whose split a face of that excess waits for.
    struct Wanted
    {
        RecordId record{};
        double excess_m{0.0};
    };
    enum class ClosureOutcome : std::uint8_t
    {
        complete,
        budget_spent,
        full,    ///< A pool has no room.
        blocked, ///< A record isn't here yet, or is refused.
    };

    void follow(std::span<const RefineQuestion> questions) noexcept;
    void gather(const RefineQuestion& question, const Budgets& budgets, WorkCounters& work,
                FrameFault& faults) noexcept;
    void gather_near_ball(const RefineQuestion& question, WalkBudget& budget) noexcept;
    void gather_near_surface(const RefineQuestion& question) noexcept;
    void gather_block(std::uint32_t index, const RefineQuestion& question) noexcept;
    void split_wanted(std::span<const RefineQuestion> questions, const Budgets& budgets,
                      std::uint32_t frame, WorkCounters& work, FrameFault& faults) noexcept;
    [[nodiscard]] double
    excess_of_pending(std::span<const RefineQuestion> questions) const noexcept;
    [[nodiscard]] double lower_bound(PrimId prim, const RefineQuestion& question) const noexcept;
    [[nodiscard]] bool try_advance(const Wanted& wanted, std::uint32_t limit,
                                   std::span<const RefineQuestion> questions, std::uint32_t frame,
                                   WorkCounters& work, FrameFault& found) noexcept;
    void push(const Candidate& candidate, std::span<const RefineQuestion> questions) noexcept;
    [[nodiscard]] Candidate pop() noexcept;
    [[nodiscard]] bool is_current(const Candidate& candidate) const noexcept;
    [[nodiscard]] ClosureOutcome split_with_closure(RecordId target, std::uint32_t limit,
                                                    std::span<const RefineQuestion> questions,
                                                    std::uint32_t frame, WorkCounters& work,
                                                    FrameFault& faults) noexcept;
    [[nodiscard]] Progress fill(std::uint32_t records, std::uint32_t limit,
                                std::span<const RefineQuestion> questions, std::uint32_t frame,
                                WorkCounters& work, FrameFault& faults) noexcept;
    void consider_star(RecordId id, const VsplitRecord& record,
                       const VertexForest::StarGeometry& star,
                       std::span<const RefineQuestion> questions) noexcept;
    void hold(RecordId record) noexcept;
    void release_held() noexcept;

    VertexForest* forest_;
    PageTable* pages_;
    const AbTree* tree_;
    Coarsener coarsener_;
    double quantum_m_;
    std::span<Candidate> heap_;
    std::span<RecordId> held_;
    std::span<RecordId> stack_;
    std::span<RecordId> done_;
    std::uint32_t heap_size_{0};
    std::uint32_t held_count_{0};
    std::uint32_t done_count_{0};
    RecordId pending_{}; ///< Whose closure the held records were split for.
    std::size_t question_count_{0};
    std::uint32_t next_record_{0}; ///< fill() has done those before.
    /// Splits are not for the questions: another surface is not walked for each of them.
    bool is_filling_{false};
    FrameFault given_up_{FrameFault::none}; ///< For want of room in this frame.
};

} // namespace tactus
