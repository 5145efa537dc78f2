// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/mesh_error.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/base/result.hpp"

#include <filesystem>

namespace tactus
{

/// Writes a binary little-endian PLY that reads back bit for bit: coordinates as float when every
/// one is exact as such, as double otherwise. The file appears whole or not at all. Refused when
/// the path doesn't end in .ply or can't be written.
[[nodiscard]] Result<Done, MeshError> write_mesh(const std::filesystem::path& path,
                                                 const TriangleMesh& mesh);

} // namespace tactus
