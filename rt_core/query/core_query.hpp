// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/query/block_search.hpp"
#include "rt_core/query/surface_query.hpp"

#include <cstdint>

namespace tactus
{

/// As gather_surface() of a point, from any core: the distance question, and the triangles of the
/// surface within `reach_m` of the core, in one traversal of the tree. A point is asked with the
/// same code as ever, in single precision first; of other cores a face is measured in double
/// precision where its bounds leave open whether it is in reach or the nearest.
///
/// Ends where `enough` faces of the surface meet the core: no distance is below zero, and of what
/// meets, which is nearest and listed is left to the search. Nothing is certified then.
///
/// Writes `surface` completely. Haptic thread; cost: the nodes near the box round the core, some
/// 30 ns for each triangle there and 0.1 to 2 us for each that is measured.
void gather_surface(const AbTree& tree, const PlacedCore& core, double reach_m, QueryMemory& memory,
                    WalkBudget& budget, LocalSurface& surface, ProofShare share = ProofShare::most,
                    std::uint32_t enough = kEnoughMeetingFaces,
                    ErrorCode tolerance = 0) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
