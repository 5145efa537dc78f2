// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/query/tree_walk.hpp"
#include "rt_core/records/local_surface.hpp"

#include <algorithm>

namespace tactus
{

/// What a pair of tool and object keeps from one query to the next: where to look first.
struct QueryMemory
{
    std::uint32_t block{kNoNode}; ///< The block of the last nearest face; any value is safe.
    float limit{0.0F}; ///< Of a point: how far the surface was at most, in quanta; likewise.
};

/// Shows `search` the blocks that matter, the remembered one first and then nearest first.
///
/// A search has `bound()`, in quanta from the probe, beyond which nothing matters;
/// `test_block(index)`, false when the budget is spent or enough is known; and `leave(gap)` for
/// what was not come to, at least so many quanta from the probe. Afterwards it remembers the block
/// with the nearest face.
template <typename Probe, typename Search>
void search_blocks(const AbTree& tree, const Probe& probe, WalkBudget& budget,
                   const QueryMemory& memory, Search& search) noexcept
{
    const std::uint32_t warm =
        tree.is_block_in_use(memory.block) && budget.take_node() ? memory.block : kNoNode;
    TreeWalk walk(tree, probe, budget);
    if (warm == kNoNode || search.test_block(warm))
    {
        for (std::uint32_t block = walk.next_block(search.bound(), false); block != kNoNode;
             block = walk.next_block(search.bound(), false))
        {
            if (block != warm && !search.test_block(block))
            {
                break;
            }
        }
    }
    for (const WalkItem& item : walk.left())
    {
        search.leave(item.gap);
    }
}

/// What a search has proven, in metres from the core.
struct Findings
{
    double exact_lower_m{0.0}; ///< The nearest exact face is at least this far away,
    /// what faces within the tolerance stand for this,
    double tolerated_lower_m{kInfinity};
    double upper_m{0.0};   ///< and some of the surface at most this.
    double open_m{0.0};    ///< What is not exact or was not come to is at least this far away,
    double pruned_m{0.0};  ///< what did not matter this,
    double dropped_m{0.0}; ///< and exact triangles that had no room this.
};

/// No face can be nearer than the nearest one of the surface, if there is one.
[[nodiscard]] inline bool is_nearest_proven(const Findings& found) noexcept
{
    const double lower_m = std::min(found.exact_lower_m, found.tolerated_lower_m);
    return lower_m <= found.open_m && lower_m <= found.pruned_m && lower_m < kInfinity;
}

/// The answer within `reach_m`, but for the nearest face and points: theirs is who has them.
[[nodiscard]] inline DistanceAnswer answer_from(const Findings& found, double reach_m) noexcept
{
    DistanceAnswer answer;
    answer.upper_m = found.upper_m;
    answer.lower_m = std::max(0.0, std::min({found.exact_lower_m, found.tolerated_lower_m,
                                             found.open_m, found.pruned_m}));
    const double open = std::min(found.open_m, found.dropped_m);
    // Less than `open`, where what is not exact may begin.
    answer.certified_radius_m = open > 0.0 ? std::min(reach_m, open * (1.0 - 0x1p-52)) : -1.0;
    const bool is_beyond = answer.lower_m > 0.0 && answer.lower_m == reach_m;
    const AnswerKind known = found.exact_lower_m <= std::max(found.tolerated_lower_m, 0.0)
                                 ? AnswerKind::exact
                                 : AnswerKind::within_tolerance;
    answer.kind = answer.lower_m > reach_m   ? AnswerKind::separated
                  : is_nearest_proven(found) ? known
                  : is_beyond                ? AnswerKind::separated
                                             : AnswerKind::bounded;
    TACTUS_ASSERT(!(answer.lower_m > answer.upper_m)); // U may be no number: then L is 0.
    return answer;
}

} // namespace tactus
