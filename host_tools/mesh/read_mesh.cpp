// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/read_mesh.hpp"

#include "host_tools/mesh/detail/file_kind.hpp"
#include "host_tools/mesh/detail/read_input.hpp"
#include "host_tools/mesh/detail/readers.hpp"
#include "host_tools/mesh/detail/text_cursor.hpp"
#include "transport/base/printable.hpp"
#include "transport/base/read_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <optional>

namespace tactus
{

namespace
{

/// Maximum number of vertices: indices have 32 bits, and the largest value means "none".
constexpr std::size_t kMaxVertices = 0xFFFF'FFFE;
using Reader = Result<MeshFile, Refusal> (*)(std::string_view);

struct FormatEntry
{
    std::string_view name;
    Reader read;
};

/// Formats in the order of MeshFormat.
constexpr std::array<FormatEntry, 4> kFormats{{{"ply", detail::read_ply},
                                               {"obj", detail::read_obj},
                                               {"stl", detail::read_stl},
                                               {"off", detail::read_off}}};

std::optional<MeshFormat> format_of(const std::filesystem::path& path)
{
    const std::string extension = path.extension().string();
    return extension.empty() ? std::nullopt : mesh_format(extension.substr(1));
}

/// Fault of a mesh, for every format: coordinates that are not finite, indices out of range, no
/// faces or too many.
std::optional<Refusal> find_fault(const TriangleMesh& mesh)
{
    if (mesh.faces.empty())
    {
        return Refusal{fmt::format("holds no faces ({} vertices); at least 1 is needed",
                                   mesh.positions.size())};
    }
    if (mesh.faces.size() > kMaxFaces)
    {
        return Refusal{
            fmt::format("holds {} faces; at most {} (2^29)", mesh.faces.size(), kMaxFaces)};
    }
    if (mesh.positions.size() > kMaxVertices)
    {
        return Refusal{fmt::format("holds {} vertices; at most {} (2^32 - 2)",
                                   mesh.positions.size(), kMaxVertices)};
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            if (!std::isfinite(mesh.positions[v][axis]))
            {
                return Refusal{fmt::format("vertex {} (from 0): {} is {}; must be finite", v,
                                           "xyz"[axis], mesh.positions[v][axis])};
            }
        }
    }
    for (const auto& face : mesh.faces)
    {
        TACTUS_ASSERT(std::max({face[0], face[1], face[2]}) < mesh.positions.size());
    }
    return std::nullopt;
}

Result<MeshFile, Refusal> read_without_name(const std::filesystem::path& path,
                                            std::optional<MeshFormat> format)
{
    const auto bytes = format ? detail::read_input(path) : read_file(path);
    if (!bytes)
    {
        return bytes.error();
    }
    const auto known = format ? format : format_of(path);
    Result<MeshFile, Refusal> file =
        Refusal{"unknown kind of mesh file; must end in .ply, .obj, .stl or .off"};
    if (known)
    {
        file = kFormats[static_cast<std::size_t>(*known)].read(bytes.value());
    }
    const auto refused = file ? find_fault(file.value().mesh) : std::optional(file.error());
    if (!refused)
    {
        return file;
    }
    const std::string kind = detail::other_kind(bytes.value(), known);
    return kind.empty() ? *refused : Refusal{kind};
}

} // namespace

std::string_view format_name(MeshFormat format)
{
    return kFormats[static_cast<std::size_t>(format)].name;
}

std::optional<MeshFormat> mesh_format(std::string_view name)
{
    const auto entry = std::ranges::find(kFormats, detail::lower(name), &FormatEntry::name);
    return entry == kFormats.end()
               ? std::nullopt
               : std::optional(static_cast<MeshFormat>(entry - kFormats.begin()));
}

Result<MeshFile, Refusal> read_mesh_file(const std::filesystem::path& path,
                                         std::optional<MeshFormat> format)
{
    const std::string name = detail::input_name(path);
    try
    {
        auto file = read_without_name(path, format);
        if (!file)
        {
            return Refusal{fmt::format("{}: {}", name, file.error().text)};
        }
        return file;
    }
    catch (const std::bad_alloc&)
    {
        return Refusal{fmt::format("{}: there is not enough memory to read it", name)};
    }
}

bool is_mesh_file_name(const std::filesystem::path& path)
{
    return format_of(path).has_value();
}

std::string mesh_is_no_model(const std::string& path)
{
    return fmt::format("'{0}' is a mesh; build a model with: spm_build {0} -o MODEL.spm",
                       printable(path));
}

Result<TriangleMesh, Refusal> read_mesh(const std::filesystem::path& path)
{
    auto file = read_mesh_file(path);
    if (!file)
    {
        return file.error();
    }
    return std::move(file.value().mesh);
}

namespace detail
{

void note_missing_line_end(std::string_view text, std::vector<std::string>& notes)
{
    if (!text.empty() && text.back() != '\n' && text.back() != '\r')
    {
        notes.emplace_back("the last line has no line end; the file may have been cut there");
    }
}

} // namespace detail

} // namespace tactus
