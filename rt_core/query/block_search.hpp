// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/query/query_memory.hpp"
#include "rt_core/query/tree_walk.hpp"
#include "rt_core/records/local_surface.hpp"

#include <algorithm>

namespace tactus
{

/// Passes to `search` the blocks that may matter: the remembered block first, then by distance.
///
/// `bound()` of `search` is the distance from the probe, in quanta, beyond which faces do not
/// matter. `test_block(index)` tests a block; false ends the search. `leave(gap)` is called for
/// each unvisited subtree, which is at least `gap` quanta from the probe.
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

/// Proven bounds from a search, in metres from the core.
struct Findings
{
    double exact_lower_m{0.0}; ///< Lower bound on the distance of the nearest exact face.
    /// Lower bound on the distance of the surface that coarse faces within the tolerance stand for.
    double tolerated_lower_m{kInfinity};
    double upper_m{0.0}; ///< Upper bound on the distance of the surface.
    double open_m{0.0};  ///< Lower bound on the distance of inexact and unvisited faces.
    /// Lower bound on the distance of faces left out because they do not matter.
    double pruned_m{0.0};
    /// Lower bound on the distance of exact triangles that did not fit into the list.
    double dropped_m{0.0};
};

/// True if a nearest face is known and no other face can be nearer.
[[nodiscard]] inline bool is_nearest_proven(const Findings& found) noexcept
{
    const double lower_m = std::min(found.exact_lower_m, found.tolerated_lower_m);
    return lower_m <= found.open_m && lower_m <= found.pruned_m && lower_m < kInfinity;
}

/// Factor that makes a length less by its last bits: inexact faces may begin at the length itself.
inline constexpr double kJustBelow = 1.0 - 0x1p-52;

/// Answer within `reach_m`, without the nearest face and points, which the caller fills in.
[[nodiscard]] inline DistanceAnswer answer_from(const Findings& found, double reach_m) noexcept
{
    DistanceAnswer answer;
    answer.upper_m = found.upper_m;
    answer.lower_m = std::max(0.0, std::min({found.exact_lower_m, found.tolerated_lower_m,
                                             found.open_m, found.pruned_m}));
    const double open = std::min(found.open_m, found.dropped_m);
    answer.certified_radius_m = open > 0.0 ? std::min(reach_m, open * kJustBelow) : -1.0;
    const bool is_beyond = answer.lower_m > 0.0 && answer.lower_m == reach_m;
    const AnswerKind known = found.exact_lower_m <= std::max(found.tolerated_lower_m, 0.0)
                                 ? AnswerKind::exact
                                 : AnswerKind::within_tolerance;
    answer.kind = answer.lower_m > reach_m   ? AnswerKind::separated
                  : is_nearest_proven(found) ? known
                  : is_beyond                ? AnswerKind::separated
                                             : AnswerKind::bounded;
    TACTUS_ASSERT(!(answer.lower_m > answer.upper_m)); // U may be NaN; L is 0 then.
    return answer;
}

} // namespace tactus
