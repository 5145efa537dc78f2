// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <cstddef>

namespace tactus::detail
{

/// Border vertices that stitching moved.
struct JoinedBorders
{
    bool are_there{false};   ///< True if the mesh has borders.
    std::size_t vertices{0}; ///< Number of vertices that were moved to another vertex's position.
    double farthest{0.0};    ///< Greatest distance of a moved vertex, in the mesh's unit.
};

/// Moves border vertices within the tolerance of each other to the position of the first. The two
/// sides of a seam that the source has rounded differently thus become one. Corners of one face
/// stay apart. Equal positions must be welded before, and again afterwards. A mesh without borders
/// costs one pass over its faces.
[[nodiscard]] JoinedBorders join_borders(TriangleMesh& mesh, double tolerance);

/// Cuts faces where a border vertex lies within the tolerance of their border edge. The vertex
/// becomes a corner of the parts, so rounding can no longer separate it from the edge.
///
///       a---------b            a----v----b
///        \       /              \  |  /      v belongs to finer faces on the other side.
///         \     /                \ | /
///          \   /                  \|/
///            c                     c
///
/// The first part of a face keeps its number; further parts are appended. Returns the number of
/// added faces. Equal positions must be welded. Vertices from number `first_beside` on belong to
/// neighbouring meshes and are used by no face; they become corners too.
std::size_t stitch_edges(TriangleMesh& mesh, double tolerance, std::size_t first_beside);

} // namespace tactus::detail
