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

// Any thread, except the haptic one: calls allocate and wait for the file.
namespace tactus
{

/// Maximum number of faces of a mesh file, 2^29.
inline constexpr std::size_t kMaxFaces = std::size_t{1} << 29U;

/// Formats that can be read.
enum class MeshFormat
{
    ply,
    obj,
    stl,
    off,
};

/// Name of a format, as in file extensions and --format: "ply", "obj", "stl" or "off".
[[nodiscard]] std::string_view format_name(MeshFormat format);
/// Format of a name, in either case of letters; none for other names.
[[nodiscard]] std::optional<MeshFormat> mesh_format(std::string_view name);

/// Content of a mesh file, with notes on changed or unreadable parts.
struct MeshFile
{
    TriangleMesh mesh;
    std::vector<std::string> notes; ///< Notes, one line each, without the file's name.
};

/// Reads a .ply (ASCII or binary, polygons and triangle strips), .obj, .stl (ASCII or binary) or
/// .off file. `format` decides, otherwise the extension, in either case of letters. With a format
/// the path may also be a pipe, a device or "-", which is standard input; they are read to their
/// end. Polygons are cut into triangles. Text keeps double precision. Vertices and faces keep the
/// file's order; nothing is welded or repaired. Guarantees: every coordinate is finite, every index
/// is that of a vertex, there are 1 .. kMaxFaces faces. A truncated file is refused; a file of
/// another format is refused with the name of that format. Notes report truncation that the format
/// cannot detect (OBJ, a last number without line end), data after the complete content, and lines
/// that are not understood. A UTF-8 byte-order mark is skipped. Costs the file's bytes plus the
/// mesh in memory; a count in a header allocates nothing beyond the file's size.
[[nodiscard]] Result<MeshFile, Refusal>
read_mesh_file(const std::filesystem::path& path, std::optional<MeshFormat> format = std::nullopt);

/// Reads a mesh without notes.
[[nodiscard]] Result<TriangleMesh, Refusal> read_mesh(const std::filesystem::path& path);

/// True if read_mesh() reads files with this extension, in either case of letters.
[[nodiscard]] bool is_mesh_file_name(const std::filesystem::path& path);

/// Message of a program that received a mesh in place of a model.
[[nodiscard]] std::string mesh_is_no_model(const std::string& path);

} // namespace tactus
