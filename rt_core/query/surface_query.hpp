// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/query/block_search.hpp"
#include "rt_core/records/local_surface.hpp"

namespace tactus
{

/// Answers the distance question for a point and collects the exact triangles within `reach_m` of
/// it, in one traversal of the tree.
///
/// L is the least of (distance - error) over active faces, U the least of the exact faces'
/// distances and the distances to coarse corners (which are original vertices). Both include the
/// kernels' error laws. Where an exact face is within reach both come from double precision. Where
/// none is, the search stops at kProofShare of the best distance, which is all that "decided"
/// needs. A traversal that runs out of budget, or a tree that is incomplete, lowers L and the
/// certified radius to what was proven.
///
/// Writes `surface` completely. Haptic thread; cost: the nodes near the ball, about 5 ns a triangle
/// in it.
void gather_surface(const AbTree& tree, const Vec3& center_m, double reach_m, QueryMemory& memory,
                    WalkBudget& budget, LocalSurface& surface) noexcept TACTUS_NONBLOCKING;

/// The distance question alone, within `band_m` (infinity for no band): beyond it L is the band and
/// U is infinite.
[[nodiscard]] DistanceAnswer query_distance(const AbTree& tree, const Vec3& center_m, double band_m,
                                            QueryMemory& memory,
                                            WalkBudget& budget) noexcept TACTUS_NONBLOCKING;

/// How much of the best distance is proven when no exact face is in reach: the rest of the search
/// would not change what is decided, and the proof lasts while the tool moves by less.
inline constexpr float kProofShare = 0.9F;

} // namespace tactus
