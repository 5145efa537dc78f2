// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <cstddef>

namespace tactus::detail
{

struct TurnedPieces
{
    std::size_t outward{0}; ///< Pieces that were inside out.
    std::size_t inward{0};  ///< Shells inside another one, which are voids and faced outwards.
};

/// Turns the closed pieces whose faces look the wrong way. A piece that lies in an even number of
/// other closed pieces is a body and faces outwards; one that lies in an odd number is a void and
/// faces inwards. Left as they are: open pieces, pieces without a volume, and closed pieces within
/// the box of an open one, since that may or may not enclose them. Pieces that cross or touch don't
/// enclose each other. The mesh must be what split_into_manifold() makes: each vertex has one fan.
/// Linear in the mesh where faces are small beside their piece.
[[nodiscard]] TurnedPieces turn_closed_pieces(TriangleMesh& mesh);

} // namespace tactus::detail
