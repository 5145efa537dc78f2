// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/query/surface_query.hpp"
#include "rt_core/spm/error_code.hpp"

#include <cstdint>

namespace tactus
{

class AbTree;
class PlacedCore;
struct QueryMemory;
struct WalkBudget;

/// gather_surface() for any core: answers the distance question and collects the triangles of the
/// surface within `reach_m` of the core, in one traversal. A point runs the code of
/// surface_query.hpp. A face is measured for other cores in double precision if its bounds leave
/// open whether it is in reach or the nearest.
///
/// Ends if `enough` faces of the surface meet the core, as no distance is below zero. The search
/// order then decides which of them is the nearest and which are listed, and nothing is certified.
///
/// Writes `surface` completely. Haptic thread. Cost: the nodes near the box round the core, about
/// 30 ns for each triangle there and 0.1 to 2 us for each that is measured.
void gather_surface(const AbTree& tree, const PlacedCore& core, double reach_m, QueryMemory& memory,
                    WalkBudget& budget, LocalSurface& surface, ProofShare share = ProofShare::most,
                    std::uint32_t enough = kEnoughMeetingFaces,
                    ErrorCode tolerance = 0) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
