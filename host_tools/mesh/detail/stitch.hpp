// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <cstddef>

namespace tactus::detail
{

struct JoinedBorders
{
    bool are_there{false};   ///< True if the mesh has borders.
    std::size_t vertices{0}; ///< Vertices that were moved to another one's position.
    double farthest{0.0};    ///< Greatest distance of such a move.
};

/// Moves border vertices within the tolerance of each other to the position of the first of them,
/// so that the two sides of a seam, which the source has rounded differently, become one. Corners
/// of one face stay apart. Equal positions must be welded before, and again afterwards. A mesh
/// without borders costs one pass over its faces.
[[nodiscard]] JoinedBorders join_borders(TriangleMesh& mesh, double tolerance);

/// Cuts faces where a border vertex lies within the tolerance of their border edge, so that the
/// vertex becomes one of their corners and rounding can no longer separate it from the edge.
///
///       a---------b            a----v----b
///        \       /              \  |  /      v belongs to finer faces on the other side.
///         \     /                \ | /
///          \   /                  \|/
///            c                     c
///
/// The first part of a face keeps its number, the others come last. Returns the number of added
/// faces. Equal positions must be welded. Vertices from number `first_beside` on are those of a
/// neighbour, not yet used by faces; they become corners too.
std::size_t stitch_edges(TriangleMesh& mesh, double tolerance, std::size_t first_beside);

} // namespace tactus::detail
