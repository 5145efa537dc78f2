// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/boundary_quadrics.hpp"

#include "host_tools/mesh/mesh_places.hpp"

#include <Eigen/Geometry>

#include <algorithm>

namespace tactus
{

namespace
{

/// Weight relative to the faces' quadric; both are length^4. Measured: 10 keeps the bunny's holes
/// open.
constexpr double kBoundaryWeight = 10;

} // namespace

BoundaryQuadrics::BoundaryQuadrics(const QuantisedMesh& mesh, const CollapseMesh& original)
    : origin_(box_of(mesh).center())
{
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    {
        for (std::uint32_t corner = 0; corner < 3; ++corner)
        {
            if (original.neighbour(f, corner) != Collapse::kNoFace)
            {
                continue;
            }
            const auto& corners = mesh.faces[f];
            const std::uint32_t from = corners[corner];
            const std::uint32_t to = corners[(corner + 1) % 3];
            const Vec3 start = grid_point(mesh, from) - origin_;
            const Vec3 edge = grid_point(mesh, to) - origin_ - start;
            const Vec3 apex = grid_point(mesh, corners[(corner + 2) % 3]) - origin_;
            const Vec3 upright = edge.cross(edge.cross(apex - start)).normalized();
            const double offset = -upright.dot(start);
            const double weight = kBoundaryWeight * edge.squaredNorm();
            const std::array<double, 4> p{upright.x(), upright.y(), upright.z(), offset};
            Quadric plane{};
            std::size_t at = 0;
            for (std::size_t row = 0; row < 4; ++row)
            {
                for (std::size_t column = row; column < 4; ++column)
                {
                    plane[at++] = weight * p[row] * p[column];
                }
            }
            slot_plus_one_.resize(mesh.positions.size(), 0);
            add_plane(from, plane);
            add_plane(to, plane);
        }
    }
}

void BoundaryQuadrics::add_plane(std::uint32_t vertex, const Quadric& plane)
{
    if (slot_plus_one_[vertex] == 0)
    {
        quadrics_.push_back({});
        slot_plus_one_[vertex] = static_cast<std::uint32_t>(quadrics_.size());
    }
    Quadric& sum = quadrics_[slot_plus_one_[vertex] - 1];
    for (std::size_t i = 0; i < sum.size(); ++i)
    {
        sum[i] += plane[i];
    }
}

double BoundaryQuadrics::at(std::uint32_t vertex, const Vec3& point) const noexcept
{
    if (slot_plus_one_.empty() || slot_plus_one_[vertex] == 0)
    {
        return 0;
    }
    const Quadric& q = quadrics_[slot_plus_one_[vertex] - 1];
    const Vec3 p = point - origin_;
    const double squares = q[0] * p.x() * p.x() + q[4] * p.y() * p.y() + q[7] * p.z() * p.z();
    const double mixed = q[1] * p.x() * p.y() + q[2] * p.x() * p.z() + q[5] * p.y() * p.z();
    const double linear = q[3] * p.x() + q[6] * p.y() + q[8] * p.z();
    return std::max(0.0, squares + 2 * (mixed + linear) + q[9]);
}

void BoundaryQuadrics::collapse(std::uint32_t vertex, std::uint32_t parent) noexcept
{
    if (slot_plus_one_.empty() || slot_plus_one_[vertex] == 0)
    {
        return;
    }
    // A border vertex moves along its border only, so the parent has a quadric as well.
    TACTUS_ASSERT(slot_plus_one_[parent] != 0);
    const Quadric moved = quadrics_[slot_plus_one_[vertex] - 1];
    add_plane(parent, moved);
}

void BoundaryQuadrics::replace(std::uint32_t vertex, std::uint32_t parent) noexcept
{
    if (!slot_plus_one_.empty())
    {
        slot_plus_one_[parent] = slot_plus_one_[vertex];
    }
}

} // namespace tactus
