// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <filesystem>

// Any thread, except the haptic one: calls allocate and wait for the file.
namespace tactus
{

/// True if the name ends in .ply, .obj or .stl, in either case of letters.
[[nodiscard]] bool has_mesh_extension(const std::filesystem::path& path);

/// Writes a mesh in the format of the path's extension; the file appears as a whole or not at all.
/// .ply: binary, little-endian; coordinates as float if all are exact as float, otherwise as
/// double. Reads back bit for bit.
/// .obj: text with as many digits as needed; reads back bit for bit.
/// .stl: binary, separate triangles; coordinates are rounded to float. Refused if that would merge
/// two vertices with different positions.
/// Refused, in one line with the path, for another extension or a file that cannot be written.
/// Faces must consist of existing vertices.
[[nodiscard]] Result<Done, Refusal> write_mesh(const std::filesystem::path& path,
                                               const TriangleMesh& mesh);

} // namespace tactus
