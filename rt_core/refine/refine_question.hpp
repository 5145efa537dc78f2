// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/model_id.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/priority.hpp"
#include "rt_core/records/work_counters.hpp"
#include "rt_core/spm/error_code.hpp"
#include "rt_core/spm/ids.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace tactus
{

class OtherSurface;
struct UnfinishedSearch;

/// State of one question, kept from frame to frame.
struct RefineMemory
{
    Vec3 center_m{0.0, 0.0, 0.0};
    double keep_m{0.0};
    /// Lower bound on all coarse faces' distances from the centre minus their errors. While it is
    /// not below the reach there is nothing to split, and no search.
    double certified_m{0.0};
    ErrorCode tolerance{0}; ///< Faces with larger errors are coarse.
    bool is_known{false};
    KernelProbe probe{}; ///< Probe at this frame's centre.
};

/// Demand of one pair on a model: all original faces within `reach_m` of `center_m` must be active.
/// Model frame, metres; the centre must not be is_beyond_kernels() (asserted).
///
/// If `surface` is set, only faces within reach_m - span_m of that surface are needed; the sphere
/// of radius `span_m` round the centre holds it. Distances minus errors are then those from the
/// surface, plus `span_m`.
struct RefineQuestion
{
    Vec3 center_m{0.0, 0.0, 0.0};
    double reach_m{0.0};
    double keep_m{0.0}; ///< Distance beyond which records may be merged (hysteresis).
    RefineMemory* memory{nullptr};
    OtherSurface* surface{nullptr}; ///< Surface that faces are near; null: the centre.
    double span_m{0.0};
    double moved_m{0.0};      ///< Bound on the motion of the surface's points since the last frame.
    double ahead_m{0.0};      ///< Distance refined beyond the reach, in addition to the usual one.
    bool counts_errors{true}; ///< False: errors are not subtracted from distances.
    ErrorCode tolerance{0};   ///< Faces with errors up to this stay.
    /// Unfinished search of this question near another surface, or null.
    UnfinishedSearch* unfinished{nullptr};
    /// Distance of the centre from the tool's present place if it is a predicted place, whose faces
    /// may wait. 0: present place, faces needed now.
    double later_m{0.0};
};

/// True if a face within the reach may be coarse.
[[nodiscard]] inline bool is_wanting(const RefineQuestion& question) noexcept
{
    return question.memory->certified_m < question.reach_m;
}

/// Unfinished split of a record for which the budget did not suffice. The records already split for
/// it are held, which means not merged, until it is split or no longer wanted. One for each pair
/// and model, kept from frame to frame.
struct Closure
{
    static constexpr std::uint32_t kNone = 0xFFFF'FFFFU;

    RecordId target{};               ///< Record to split; none: no closure is open.
    std::uint32_t first_held{kNone}; ///< First entry in RefineScratch::held.
    std::uint32_t saved{0};          ///< Savings of the pair, see SplitShares.
    std::uint32_t waited{0};         ///< Consecutive frames without a share of splits.
    /// Cause, in the last frame, for which faces needed now were not split.
    FrameFault late_for{FrameFault::none};
};

/// Demand of one pair on one model in a frame; without questions the pair needs nothing more.
struct RefineRequest
{
    ModelId model{};
    std::span<const RefineQuestion> questions;
    Closure* closure{nullptr};
    Priority priority;

    /// True if a face within reach that is needed now may be coarse.
    [[nodiscard]] bool is_late() const noexcept
    {
        return std::ranges::any_of(questions, [](const RefineQuestion& question)
                                   { return question.later_m == 0.0 && is_wanting(question); });
    }
    /// True if the request's distances are from another surface.
    [[nodiscard]] bool is_near_surface() const noexcept
    {
        return std::ranges::any_of(questions, [](const RefineQuestion& question)
                                   { return question.surface != nullptr; });
    }
    /// True if a split for the request may be due, now or later.
    [[nodiscard]] bool is_open() const noexcept
    {
        return !closure->target.is_none() ||
               std::ranges::any_of(questions, [](const RefineQuestion& question)
                                   { return is_wanting(question); });
    }
};

/// Calls `function` for each question of the requests, in order.
template <typename Function>
void for_each_question(std::span<const RefineRequest> requests, const Function& function) noexcept
{
    for (const RefineRequest& request : requests)
    {
        for (const RefineQuestion& question : request.questions)
        {
            function(question);
        }
    }
}

} // namespace tactus
