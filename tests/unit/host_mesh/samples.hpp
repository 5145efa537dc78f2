// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

/// The same mesh in each format, written here independently of the library.
namespace tactus::test
{

template <typename T>
inline void append(std::string& bytes, T value, bool big_endian = false)
{
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), &value, sizeof(T));
    if (big_endian)
    {
        std::reverse(raw.begin(), raw.end());
    }
    bytes.append(raw.data(), raw.size());
}

inline std::string ply_header(const std::string& format, std::size_t vertices, std::size_t faces)
{
    return fmt::format("ply\nformat {} 1.0\ncomment by hand\nelement vertex {}\n"
                       "property double x\nproperty double y\nproperty double z\n"
                       "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                       format, vertices, faces);
}

inline std::string as_ascii_ply(const TriangleMesh& mesh)
{
    std::string text = ply_header("ascii", mesh.positions.size(), mesh.faces.size());
    for (const auto& p : mesh.positions)
    {
        text += fmt::format("{} {} {}\n", p[0], p[1], p[2]);
    }
    for (const auto& f : mesh.faces)
    {
        text += fmt::format("3 {} {} {}\n", f[0], f[1], f[2]);
    }
    return text;
}

inline std::string as_binary_ply(const TriangleMesh& mesh, bool big_endian)
{
    std::string bytes = ply_header(big_endian ? "binary_big_endian" : "binary_little_endian",
                                   mesh.positions.size(), mesh.faces.size());
    for (const auto& p : mesh.positions)
    {
        for (const double c : p)
        {
            append(bytes, c, big_endian);
        }
    }
    for (const auto& f : mesh.faces)
    {
        append(bytes, std::uint8_t{3});
        for (const std::uint32_t v : f)
        {
            append(bytes, v, big_endian);
        }
    }
    return bytes;
}

inline std::string as_obj(const TriangleMesh& mesh)
{
    std::string text = "# by hand\n";
    for (const auto& p : mesh.positions)
    {
        text += fmt::format("v {} {} {}\n", p[0], p[1], p[2]);
    }
    for (const auto& f : mesh.faces)
    {
        text += fmt::format("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
    }
    return text;
}

inline std::string as_off(const TriangleMesh& mesh)
{
    std::string text = fmt::format("OFF\n{} {} 0\n", mesh.positions.size(), mesh.faces.size());
    for (const auto& p : mesh.positions)
    {
        text += fmt::format("{} {} {}\n", p[0], p[1], p[2]);
    }
    for (const auto& f : mesh.faces)
    {
        text += fmt::format("3 {} {} {}\n", f[0], f[1], f[2]);
    }
    return text;
}

inline std::string as_ascii_stl(const TriangleMesh& mesh)
{
    std::string text = "solid by hand\n";
    for (const auto& f : mesh.faces)
    {
        text += "facet normal 0 0 0\n outer loop\n";
        for (const std::uint32_t v : f)
        {
            const auto& p = mesh.positions[v];
            text += fmt::format("  vertex {} {} {}\n", p[0], p[1], p[2]);
        }
        text += " endloop\nendfacet\n";
    }
    return text + "endsolid by hand\n";
}

inline std::string as_binary_stl(const TriangleMesh& mesh, std::string title)
{
    title.resize(80, ' ');
    append(title, static_cast<std::uint32_t>(mesh.faces.size()));
    for (const auto& f : mesh.faces)
    {
        title.append(12, '\0');
        for (const std::uint32_t v : f)
        {
            for (const double c : mesh.positions[v])
            {
                append(title, static_cast<float>(c));
            }
        }
        title.append(2, '\0');
    }
    return title;
}

struct Sample
{
    std::string name;
    std::string bytes;
};

/// Every format, with the extension at the end of the name.
inline std::vector<Sample> in_all_formats(const TriangleMesh& mesh)
{
    return {{"ascii.ply", as_ascii_ply(mesh)},
            {"little.ply", as_binary_ply(mesh, false)},
            {"big.ply", as_binary_ply(mesh, true)},
            {"text.obj", as_obj(mesh)},
            {"text.off", as_off(mesh)},
            {"ascii.stl", as_ascii_stl(mesh)},
            {"binary.stl", as_binary_stl(mesh, "any")},
            {"solid.stl", as_binary_stl(mesh, "solid x")}};
}

/// Positions of every face's corners, so that STL compares with indexed formats.
inline std::vector<std::array<std::array<double, 3>, 3>> corners_of(const TriangleMesh& mesh)
{
    std::vector<std::array<std::array<double, 3>, 3>> corners;
    for (const auto& f : mesh.faces)
    {
        corners.push_back({mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]]});
    }
    return corners;
}

} // namespace tactus::test
