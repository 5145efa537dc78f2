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
    TriangleMesh mesh; ///< In quanta; may have vertices that no face uses.
    double seconds{0.0};
};

/// A library that simplifies as its users have it, on one thread and with its defaults.
struct MeshSimplifier
{
    std::string name;
    /// Simplifies to `faces` faces or as near to it as the library comes. The time is that of the
    /// library's own call: making its mesh of ours and ours of its is left out, in its favour.
    SimplifiedMesh (*simplify)(const QuantisedMesh& mesh, std::uint32_t faces);
};

/// The names of those that goals are set against.
inline constexpr const char* kGarlandHeckbert = "CGAL Garland-Heckbert";
inline constexpr const char* kMeshoptimizer = "meshoptimizer";

/// The peers that this build was configured with (TACTUS_BENCH_PEERS) and that simplify. They throw
/// std::runtime_error when they refuse a mesh.
[[nodiscard]] std::vector<MeshSimplifier> mesh_simplifiers();

} // namespace tactus::bench
