// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/simplify.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tactus
{

/// Face across the edge from corner i to corner i + 1 of each face; Collapse::kNoFace on a border.
using FaceNeighbours = std::vector<std::array<std::uint32_t, 3>>;

/// Finds the faces that share an edge. Refuses, naming the face or edge: no faces or too many,
/// an index out of range, a vertex repeated in a face, a position off the grid, an edge with three
/// faces or with two that run along it in the same direction. Costs a sort of each vertex's edges.
[[nodiscard]] Result<FaceNeighbours, Refusal> match_edges(const QuantisedMesh& mesh);

} // namespace tactus
