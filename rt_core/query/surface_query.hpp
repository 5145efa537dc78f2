// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/local_surface.hpp"
#include "rt_core/spm/error_code.hpp"

#include <cstdint>

namespace tactus
{

class AbTree;
struct QueryMemory;
struct WalkBudget;

/// Share of the distance that is proven if no exact face is in reach.
enum class ProofShare : std::uint8_t
{
    most, ///< Share kProofShare: the answer stays valid while the tool moves by less.
    all,  ///< Whole distance: the nearest face is found however far it is.
};
inline constexpr float kProofShare = 0.9F;

[[nodiscard]] constexpr float share_of(ProofShare share) noexcept
{
    return share == ProofShare::all ? 1.0F : kProofShare;
}

/// Answers the distance question for a point and collects the triangles of the surface within
/// `reach_m` of it, in one traversal of the tree. Faces with an error up to `tolerance` count as
/// the surface, like exact ones, and their error is subtracted from L; 0: exact faces only.
///
/// L is the least of (distance - error) over active faces. U is the least of the exact faces'
/// distances and the distances to coarse corners (which are original vertices). Both include the
/// kernels' error laws. If the surface is within reach, both come from double precision. Otherwise
/// the search stops at `share` of the best distance, which suffices for "separated". If the budget
/// runs out or the tree is incomplete, L and the certified radius sink to the proven values.
///
/// Writes `surface` completely. Haptic thread. Cost: the nodes near the sphere, about 5 ns for each
/// triangle in it.
void gather_surface(const AbTree& tree, const Vec3& center_m, double reach_m, QueryMemory& memory,
                    WalkBudget& budget, LocalSurface& surface, ProofShare share = ProofShare::most,
                    ErrorCode tolerance = 0) noexcept TACTUS_NONBLOCKING;

/// Answers the distance question alone, within `band_m`: for a farther surface L is `band_m` and U
/// is infinite. An infinite `band_m` sets no limit.
[[nodiscard]] DistanceAnswer query_distance(const AbTree& tree, const Vec3& center_m, double band_m,
                                            QueryMemory& memory,
                                            WalkBudget& budget) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
