// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/prepare.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "tests/shared/manifold.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "transport/base/refusal.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::test
{

using Face = std::array<std::uint32_t, 3>;
using Point = std::array<double, 3>;

inline Result<MeshFile, Refusal> read_bytes(const std::string& name, std::string_view bytes)
{
    const TemporaryFolder directory;
    return read_mesh_file(directory.write(name, bytes));
}

/// Text of the error; fails if there is none or it is not one line.
inline std::string refusal(const Result<MeshFile, Refusal>& result)
{
    if (result)
    {
        ADD_FAILURE() << "was accepted";
        return {};
    }
    EXPECT_EQ(result.error().text.find('\n'), std::string::npos) << result.error().text;
    return result.error().text;
}

/// Tetrahedron whose apex needs every digit of a double.
inline TriangleMesh tetrahedron()
{
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1234567890123456, 0.25, 1}},
            {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

/// Manifold test independent of the library; each vertex must have a face.
inline bool is_manifold_with_borders(const std::vector<Face>& faces, std::size_t vertices)
{
    std::set<std::uint32_t> used;
    for (const Face& face : faces)
    {
        used.insert(face.begin(), face.end());
    }
    return used.size() == vertices && (used.empty() || *used.rbegin() < vertices) &&
           manifold_fault(faces).empty();
}

inline bool is_manifold_with_borders(const QuantisedMesh& mesh)
{
    return is_manifold_with_borders(mesh.faces, mesh.positions.size());
}

/// Number of edges with a face on one side only.
template <typename Faces>
inline std::size_t border_edges(const Faces& faces)
{
    std::set<std::pair<std::uint32_t, std::uint32_t>> directed;
    for (const Face& f : faces)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            directed.insert({f[k], f[(k + 1) % 3]});
        }
    }
    std::size_t count = 0;
    for (const auto& [a, b] : directed)
    {
        count += directed.count({b, a}) == 0 ? 1U : 0U;
    }
    return count;
}

/// Vertices - edges + faces.
template <typename Faces>
inline std::int64_t euler_characteristic(const Faces& faces, std::size_t vertices)
{
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Face& f : faces)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            edges.insert(std::minmax(f[k], f[(k + 1) % 3]));
        }
    }
    return static_cast<std::int64_t>(vertices) - static_cast<std::int64_t>(edges.size()) +
           static_cast<std::int64_t>(faces.size());
}

/// Signed volume; positive if a closed mesh's faces are counter-clockwise from outside.
inline double signed_volume(const TriangleMesh& mesh)
{
    double six_volumes = 0.0;
    for (const Face& f : mesh.faces)
    {
        const Point& a = mesh.positions[f[0]];
        const Point& b = mesh.positions[f[1]];
        const Point& c = mesh.positions[f[2]];
        six_volumes += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                       a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return six_volumes / 6.0;
}

/// Meshes side by side in one.
inline TriangleMesh joined(std::initializer_list<TriangleMesh> parts)
{
    TriangleMesh all;
    for (const TriangleMesh& part : parts)
    {
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
        for (const Face& f : part.faces)
        {
            all.faces.push_back({first + f[0], first + f[1], first + f[2]});
        }
    }
    return all;
}

} // namespace tactus::test
