// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/collapse_mesh.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "rt_core/math/vec3.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tactus
{

/// Keeps borders where they are: each border edge puts a plane through itself, upright on its face,
/// and a border vertex pays for leaving the planes it has gathered. Unlike the faces' quadric this
/// one accumulates, since a removed border edge leaves no other trace; without it holes close up.
/// Only border vertices take memory.
class BoundaryQuadrics
{
public:
    BoundaryQuadrics(const QuantisedMesh& mesh, const CollapseMesh& original);

    /// Cost of moving the vertex to `point`, in quanta^4; 0 for a vertex inside.
    [[nodiscard]] double at(std::uint32_t vertex, const Vec3& point) const noexcept;

    /// The parent takes over the planes of the vertex that moved onto it.
    void collapse(std::uint32_t vertex, std::uint32_t parent) noexcept;

    /// The parent gets the vertex's planes for its own, as in an Absorption.
    void replace(std::uint32_t vertex, std::uint32_t parent) noexcept;

    /// A hole has closed at the vertex: it is inside now, and free to move anywhere.
    void release(std::uint32_t vertex) noexcept { slot_plus_one_[vertex] = 0; }

private:
    /// Upper triangle of the symmetric 4x4 matrix sum of w p p^T, p = (normal, offset).
    using Quadric = std::array<double, 10>;

    void add_plane(std::uint32_t vertex, const Quadric& plane);

    Vec3 origin_; ///< Near the mesh's middle, so that less of the matrix cancels.
    std::vector<std::uint32_t> slot_plus_one_; ///< Of each vertex; 0 inside, empty without borders.
    std::vector<Quadric> quadrics_;
};

} // namespace tactus
