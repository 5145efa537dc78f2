// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/quantised_mesh.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tactus::bench
{

struct SimplifiedMesh
{
    TriangleMesh mesh; ///< Mesh in quanta; may have vertices that no face uses.
    double seconds{0.0};
};

/// Library that simplifies with its defaults, on one thread.
struct MeshSimplifier
{
    std::string name;
    /// Simplifies to `faces` faces or the nearest number that the library reaches. The time is that
    /// of the library's own call; conversions of meshes are not included, in its favour.
    SimplifiedMesh (*simplify)(const QuantisedMesh& mesh, std::uint32_t faces);
};

/// Names of the peers that goals refer to.
inline constexpr const char* kGarlandHeckbert = "CGAL Garland-Heckbert";
inline constexpr const char* kMeshoptimizer = "meshoptimizer";

/// Configured peers (TACTUS_BENCH_PEERS) that simplify. They throw std::runtime_error if they
/// refuse a mesh.
[[nodiscard]] std::vector<MeshSimplifier> mesh_simplifiers();

} // namespace tactus::bench
