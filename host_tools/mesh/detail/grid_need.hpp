// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <limits>

namespace tactus::detail
{

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

} // namespace tactus::detail
