// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/quantised_mesh.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/limits.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

// Any thread, but not the haptic one: it allocates, starts threads and works on its arguments
// alone.
namespace tactus
{

/// One half-edge collapse v -> u and what its inverse, the vsplit record, needs.
/// Star order as in rt_core/spm/page.hpp: star[0] = A, star[1] = B (kNoFace when missing), then the
/// fan.
struct Collapse
{
    static constexpr std::uint32_t kNoFace = 0xFFFF'FFFFU;

    std::uint32_t vertex{0}; ///< v, an index into the mesh.
    std::uint32_t parent{0}; ///< u.
    std::uint32_t round{0};  ///< Stars of one round are disjoint; rounds count from 0.
    std::uint32_t fan_size{0};
    std::array<std::uint32_t, kMaxStarFaces> star{}; ///< Faces of the mesh.
    /// Certified bound, in quanta, of each star face as it was *before* this collapse, that is
    /// after the split: every original surface point that the face stands for is within it. 0 when
    /// the face was still original.
    std::array<float, kMaxStarFaces> error{};
};

/// The whole simplification: undoing `collapses` backwards from the base gives the mesh exactly.
struct Simplification
{
    std::vector<Collapse> collapses; ///< In order of execution; rounds ascend.
    std::uint32_t rounds{0};
    std::vector<std::uint32_t> base_faces;                  ///< Faces of the mesh that remain.
    std::vector<std::array<std::uint32_t, 3>> base_corners; ///< Their corners now, mesh vertices.
    std::vector<float> base_error;                          ///< Their certified bounds, in quanta.
    bool is_closed{false};                                  ///< The mesh has no border.
};

struct SimplifyOptions
{
    std::uint32_t base_faces{500}; ///< Stop at or below this many faces; 1 or more.
    unsigned threads{1};           ///< 1 to 256; the result does not depend on it.
    /// Called between rounds, on the calling thread, with faces left and faces at the start; return
    /// false to cancel.
    std::function<bool(std::size_t faces_left, std::size_t faces_total)> progress;
};

/// Collapses edges in rounds, closes holes that have shrunk to three edges, and lets components
/// that can't shrink vanish into others, until at most `base_faces` faces are left or nothing is
/// legal: more than asked for only the caller can refuse. A coarse face may so lie where the source
/// has nothing: it can only lower a distance's lower bound, since upper bounds come from corners
/// and faces of the source. The certificate holds in every dependency-closed cut: each original
/// surface point is within the error of one of its faces. Same input, same result, for any number
/// of threads. Costs 10 to 20 us and about 300 B a face. Refuses, by name and place, a mesh that
/// breaks the contract of QuantisedMesh (unused vertices and coordinates beyond 24 bits included),
/// an option out of range, and a cancelled run.
[[nodiscard]] Result<Simplification, Refusal> simplify(const QuantisedMesh& mesh,
                                                       const SimplifyOptions& options);

} // namespace tactus
