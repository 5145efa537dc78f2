// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/forest/vertex_forest.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/work_counters.hpp"
#include "rt_core/refine/coarsener.hpp"
#include "rt_core/refine/refine_question.hpp"
#include "rt_core/refine/refine_scratch.hpp"
#include "rt_core/spm/ids.hpp"
#include "rt_core/spm/page_table.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

class AbTree;
struct LooseFaces;
struct UnfinishedSearch;
struct WalkBudget;

/// Upper limits on the frame's total splits (WorkCounters::splits) while a request is served.
struct SplitLimits
{
    std::uint32_t now{0};
    std::uint32_t later{0}; ///< Limit for splits that may wait, at most `now`.
};

/// Moves one model's refined front to the requests of the pairs. First records that all pairs left
/// behind are merged (Coarsener). Then each pair's missing faces are split, nearest first, until
/// its certificate holds or its share of the budget is spent.
///
/// A face is split while it is coarse and its distance minus its error is within a question's
/// reach. If none is left, every original face in reach is active: the sphere is certified.
/// Refinement goes on a little beyond the reach (kLookAhead), so that a slow tool has frames
/// without work here, and where the tool will be (RefineQuestion::later_m). These splits come after
/// all that are needed now, at a steady pace.
///
/// Records split for a closure that the budget cut short are held: not merged until the closure is
/// complete or its pair does not want it. So a small budget makes progress in every frame. Coarse
/// faces made by a split for one pair lower the certificates of others.
///
/// Haptic thread. Every loop is bounded by the budgets and by limits.hpp.
class Refiner
{
public:
    /// `scratch` must outlive the refiner; other models may use it, too.
    Refiner(VertexForest& forest, PageTable& pages, const AbTree& tree, RefineScratch& scratch,
            float quantum_m) noexcept;

    /// Begins the frame with all requests to the model, the highest priority first; they must stay
    /// until the frame ends. Lowers certificates by the questions' motion, then merges until `work`
    /// reaches `budgets.scanned` or `budgets.merges`.
    void begin(std::span<const RefineRequest> requests, const Budgets& budgets,
               WorkCounters& work) noexcept TACTUS_NONBLOCKING;

    /// Splits the coarse faces that one of the frame's requests needs, until `work.splits` reaches
    /// the limits, at most kMaxSplitsPerFrame. The tree must be refitted since the last change.
    /// Touches the pages of the closures' records. Returns the causes of missing splits, which
    /// count only if the request is still is_late().
    [[nodiscard]] FrameFault refine(const RefineRequest& request, SplitLimits limits,
                                    const Budgets& budgets, std::uint32_t frame,
                                    WorkCounters& work) noexcept TACTUS_NONBLOCKING;

