// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

/// Steps of prepare_mesh() that use only indices and exact equality. All keep the order of the
/// remaining items and return the number removed.
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

} // namespace tactus::detail
