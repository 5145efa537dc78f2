// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "platform/base/refusal.hpp"
#include "rt_core/base/result.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

// Any thread, but not the haptic one: calls allocate and wait for the file.
namespace tactus
{

/// More faces than this are refused: each costs one FaceId, and half of those a record id.
inline constexpr std::size_t kMaxFaces = std::size_t{1} << 29U;

/// What a mesh file holds, and what was changed or could not be told while it was read.
struct MeshFile
{
    TriangleMesh mesh;
    std::vector<std::string> notes; ///< One line each, without the file's name.
};

/// Reads a .ply (ASCII or binary, polygons and triangle strips), .obj, .stl (ASCII or binary) or
/// .off file; the extension decides, in either case of letters. Polygons become fans. Text keeps
/// double precision. Vertices and faces keep the file's order; nothing is welded or repaired.
/// Guarantees: every coordinate is finite, every index names a vertex, there are 1 .. kMaxFaces
/// faces. A file that is shorter than it says is refused; where the format can't say (OBJ, a last
/// number without line end) there is a note, and for lines of an OBJ that aren't understood. A
/// UTF-8 byte-order mark is passed over, but in an STL. Costs the file's bytes plus the mesh in
/// memory; a count in a header allocates nothing that the file's size doesn't support.
[[nodiscard]] Result<MeshFile, Refusal> read_mesh_file(const std::filesystem::path& path);

/// The same for callers that don't show notes.
[[nodiscard]] Result<TriangleMesh, Refusal> read_mesh(const std::filesystem::path& path);

/// Whether the name ends like that of a file that read_mesh() reads, in whatever case.
[[nodiscard]] bool is_mesh_file_name(const std::filesystem::path& path);

/// What a program says that was given a mesh where a model belongs.
[[nodiscard]] std::string mesh_is_no_model(const std::string& path);

} // namespace tactus
