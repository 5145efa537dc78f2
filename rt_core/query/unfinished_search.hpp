// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/query/pair_walk.hpp"

#include <cstdint>

namespace tactus
{

/// Unvisited part of a search that its budget cut, for the next search of the same two models. It
/// is invalid after a change of either tree. 4 KiB.
struct UnfinishedSearch
{
    PairWalk::LeftPairs left; ///< Unvisited pairs; empty: nothing to continue.
    std::uint64_t own_change{0};
    std::uint64_t other_change{0};
    double bound_m{0.0};   ///< Bound of the search: visited faces that were not found are farther.
    double nearest_m{0.0}; ///< Lower bound on the distance of faces that were found or left out.
    double moved_m{0.0};   ///< Motion of the other surface since the search.
};

} // namespace tactus
