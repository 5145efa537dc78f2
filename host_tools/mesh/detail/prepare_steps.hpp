// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

/// Steps of prepare_mesh(). Functions that weld or drop use only indices and exact equality, keep
/// the order of the remaining items and return the number removed.
namespace tactus::detail
{

using Face = std::array<std::uint32_t, 3>;

/// Changes each face corner to the first vertex with exactly the same position (0 and -0 are the
/// same). No vertex is removed; the unused ones become isolated.
std::size_t weld_equal_positions(TriangleMesh& mesh);

std::size_t drop_degenerate_faces(std::vector<Face>& faces);

/// Drops every face that has the vertices and the orientation of an earlier face.
std::size_t drop_duplicate_faces(std::vector<Face>& faces);

/// Drops vertices that no face uses and renumbers the rest.
std::size_t drop_isolated_vertices(TriangleMesh& mesh);

/// Flags by face: 1 if an earlier face has the same vertices in the opposite orientation, otherwise
/// 0. Empty if there is no such face.
[[nodiscard]] std::vector<std::uint8_t> mark_opposite_copies(const std::vector<Face>& faces);

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

/// Numbers of pieces whose faces were reversed.
struct TurnedPieces
{
    std::size_t outward{0}; ///< Pieces that were inside out.
    std::size_t inward{0};  ///< Voids: shells inside another piece whose faces pointed outwards.
};

/// Reverses the closed pieces of wrong orientation. A piece inside an even number of other closed
/// pieces is a body and faces outwards; one inside an odd number is a void and faces inwards.
/// Unchanged: open pieces, pieces without volume, and closed pieces within the box of an open one,
/// which may or may not enclose them. Pieces that cross or touch do not enclose each other. The
/// mesh must come from split_into_manifold(): each vertex has one fan. Linear in the mesh if faces
/// are small compared to their piece.
[[nodiscard]] TurnedPieces turn_closed_pieces(TriangleMesh& mesh);

/// Largest steps of a grid that keep the shape of a mesh, in the mesh's unit; infinite if any step
/// does.
struct GridNeed
{
    /// A sixteenth of the shortest edges' length, which keeps their lengths and directions within a
    /// few percent.
    double for_edges{std::numeric_limits<double>::infinity()};
    /// Step at which, in patches of some fifty faces without a sharp edge, the spread of normals is
    /// at least twice their error from rounding. Flat patches have no need.
    double for_relief{std::numeric_limits<double>::infinity()};
};

/// Measures the edges of some thousand faces and some hundred patches. Equal positions must be
/// welded and faces without three corners dropped. Deterministic. Costs a list of each vertex's
/// faces and some milliseconds.
[[nodiscard]] GridNeed measure_grid_need(const TriangleMesh& mesh);

/// Edges and vertices that a split into manifold pieces changed.
struct ManifoldSplit
{
    std::size_t cut_edges{0};
    /// Original vertex of each added vertex.
    std::vector<std::uint32_t> copy_of;
};

/// Renumbers face corners until every edge has at most two faces, in opposite directions, and every
/// vertex one fan. New vertices are numbered from `vertex_count` on. Each face must have three
/// different vertices, and no two faces may be equal up to rotation. Linear, except for a sort
/// around each vertex.
[[nodiscard]] ManifoldSplit split_into_manifold(std::vector<std::array<std::uint32_t, 3>>& faces,
                                                std::uint32_t vertex_count);

} // namespace tactus::detail
