// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <filesystem>

// Any thread, but not the haptic one: calls allocate and wait for the file.
namespace tactus
{

/// Whether the name ends in .ply, .obj or .stl, in either case of letters.
[[nodiscard]] bool has_mesh_extension(const std::filesystem::path& path);

/// Writes a mesh in the format that the path's extension names; the file appears whole or not at
/// all.
/// .ply: binary, little-endian; coordinates as float when every one is exact as such, as double
/// otherwise. Reads back bit for bit.
/// .obj: text with as many digits as it takes; reads back bit for bit.
/// .stl: binary, loose triangles; coordinates are rounded to float. Refused when that would put two
/// vertices of different positions into one place.
/// Refused, in one line with the path, when that ends otherwise or can't be written. Faces must
/// name vertices that there are.
[[nodiscard]] Result<Done, Refusal> write_mesh(const std::filesystem::path& path,
                                               const TriangleMesh& mesh);

} // namespace tactus
