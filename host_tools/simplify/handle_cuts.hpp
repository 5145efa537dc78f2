// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/quantised_mesh.hpp"
#include "host_tools/simplify/simplify.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

// Any thread, except the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// The two ends of an edge.
using MeshEdge = std::array<std::uint32_t, 2>;

/// Rings of edges around handles that kept the mesh from shrinking below `coarse`.
///
/// A closed base mesh with V vertices and g handles has at least 2 V - 4 + 4 g faces, since a
/// record adds at most two faces and one vertex. Only a mesh whose handles are cut open has fewer.
/// The two borders of a cut coincide, so there is no gap, and both close in coarse levels like any
/// hole.
///
/// At a remaining handle, the base has three edges that form no face and separate nothing:
///
///     source   ====( handle )====      base   a---b     a, b and c represent the vertices that
///                                              \ /      moved onto them, each a patch of the
///                                               c       source: a ring through them is found.
///
/// No two rings have a common vertex, and no ring separates the mesh after the cuts along the other
/// rings. Handles may therefore remain; another simplification and call find them. Costs about as
/// much as a round of collapses.
[[nodiscard]] std::vector<std::vector<MeshEdge>> find_handle_rings(const QuantisedMesh& mesh,
                                                                   const Simplification& coarse);

/// Cuts the mesh open along the edges: the faces on each side get their own corners. Copies of
/// vertices are appended; the order of vertices and faces stays. Returns the number of copies. The
/// mesh must meet QuantisedMesh's contract.
std::size_t cut_open(QuantisedMesh& mesh, std::span<const MeshEdge> edges);

} // namespace tactus
