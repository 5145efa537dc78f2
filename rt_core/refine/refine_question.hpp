// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/kernels/kernels.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/query/near_faces.hpp"
#include "rt_core/query/other_surface.hpp"
#include "rt_core/records/urgency.hpp"
#include "rt_core/records/work_counters.hpp"
#include "rt_core/spm/error_code.hpp"
#include "rt_core/spm/ids.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace tactus
{

/// What is known of a question from frame to frame.
struct RefineMemory
{
    Vec3 center_m{0.0, 0.0, 0.0};
    double keep_m{0.0};
    /// No coarse face's distance from the centre minus its error is below this. While it is not
    /// below the reach there is nothing to split, and nobody needs to look.
    double certified_m{0.0};
    ErrorCode tolerance{0}; ///< Larger errors are meant by "coarse".
    bool is_known{false};
    KernelProbe probe{}; ///< Of this frame's centre.
};

/// What one pair asks of a model: every original face within `reach_m` of the point, exactly.
/// Model frame, metres; the centre is not is_beyond_kernels().
///
/// With a surface, of those only the faces within reach_m - span_m of it: the ball of `span_m`
/// holds the surface. Distances, errors taken off, are told as those from the centre all the same,
/// larger by the span than those from the surface.
struct RefineQuestion
{
    Vec3 center_m{0.0, 0.0, 0.0};
    double reach_m{0.0};
    double keep_m{0.0}; ///< Records farther than this may be merged (hysteresis).
    RefineMemory* memory{nullptr};
    OtherSurface* surface{nullptr}; ///< Null for a ball.
    double span_m{0.0};
    double moved_m{0.0};      ///< No point of the surface has moved farther since the last frame.
    double ahead_m{0.0};      ///< How much farther than usual beyond the reach is refined.
    bool counts_errors{true}; ///< Without: coarse faces are wanted by distance alone.
    ErrorCode tolerance{0};   ///< Faces with no larger error need no split.
    UnfinishedSearch* unfinished{nullptr}; ///< Of this question, near another surface; or null.
    /// So far from where it is needed the question is asked, because that is where it will be: what
    /// only it wants may wait. 0: it is needed now.
    double later_m{0.0};
};

/// Whether something within the reach may be coarse.
[[nodiscard]] inline bool is_wanting(const RefineQuestion& question) noexcept
{
    return question.memory->certified_m < question.reach_m;
}

/// Records that were split towards one which the budget did not come to: kept from being merged
/// until it is split, or nobody wants it. One for each pair and model, from frame to frame.
struct Closure
{
    static constexpr std::uint32_t kNone = 0xFFFF'FFFFU;

    RecordId target{};               ///< None: nothing is open.
    std::uint32_t first_held{kNone}; ///< In the refiner's list.
    std::uint32_t saved{0};          ///< Splits that the pair left to others: see SplitShares.
    std::uint32_t waited{0};         ///< Frames on end in which nothing was left for it.
    /// What was in the way of something that is needed now, in the last frame.
    FrameFault late_for{FrameFault::none};
};

/// What one pair asks of one model in a frame; without a question, that it asks no more.
struct RefineRequest
{
    ModelId model{};
    std::span<const RefineQuestion> questions;
    Closure* closure{nullptr};
    Urgency urgency;

    /// Whether something within reach may be coarse that is needed now.
    [[nodiscard]] bool is_late() const noexcept
    {
        return std::ranges::any_of(questions, [](const RefineQuestion& question)
                                   { return question.later_m == 0.0 && is_wanting(question); });
    }
    /// Whether it is asked by how near another surface is.
    [[nodiscard]] bool is_near_surface() const noexcept
    {
        return std::ranges::any_of(questions, [](const RefineQuestion& question)
                                   { return question.surface != nullptr; });
    }
    /// Whether there may be something to split for it, now or later.
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
