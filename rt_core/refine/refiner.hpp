// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/arena.hpp"
#include "rt_core/forest/vertex_forest.hpp"
#include "rt_core/query/tree_walk.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/work_counters.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

/// What one pair asks of a model: every original face within `reach_m` of the point, exactly.
/// Model frame, metres.
struct RefineQuestion
{
    Vec3 center_m{0.0, 0.0, 0.0};
    double reach_m{0.0};
    double keep_m{0.0}; ///< Records farther than this may be merged; 1.25 x reach (hysteresis).
};

/// Moves one model's refined front to what the questions need: first merges what was left behind,
/// then splits what they lack, nearest first, until the certificate holds or the budget is spent.
///
/// A face is split while it is coarse and its distance minus its error is within a question's
/// reach. When none is left every original face in reach is active: the ball is certified.
/// Records split for a closure that the budget cut short are held: not merged until the closure
/// is complete or nobody wants it, so a small budget makes progress in every frame.
///
/// Haptic thread. Every loop is bounded by the budgets and by limits.hpp.
class Refiner
{
public:
    Refiner(Arena& arena, VertexForest& forest, PageTable& pages, const AbTree& tree,
            float quantum_m) noexcept;

    /// Looks at up to `budgets.scanned` refined records and merges up to `budgets.merges`.
    void coarsen(std::span<const RefineQuestion> questions, const Budgets& budgets,
                 WorkCounters& work) noexcept;

    /// Splits up to `budgets.splits` records. Pages whose records a closure needs are touched.
    void refine(std::span<const RefineQuestion> questions, const Budgets& budgets,
                std::uint32_t frame, WorkCounters& work, FrameFault& faults) noexcept;

private:
    /// A coarse face that is wanted, and the state in which it was looked at.
    struct Candidate
    {
        double key{0.0}; ///< Distance minus error, the least over the questions.
        PrimId prim{};
        FaceState state;
    };
    enum class ClosureOutcome : std::uint8_t
    {
        complete,
        budget_spent,
        full,    ///< A pool has no room.
        blocked, ///< A record isn't here yet, or is refused.
    };

    [[nodiscard]] bool is_left_behind(const VsplitRecord& record,
                                      std::span<const RefineQuestion> questions) const noexcept;
    [[nodiscard]] bool pending_is_wanted(std::span<const RefineQuestion> questions) const noexcept;
    [[nodiscard]] bool advance(RecordId target, std::span<const RefineQuestion> questions,
                               const Budgets& budgets, std::uint32_t frame, WorkCounters& work,
                               FrameFault& faults) noexcept;
    void scan_slot(std::span<const RefineQuestion> questions, const Budgets& budgets,
                   WorkCounters& work) noexcept;
    void gather(std::span<const RefineQuestion> questions, const Budgets& budgets,
                WorkCounters& work, FrameFault& faults) noexcept;
    void consider(PrimId prim, std::span<const RefineQuestion> questions) noexcept;
    void push(const Candidate& candidate) noexcept;
    [[nodiscard]] Candidate pop() noexcept;
    [[nodiscard]] bool is_current(const Candidate& candidate) const noexcept;
    [[nodiscard]] double key_of(PrimId prim,
                                std::span<const RefineQuestion> questions) const noexcept;
    [[nodiscard]] ClosureOutcome split_with_closure(RecordId target, std::uint32_t frame,
                                                    const Budgets& budgets, WorkCounters& work,
                                                    FrameFault& faults) noexcept;
    void consider_star(RecordId id, std::span<const RefineQuestion> questions) noexcept;
    void hold(RecordId record) noexcept;
    void release_held() noexcept;

    VertexForest* forest_;
    PageTable* pages_;
    const AbTree* tree_;
    float quantum_m_;
    std::span<Candidate> heap_;
    std::span<RecordId> held_;
    std::span<RecordId> stack_;
    std::span<RecordId> done_;
    std::uint32_t heap_size_{0};
    std::uint32_t held_count_{0};
    std::uint32_t done_count_{0};
    RecordId pending_{}; ///< Whose closure the held records were split for.
    std::uint32_t scan_slot_{0};
    std::uint32_t scan_place_{kRecordsPerChunk};
};

} // namespace tactus
