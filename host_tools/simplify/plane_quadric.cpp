// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/plane_quadric.hpp"

#include "host_tools/simplify/grid_point.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace tactus
{

PlaneQuadric::PlaneQuadric(const QuantisedMesh& mesh, const VertexRing& ring) noexcept
    : vertex_(grid_point(mesh, ring.vertex))
{
    Vec3 spoke = grid_point(mesh, ring.neighbours[0]) - vertex_;
    for (std::uint32_t i = 0; i < ring.face_count; ++i)
    {
        const Vec3 next_spoke = grid_point(mesh, ring.neighbours[i + 1]) - vertex_;
        const Vec3 normal = spoke.cross(next_spoke);
        const double double_area = normal.norm();
        if (double_area > 0)
        {
            planes_.push_back(normal * std::sqrt(0.5 / double_area));
        }
        spoke = next_spoke;
    }
}

double PlaneQuadric::at(const Vec3& point) const noexcept
{
    const Vec3 offset = point - vertex_;
    double sum = 0;
    for (const Vec3& plane : planes_)
    {
        const double distance = plane.dot(offset);
        sum += distance * distance;
    }
    return sum;
}

} // namespace tactus
