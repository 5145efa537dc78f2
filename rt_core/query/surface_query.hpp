// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/query/tree_walk.hpp"
#include "rt_core/records/local_surface.hpp"

namespace tactus
{

/// Answers the distance question for a point and collects the exact triangles within `reach_m` of
/// it, in one traversal of the tree.
///
/// L is the least of (distance - error) over active faces, U the least of the exact faces'
/// distances and the distances to coarse corners (which are original vertices). Both include the
/// kernel's error law. A traversal that runs out of budget, or a tree that is incomplete, lowers L
/// and the certified radius to what was proven.
///
/// Writes `surface` completely. Not inlined: a rehearsal must run the same machine code.
/// Haptic thread; cost: the nodes near the ball, about 25 ns a triangle in it.
void gather_surface(const AbTree& tree, const Vec3& center_m, double reach_m, WalkBudget& budget,
                    LocalSurface& surface) noexcept;

} // namespace tactus
