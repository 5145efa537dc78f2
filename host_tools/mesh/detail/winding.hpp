// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <cstddef>

namespace tactus::detail
{

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

} // namespace tactus::detail
