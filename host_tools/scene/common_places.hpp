// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/math/vec3.hpp"

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Any thread, except the haptic one: it allocates, and works on its own data alone.
namespace tactus
{

/// Common vertices of models that share one grid; they are equal except for the rounding of their
/// files. Without this class, two such vertices on different sides of a rounding boundary of the
/// grid would end up a step apart.
class CommonPlaces
{
public:
    explicit CommonPlaces(double step_m) : step_m_(step_m) {}

    /// Aligns vertices in the boxes. A vertex is moved if an earlier vertex is less than half a
    /// step away along each axis, and the grid would separate the two. Its new position is the grid
    /// position of the earlier vertex. `grid_place_m` and the boxes are in the mesh's frame.
    /// Returns the greatest distance that a vertex was moved. Linear in the vertices; those in a
    /// box are kept, at 80 B each.
    double settle(TriangleMesh& mesh, const Vec3& grid_place_m,
                  std::span<const Eigen::AlignedBox3d> boxes);

private:
    [[nodiscard]] std::size_t first_near(const Vec3& steps) const;

    double step_m_;
    std::vector<Vec3> vertices_; ///< Vertices, in steps from the grid's place.
    /// Indices into `vertices_`, by hash of the cell; a cell is one step wide.
    std::unordered_multimap<std::uint64_t, std::uint32_t> of_cell_;
};

} // namespace tactus
