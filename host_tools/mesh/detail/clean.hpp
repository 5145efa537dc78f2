// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

/// The steps of prepare_mesh() that only look at indices and exact equality. All of them keep the
/// order of what stays and return how much went.
namespace tactus::detail
{

using Face = std::array<std::uint32_t, 3>;

/// Lets each face corner name the first vertex with exactly the same position (0 and -0 are the
/// same). Vertices stay where they are; the unused ones are isolated afterwards.
std::size_t weld_equal_positions(TriangleMesh& mesh);

std::size_t drop_degenerate_faces(std::vector<Face>& faces);

/// Drops every face that names the same vertices in the same sense of rotation as one before it.
std::size_t drop_duplicate_faces(std::vector<Face>& faces);

/// Drops vertices that no face uses and renumbers the rest.
std::size_t drop_isolated_vertices(TriangleMesh& mesh);

/// For each face 1 when a face before it names the same vertices the other way round, else 0.
/// Empty when there is no such face.
[[nodiscard]] std::vector<std::uint8_t> mark_opposite_copies(const std::vector<Face>& faces);

} // namespace tactus::detail
