// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/read_mesh.hpp"

#include "host_tools/mesh/detail/readers.hpp"
#include "host_tools/mesh/detail/text_cursor.hpp"
#include "transport/base/printable.hpp"
#include "transport/base/read_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <utility>

namespace tactus
{

namespace
{

using namespace std::string_view_literals;
using Kind = std::pair<std::string_view, std::string_view>;

/// First bytes of binary files, and messages about them.
constexpr std::array<Kind, 18> kBinaryKinds{{
    {"\x1F\x8B"sv, "is compressed by gzip: unpack it, or pipe it: zcat FILE | spm_build - --format "
                   "ply, or obj, stl, off"},
    {"PK\x03\x04"sv, "is a ZIP archive, as .zip and .3mf are: unpack it, or export a mesh"},
    {"BZh"sv, "is compressed by bzip2: unpack it first"},
    {"\xFD"
     "7zXZ"sv,
     "is compressed by xz: unpack it first"},
    {"\x28\xB5\x2F\xFD"sv, "is compressed by zstd: unpack it first"},
    {"7z\xBC\xAF"sv, "is a 7-Zip archive: unpack it first"},
    {"\xFF\xFE"sv, "is text in UTF-16: convert it with iconv -f UTF-16 -t UTF-8"},
    {"\xFE\xFF"sv, "is text in UTF-16: convert it with iconv -f UTF-16 -t UTF-8"},
    {"glTF"sv, "is a binary glTF scene: its name must end in .glb"},
    {"TACTSPM"sv, "is a model already"},
    {"Kaydara FBX"sv, "is an FBX file: export it as .ply, .obj, .stl or .off"},
    {"BLENDER"sv, "is a Blender file: export a mesh from it"},
    {"DRACO"sv, "is a mesh compressed by Draco: unpack it first"},
    {"%PDF"sv, "is a PDF document, not a mesh"},
    {"\x89PNG"sv, "is a picture, not a mesh"},
    {"\xFF\xD8\xFF"sv, "is a picture, not a mesh"},
    {"\x7F"
     "ELF"sv,
     "is a program, not a mesh"},
    {"ISO-10303"sv, "is a STEP file: export a mesh from a CAD program"},
}};

/// First words of text files, in lower case, and messages about them.
constexpr std::array<Kind, 7> kTextKinds{{
    {"version https://git-lfs"sv,
     "is a Git LFS pointer, not the mesh itself: fetch the mesh with 'git lfs pull'"},
    {"<!doctype html"sv, "is an HTML page, not a mesh: download the mesh file itself"},
    {"<html"sv, "is an HTML page, not a mesh: download the mesh file itself"},
    {"<"sv, "is XML, as in COLLADA, X3D and VTK files: export it as .ply, .obj, .stl or .off"},
    {"{"sv, "is JSON; a glTF scene's name must end in .gltf"},
    {"iso-10303"sv, "is a STEP file: export a mesh from a CAD program"},
    {"# vtk"sv, "is a VTK file: export it as .ply, .obj, .stl or .off"},
}};

/// First words of the formats that can be read.
constexpr std::array<std::pair<std::string_view, MeshFormat>, 5> kOwnKinds{{
    {"ply"sv, MeshFormat::ply},
    {"solid"sv, MeshFormat::stl},
    {"off"sv, MeshFormat::off},
    {"coff"sv, MeshFormat::off},
    {"v"sv, MeshFormat::obj},
}};

bool is_control(char c)
{
    const auto byte = static_cast<unsigned char>(c);
    return byte < ' ' && (c < '\t' || c > '\r');
}

/// True if every second byte is 0, as in UTF-16 with ASCII letters.
bool is_utf16_without_mark(std::string_view start)
{
    std::array<std::size_t, 2> zeros{};
    for (std::size_t i = 0; i < start.size(); ++i)
    {
        zeros[i % 2] += start[i] == '\0' ? 1U : 0U;
    }
    const std::size_t half = start.size() / 2;
    return half > 4 && ((zeros[0] >= half && zeros[1] == 0) || (zeros[1] >= half && zeros[0] == 0));
}

/// Message about a refused file, judged by its first bytes: the format that it has instead of the
/// expected one, if any, and a remedy; empty if unknown. The readers do not use it to select a
/// format.
std::string other_kind(std::string_view bytes, std::optional<MeshFormat> expected)
{
    for (const auto& [start, kind] : kBinaryKinds)
    {
        if (bytes.starts_with(start))
        {
            return std::string(kind);
        }
    }
    const std::string_view start = detail::without_byte_order_mark(bytes).substr(0, 512);
    if (is_utf16_without_mark(start.substr(0, start.size() & ~std::size_t{1})))
    {
        return "is text in UTF-16: convert it with iconv -f UTF-16LE -t UTF-8";
    }
    if (std::ranges::any_of(start, is_control))
    {
        return {};
    }
    detail::TextCursor cursor(start);
    const std::string first = detail::lower(cursor.next_token());
    const std::string rest = first + detail::lower(start.substr(cursor.position()));
    for (const auto& [words, kind] : kTextKinds)
    {
        if (rest.starts_with(words))
        {
            return std::string(kind);
        }
    }
    for (const auto& [word, format] : kOwnKinds)
    {
        if (first == word && format != expected)
        {
            return fmt::format("begins like a {} file, unlike its name: give --format {}",
                               format_name(format), format_name(format));
        }
    }
    return expected == MeshFormat::stl && first != "solid" && !first.empty()
               ? fmt::format("is a text that begins with {}; a text STL begins with 'solid'",
                             detail::quote(detail::TextCursor(start).next_token()))
               : std::string{};
}

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
    const std::string kind = other_kind(bytes.value(), known);
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
