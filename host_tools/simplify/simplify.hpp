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

// Any thread, except the haptic one: it allocates, starts threads and works on its arguments alone.
namespace tactus
{

/// One half-edge collapse v -> u with the data for its inverse, the vsplit record. Star order as in
/// rt_core/spm/page.hpp: star[0] = A, star[1] = B (kNoFace if missing), then the fan.
struct Collapse
{
    static constexpr std::uint32_t kNoFace = 0xFFFF'FFFFU;

    /// Vertex that the collapse removes (v in page.hpp), as an index into the mesh.
    std::uint32_t vertex{0};
    /// Vertex onto which `vertex` moves (u in page.hpp), as an index into the mesh.
    std::uint32_t parent{0};
    std::uint32_t round{0}; ///< Number of the round, from 0; the stars of one round share no face.
    std::uint32_t fan_size{0};
    /// Faces of the star, as indices into the mesh; kNoFace if missing.
    std::array<std::uint32_t, kMaxStarFaces> star{};
    /// Certified bound, in quanta, of each star face *before* this collapse, that is after the
    /// split: every original surface point assigned to the face is within it. 0 if the face was
    /// still original.
    std::array<float, kMaxStarFaces> error{};
};

/// The whole simplification: reverting `collapses` in reverse order from the base gives the mesh
/// exactly.
struct Simplification
{
    std::vector<Collapse> collapses; ///< Collapses in order of execution; rounds ascend.
    std::uint32_t rounds{0};
    std::vector<std::uint32_t> base_faces; ///< Faces of the base mesh, as indices into the mesh.
    /// Corners of `base_faces` after all collapses, as vertices of the mesh.
    std::vector<std::array<std::uint32_t, 3>> base_corners;
    std::vector<float> base_error; ///< Certified bounds of `base_faces`, in quanta.
    bool is_closed{false};         ///< True if the mesh has no border.
};

/// Options of a simplification.
struct SimplifyOptions
{
    /// Number of faces at or below which simplification stops; 1 or more.
    std::uint32_t base_faces{500};
    unsigned threads{1}; ///< Number of threads, 1 to 256; the result does not depend on it.
    /// Callback between rounds, on the calling thread, with the faces left and the faces at the
    /// start. If it returns false, the run is cancelled; empty: no callback.
    std::function<bool(std::size_t faces_left, std::size_t faces_total)> progress;
};

/// Collapses edges in rounds, closes holes that have shrunk to three edges, and absorbs components
/// that cannot shrink into others, until at most `base_faces` faces are left or no collapse is
/// legal; the caller must check the number reached. A coarse face may lie where the source has no
/// surface: that can only lower a distance's lower bound, since upper bounds come from corners and
/// faces of the source. The certificate holds in every dependency-closed cut: each original surface
/// point is within the error of one of its faces. Deterministic for any number of threads. Costs 10
/// to 20 us and about 300 B a face. Refused, with name and place: a mesh that breaks the contract
/// of QuantisedMesh (unused vertices and coordinates beyond 24 bits included), an option out of
/// range, and a cancelled run.
[[nodiscard]] Result<Simplification, Refusal> simplify(const QuantisedMesh& mesh,
                                                       const SimplifyOptions& options);

} // namespace tactus
