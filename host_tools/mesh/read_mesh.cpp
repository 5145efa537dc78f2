// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/read_mesh.hpp"

#include "host_tools/mesh/detail/readers.hpp"
#include "platform/base/printable.hpp"
#include "platform/base/read_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>

namespace tactus
{

namespace
{

/// Indices are 32-bit and the largest value is kept free to mean "none".
constexpr std::size_t kMaxVertices = 0xFFFF'FFFE;
/// Of UTF-8; some editors write it before a text.
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

using Reader = Result<MeshFile, Refusal> (*)(std::string_view);

std::optional<Reader> reader_for(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    if (extension == ".ply")
    {
        return detail::read_ply;
    }
    if (extension == ".obj")
    {
        return detail::read_obj;
    }
    if (extension == ".stl")
    {
        return detail::read_stl;
    }
    if (extension == ".off")
    {
        return detail::read_off;
    }
    return std::nullopt;
}

/// What every format owes: finite coordinates, indices in range, some faces but not too many.
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

Result<MeshFile, Refusal> read_without_name(const std::filesystem::path& path)
{
    const auto bytes = read_file(path);
    if (!bytes)
    {
        return bytes.error();
    }
    const auto reader = reader_for(path);
    if (!reader)
    {
        return Refusal{"unknown kind of mesh file; must end in .ply, .obj, .stl or .off"};
    }
    std::string_view text = bytes.value();
    if (text.starts_with(kByteOrderMark) && *reader != detail::read_stl) // That may be binary.
    {
        text.remove_prefix(kByteOrderMark.size());
    }
    auto file = (*reader)(text);
    if (!file)
    {
        return file;
    }
    if (auto fault = find_fault(file.value().mesh))
    {
        return *fault;
    }
    return file;
}

} // namespace

Result<MeshFile, Refusal> read_mesh_file(const std::filesystem::path& path)
{
    try
    {
        auto file = read_without_name(path);
        if (!file)
        {
            return Refusal{fmt::format("{}: {}", path.string(), file.error().text)};
        }
        return file;
    }
    catch (const std::bad_alloc&)
    {
        return Refusal{fmt::format("{}: there is not enough memory to read it", path.string())};
    }
}

bool is_mesh_file_name(const std::filesystem::path& path)
{
    return reader_for(path).has_value();
}

std::string mesh_is_no_model(const std::string& path)
{
    return fmt::format("'{0}' is a mesh; spm_build {0} -o MODEL.spm makes a model of it",
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
    if (!text.empty() && text.back() != '\n')
    {
        notes.emplace_back("the last line has no line end; the file may have been cut there");
    }
}

} // namespace detail

} // namespace tactus
