// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/file_kind.hpp"

#include "host_tools/mesh/detail/text_cursor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace tactus::detail
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

} // namespace

std::string other_kind(std::string_view bytes, std::optional<MeshFormat> expected)
{
    for (const auto& [start, kind] : kBinaryKinds)
    {
        if (bytes.starts_with(start))
        {
            return std::string(kind);
        }
    }
    const std::string_view start = without_byte_order_mark(bytes).substr(0, 512);
    if (is_utf16_without_mark(start.substr(0, start.size() & ~std::size_t{1})))
    {
        return "is text in UTF-16: convert it with iconv -f UTF-16LE -t UTF-8";
    }
    if (std::ranges::any_of(start, is_control))
    {
        return {};
    }
    TextCursor cursor(start);
    const std::string first = lower(cursor.next_token());
    const std::string rest = first + lower(start.substr(cursor.position()));
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
                             quote(TextCursor(start).next_token()))
               : std::string{};
}

} // namespace tactus::detail
