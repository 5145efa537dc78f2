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

/// Costs that keep borders in place. Each border edge defines a plane through itself, perpendicular
/// to its face, and the cost of a border vertex grows with its distance to its collected planes.
/// Unlike PlaneQuadric, these costs accumulate, since a removed border edge leaves no other trace.
/// Without them holes close. Only border vertices take memory.
class BoundaryQuadrics
{
public:
    BoundaryQuadrics(const QuantisedMesh& mesh, const CollapseMesh& original);

    /// Cost of moving the vertex to `point`, in quanta^4; 0 for an inner vertex.
    [[nodiscard]] double at(std::uint32_t vertex, const Vec3& point) const noexcept;

    /// Adds the planes of a vertex to the parent that it moved onto.
    void collapse(std::uint32_t vertex, std::uint32_t parent) noexcept;

    /// Replaces the parent's planes by the vertex's, as in an Absorption.
    void replace(std::uint32_t vertex, std::uint32_t parent) noexcept;

    /// Removes the planes of a vertex that became an inner vertex when its hole closed.
    void release(std::uint32_t vertex) noexcept { slot_plus_one_[vertex] = 0; }

private:
    /// Upper triangle of the symmetric 4x4 matrix sum of w p p^T, p = (normal, offset).
    using Quadric = std::array<double, 10>;

    void add_plane(std::uint32_t vertex, const Quadric& plane);

    Vec3 origin_; ///< Origin of the quadrics, near the mesh's middle to reduce cancellation.
    /// Index into `quadrics_`, plus one, by vertex; 0 for inner vertices; empty if the mesh has no
    /// border.
    std::vector<std::uint32_t> slot_plus_one_;
    std::vector<Quadric> quadrics_;
};

} // namespace tactus
