// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/math/vec3.hpp"

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

// Any thread, but not the haptic one: it allocates, and works on its own data alone.
namespace tactus
{

/// The vertices that models on one grid have in common but for a rounding of their files. Where the
/// middle between two places of the grid lies between such vertices, they would be a step apart.
class CommonPlaces
{
public:
    explicit CommonPlaces(double step_m) : step_m_(step_m) {}

    /// Looks at vertices which lie in one of the boxes. One that is less than half a step, along
    /// each axis, from a vertex looked at before, and would be rounded apart from it, is put on
    /// that one's place of the grid. `grid_place_m` and the boxes are in the mesh's frame. Returns
    /// how far a vertex was moved, at most. Linear in the vertices; those in a box are kept, at 80
    /// B each.
    double settle(TriangleMesh& mesh, const Vec3& grid_place_m,
                  std::span<const Eigen::AlignedBox3d> boxes);

private:
    [[nodiscard]] std::size_t first_near(const Vec3& steps) const;

    double step_m_;
    std::vector<Vec3> vertices_; ///< In steps from the grid's place.
    std::unordered_multimap<std::uint64_t, std::uint32_t> of_cell_; ///< Keys: cells a step wide.
};

} // namespace tactus