    enum class Progress : std::uint8_t
    {
        under_way,
        full,     ///< A pool is full.
        complete, ///< All records are refined.
    };
    /// Splits the model's records in order until `work.splits` reaches `limit`. May lower requests'
    /// certificates.
    [[nodiscard]] Progress fill(std::uint32_t records, std::uint32_t limit, std::uint32_t frame,
                                WorkCounters& work, FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// Distance beyond the reach that is refined as well, as a share of the reach.
    static constexpr double kLookAhead = 0.02;

    /// Ends a closure: its held records may be merged again.
    void release(Closure& closure) noexcept TACTUS_NONBLOCKING;

    /// Resets the refiner; no record may be refined and no closure open.
    void forget_all() noexcept TACTUS_NONBLOCKING;

private:
    using Candidate = RefineCandidate;
    /// A record that must be split for a coarse face, and the face's excess (RefineCandidate).
    struct Wanted
    {
        RecordId record{};
        double excess_m{0.0};
    };
    enum class ClosureOutcome : std::uint8_t
    {
        complete,
        budget_spent,
        full,    ///< A pool is full.
        blocked, ///< A record isn't resident yet, or is refused.
    };

    void update_certificates() noexcept;
    void update_certificate(const RefineQuestion& question, double& farthest_m,
                            bool& is_same) noexcept;
    static void drop_outdated_search(double moved_m, double needed_m,
                                     UnfinishedSearch& unfinished) noexcept;
    [[nodiscard]] bool gather(const RefineRequest& request, SplitLimits limits,
                              std::uint32_t enough, const Budgets& budgets, WorkCounters& work,
                              FrameFault& found) noexcept;
    [[nodiscard]] bool gather(const RefineQuestion& question, std::uint32_t enough,
                              const Budgets& budgets, WorkCounters& work,
                              FrameFault& found) noexcept;
    void gather_near_sphere(const RefineQuestion& question, WalkBudget& budget) noexcept;
    [[nodiscard]] bool gather_near_surface(const RefineQuestion& question,
                                           std::uint32_t enough) noexcept;
    void gather_block(std::uint32_t index, const RefineQuestion& question) noexcept;
    void split_wanted(const RefineRequest& request, SplitLimits limits, std::uint32_t frame,
                      WorkCounters& work, FrameFault& found) noexcept;
    void take(PrimId prim, double lower_m, const RefineQuestion& question) noexcept;
    [[nodiscard]] double excess_of_pending(const RefineRequest& request) const noexcept;
    [[nodiscard]] double lower_bound(PrimId prim, const RefineQuestion& question) const noexcept;
    [[nodiscard]] bool try_advance(const Wanted& wanted, const RefineRequest& request,
                                   std::uint32_t limit, std::uint32_t frame, WorkCounters& work,
                                   FrameFault& found) noexcept;
    void push(const Candidate& candidate, std::span<const RefineQuestion> questions) noexcept;
    [[nodiscard]] Candidate pop() noexcept;
    [[nodiscard]] bool is_current(const Candidate& candidate) const noexcept;
    [[nodiscard]] ClosureOutcome split_with_closure(RecordId target,
                                                    std::span<const RefineQuestion> own,
                                                    std::uint32_t limit, std::uint32_t frame,
                                                    WorkCounters& work, FrameFault& found) noexcept;
    void consider_star(RecordId id, const VsplitRecord& record,
                       const VertexForest::StarGeometry& star, std::span<const RefineQuestion> own,
                       std::uint32_t splits_left) noexcept;
    using StarBounds = std::array<double, kMaxStarFaces>;
    [[nodiscard]] LooseFaces coarse_in(const VsplitRecord& record,
                                       const VertexForest::StarGeometry& star,
                                       std::uint32_t outdated) const noexcept;
    [[nodiscard]] std::uint32_t outdated_in(const VertexForest::StarGeometry& star) const noexcept;
    void bound_star_near_sphere(const RefineQuestion& question, const LooseFaces& coarse,
                                StarBounds& lower_m) const noexcept;
    void bound_star_near_surface(const RefineQuestion& question, const LooseFaces& coarse,
                                 StarBounds& lower_m) const noexcept;
    void hold(RecordId record, Closure& closure) noexcept;

    VertexForest* forest_;
    PageTable* pages_;
    const AbTree* tree_;
    Coarsener coarsener_;
    double quantum_m_;
    RefineScratch* scratch_;
    std::span<Candidate> heap_; ///< Spans of the scratch, like the two below.
    std::span<RecordId> stack_;
    std::span<RecordId> done_;
    std::uint32_t heap_size_{0};
    std::uint32_t done_count_{0};
    std::span<const RefineRequest> requests_; ///< Requests of this frame.
    std::uint32_t questions_{0};              ///< Number of their questions.
    std::size_t question_count_{0};
    std::uint32_t next_record_{0}; ///< Records before it are done by fill().
    /// True in fill(), whose splits do not walk another surface for each question.
    bool is_filling_{false};
    /// Splits of this refine() that may still measure their faces against another surface.
    std::uint32_t stars_left_{0};
    /// Faults of full lists since refine() began.
    FrameFault given_up_{FrameFault::none};
};

} // namespace tactus
