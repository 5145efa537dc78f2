// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <cstddef>

namespace tactus::detail
{

struct JoinedBorders
{
    bool are_there{false};   ///< Whether the mesh has borders at all.
    std::size_t vertices{0}; ///< That have another's position now.
    double farthest{0.0};    ///< How far one of them was from it, at most.
};

/// Gives border vertices that lie within the tolerance of each other the position of the first of
/// them, so that two sides of a seam which the source has rounded apart are one. Corners of one
/// face stay apart. Equal positions must be welded before, and again afterwards. A mesh without
/// borders costs one pass over its faces.
[[nodiscard]] JoinedBorders join_borders(TriangleMesh& mesh, double tolerance);

/// Cuts faces where a border vertex lies within the tolerance of their border edge, so that the
/// vertex becomes one of their corners: the edge and what meets it there can't be rounded apart any
/// more.
///
///       a---------b            a----v----b
///        \       /              \  |  /      v belongs to finer faces on the other side.
///         \     /                \ | /
///          \   /                  \|/
///            c                     c
///
/// The first part of a face keeps its number, the others come last. Returns how many faces came.
/// Equal positions must be welded. Vertices from number `first_beside` on are a neighbour's, which
/// no face uses yet; they become corners likewise.
std::size_t stitch_edges(TriangleMesh& mesh, double tolerance, std::size_t first_beside);

} // namespace tactus::detail
