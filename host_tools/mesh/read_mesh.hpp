// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Any thread, but not the haptic one: calls allocate and wait for the file.
namespace tactus
{

/// More faces than this are refused: each costs one FaceId, and half of those a record id.
inline constexpr std::size_t kMaxFaces = std::size_t{1} << 29U;

/// The formats that are read.
enum class MeshFormat
{
    ply,
    obj,
    stl,
    off,
};

/// "ply" and the like, as files end and as --format names it.
[[nodiscard]] std::string_view format_name(MeshFormat format);
/// The format of this name, in either case of letters.
[[nodiscard]] std::optional<MeshFormat> mesh_format(std::string_view name);

/// What a mesh file holds, and what was changed or could not be told while it was read.
struct MeshFile
{
    TriangleMesh mesh;
    std::vector<std::string> notes; ///< One line each, without the file's name.
};

/// Reads a .ply (ASCII or binary, polygons and triangle strips), .obj, .stl (ASCII or binary) or
/// .off file; `format` decides, or else the extension, in either case of letters. With a format
/// the path may also be a pipe, a device or "-", which is standard input; they are read to their
/// end. Polygons are cut into triangles. Text keeps double precision. Vertices and faces keep the
/// file's order; nothing is welded or repaired. Guarantees: every coordinate is finite, every index
/// names a vertex, there are 1 .. kMaxFaces faces. A file that is shorter than it says is refused,
/// and in words for what it is if it is none of its format. There is a note where the format can't
/// say so (OBJ, a last number without line end), for what is left out behind complete data, and for
/// lines that aren't understood. A UTF-8 byte-order mark is passed over. Costs the file's bytes
/// plus the mesh in memory; a count in a header allocates nothing that the file's size doesn't
/// support.
[[nodiscard]] Result<MeshFile, Refusal>
read_mesh_file(const std::filesystem::path& path, std::optional<MeshFormat> format = std::nullopt);

/// The same for callers that don't show notes.
[[nodiscard]] Result<TriangleMesh, Refusal> read_mesh(const std::filesystem::path& path);

/// Whether the name ends like that of a file that read_mesh() reads, in whatever case.
[[nodiscard]] bool is_mesh_file_name(const std::filesystem::path& path);

/// What a program says that was given a mesh where a model belongs.
[[nodiscard]] std::string mesh_is_no_model(const std::string& path);

} // namespace tactus
