// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/query/block_search.hpp"
#include "rt_core/query/surface_query.hpp"

namespace tactus
{

/// As gather_surface() of a point, from any core: the distance question, and the exact triangles
/// within `reach_m` of the core, in one traversal of the tree. A point is asked with the same code
/// as ever, in single precision first; of other cores each face that a bound leaves is measured in
/// double precision.
///
/// Writes `surface` completely. Haptic thread; cost: the nodes near the ball round the core, some
/// 30 ns for each triangle there and 1 to 2 us for each in reach or among the nearest.
void gather_surface(const AbTree& tree, const PlacedCore& core, double reach_m, QueryMemory& memory,
                    WalkBudget& budget, LocalSurface& surface,
                    ProofShare share = ProofShare::most) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
