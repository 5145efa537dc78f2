// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/quantised_mesh.hpp"
#include "host_tools/simplify/simplify.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

// Any thread, but not the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// The two ends of an edge.
using MeshEdge = std::array<std::uint32_t, 2>;

/// Rings of edges round handles that kept the mesh from shrinking further than `coarse`.
///
/// A record brings at most two faces and one vertex, so a closed base with g handles has at least
/// 4 g faces more than twice its vertices less four. Below that only a mesh comes whose handles are
/// cut open; the two borders of a cut lie in one place, so there is no gap, and both close in
/// coarse levels as any hole does.
///
/// Where a handle is left, the base has three edges that make no face and part nothing:
///
///     source   ====( handle )====      base   a---b     a, b and c stand for the vertices that
///                                              \ /      moved onto them, each a patch of the
///                                               c       source: a ring through them is found.
///
/// No two rings have a vertex in common, and no ring parts what is whole with the others cut, so
/// some handles may be left: the next simplification shows them. Costs about as much as a round of
/// collapses.
[[nodiscard]] std::vector<std::vector<MeshEdge>> find_handle_rings(const QuantisedMesh& mesh,
                                                                   const Simplification& coarse);

/// Gives the faces on each side of the edges corners of their own. Copies of vertices come last;
/// everything else keeps its order. Returns how many there are. The mesh must be what
/// QuantisedMesh says.
std::size_t cut_open(QuantisedMesh& mesh, std::span<const MeshEdge> edges);

} // namespace tactus
