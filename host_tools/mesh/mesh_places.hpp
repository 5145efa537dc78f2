// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/quantised_mesh.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/math/vec3.hpp"

#include <Eigen/Geometry>

#include <cstdint>

// Any thread: functions of their arguments alone.
namespace tactus
{

[[nodiscard]] inline Vec3 place_of(const TriangleMesh& mesh, std::uint32_t vertex)
{
    return Vec3(mesh.positions[vertex].data());
}

/// Box of the vertices that faces use; empty if there is no face.
[[nodiscard]] inline Eigen::AlignedBox3d box_of(const TriangleMesh& mesh)
{
    Eigen::AlignedBox3d box;
    for (const auto& face : mesh.faces)
    {
        for (const std::uint32_t vertex : face)
        {
            box.extend(place_of(mesh, vertex));
        }
    }
    return box;
}

/// A mesh vertex in quanta; exact, since a double holds every 32-bit integer.
[[nodiscard]] inline Vec3 grid_point(const QuantisedMesh& mesh, std::uint32_t vertex) noexcept
{
    const auto& p = mesh.positions[vertex];
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

/// Box of all vertices, in quanta.
[[nodiscard]] inline Eigen::AlignedBox3d box_of(const QuantisedMesh& mesh)
{
    Eigen::AlignedBox3d box;
    for (std::uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex)
    {
        box.extend(grid_point(mesh, vertex));
    }
    return box;
}

} // namespace tactus
