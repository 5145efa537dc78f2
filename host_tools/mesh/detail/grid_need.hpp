// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <limits>

namespace tactus::detail
{

/// The largest steps of a grid that leave a mesh its shape, in the mesh's unit; infinite where
/// there is nothing to lose.
struct GridNeed
{
    /// A sixteenth of the shortest edges' length: their lengths and directions stay right to a few
    /// percent.
    double for_edges{std::numeric_limits<double>::infinity()};
    /// In patches of some fifty faces that have no sharp edge, how far normals are spread is at
    /// least twice what rounding turns them by. Flat patches need nothing.
    double for_relief{std::numeric_limits<double>::infinity()};
};

/// Measures the edges of some thousand faces and some hundred patches. Equal positions must be
/// welded and faces without three corners dropped. The same mesh gives the same need. Costs a list
/// of each vertex's faces and some milliseconds.
[[nodiscard]] GridNeed measure_grid_need(const TriangleMesh& mesh);

} // namespace tactus::detail
