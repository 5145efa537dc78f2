// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

// Any thread: values.
namespace tactus
{

/// A point of a model's grid, in quanta.
using GridPoint = std::array<std::int32_t, 3>;

/// A mesh on the integer grid, the basis of the certificate and the result of full refinement. It
/// is 2-manifold with borders: every edge has at most two faces, in opposite directions, and every
/// vertex one fan (open or closed). Two vertices may share a position.
struct QuantisedMesh
{
    std::vector<GridPoint> positions;                ///< Positions in quanta, 0 .. 2^bits - 1.
    std::vector<std::array<std::uint32_t, 3>> faces; ///< Faces of three different vertices each.
};

} // namespace tactus
