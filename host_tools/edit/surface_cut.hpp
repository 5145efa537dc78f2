// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/edit/exact_shapes.hpp"
#include "host_tools/edit/surface_faces.hpp"
#include "host_tools/edit/sweep.hpp"
#include "rt_core/math/triangle.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

// Any thread, except the haptic one: calls allocate, and work on their arguments alone.
namespace tactus
{

/// A face that may meet the polyhedron.
struct CutFace
{
    Triangle corners;
    /// True for a face that bounds the solid of an open surface only in thought. It is neither cut
    /// nor removed.
    bool is_wall{false};
};

/// A new triangle: a part of a face, or of the polyhedron's surface.
struct CutPiece
{
    static constexpr std::uint32_t kFacet = 0xFFFF'FFFFU;

    GridTriangle corners{};
    std::uint32_t parent{kFacet}; ///< Index of the face; kFacet for a part of the polyhedron.
};

struct SurfaceCut
{
    std::vector<std::uint32_t> removed; ///< Indices of faces that are cut or lie inside.
    std::vector<CutPiece> pieces;
};

/// Sum of the crossings of the segment from `from` to `to`: 1 for each face that it enters from
/// outside, -1 for each that it leaves. None if a corner or edge lies exactly on the segment.
[[nodiscard]] std::optional<int> crossings(const Vec3& from, const Vec3& to,
                                           std::span<const CutFace> faces);

/// Cuts a surface by a convex polyhedron: removes what is inside, and adds what the polyhedron's
/// surface has inside (carve) or outside (fill) the solid.
///
/// Every decision is exact and every new point is computed once, from one edge and one facet, or
/// from one edge of the polyhedron and one face. If the faces' oriented edges cancel by position,
/// so do those of the result. New points are rounded to the grid, so they err by at most
/// sqrt(3) / 2 quanta. A piece whose corners coincide is dropped; flat pieces are kept, since
/// without them edges would not cancel.
///
/// `faces` are all those that meet the polyhedron's box. `winding` is how often the solid holds
/// the polyhedron's first vertex; without it, the vertex is taken to be on the side of the surface
/// that it sees first. None if an exact decision met zero: try again with shifted vertices.
[[nodiscard]] std::optional<SurfaceCut> cut_surface(std::span<const CutFace> faces,
                                                    const Polyhedron& tool, CutSense sense,
                                                    std::optional<int> winding);

} // namespace tactus
