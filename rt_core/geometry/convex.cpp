// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/convex.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/safe_scale.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// Factor above the roundings of a distance between two points.
constexpr double kRadiusRoundedUp = 1.0 + 0x1p-50;

Vec3 mean_of(std::span<const Vec3> points) noexcept
{
    TACTUS_ASSERT(!points.empty());
    const double share = 1.0 / static_cast<double>(points.size());
    Vec3 mean(0.0, 0.0, 0.0);
    for (const Vec3& point : points)
    {
        mean += share * point;
    }
    return mean;
}

/// Largest distance of the points from a centre, rounded up.
double radius_round(const Vec3& center, std::span<const Vec3> points) noexcept
{
    double largest = 0.0;
    for (const Vec3& point : points)
    {
        const Vec3 way = point - center;
        largest = std::max(largest, largest_coordinate({&way, 1}));
    }
    const double scale = safe_scale(largest);
    double farthest_sq = 0.0;
    for (const Vec3& point : points)
    {
        farthest_sq = std::max(farthest_sq, ((point - center) * scale).squaredNorm());
    }
    return std::sqrt(farthest_sq) / scale * kRadiusRoundedUp;
}

} // namespace

Result<Hull, HullError> Hull::create(std::span<const Vec3> vertices) noexcept
{
    if (vertices.empty())
    {
        return HullError::no_vertex;
    }
    if (vertices.size() > kMaxHullVertices)
    {
        return HullError::too_many_vertices;
    }
    if (!std::ranges::all_of(
            vertices,
            [](const Vec3& vertex) noexcept {
                return vertex.allFinite() && largest_coordinate({&vertex, 1}) <= kCoordinateRange;
            }))
    {
        return HullError::vertex_not_finite;
    }
    const Vec3 center = mean_of(vertices);
    return Hull(vertices, center, radius_round(center, vertices));
}

Vec3 Hull::support(const void* hull, const Vec3& direction) noexcept
{
    const auto& self = *static_cast<const Hull*>(hull);
    std::size_t farthest = 0;
    double reach = direction.dot(self.vertices_[0] - self.center_);
    for (std::size_t i = 1; i < self.vertices_.size(); ++i)
    {
        const double reach_of_this = direction.dot(self.vertices_[i] - self.center_);
        farthest = reach_of_this > reach ? i : farthest;
        reach = reach_of_this > reach ? reach_of_this : reach;
    }
    return self.vertices_[farthest] - self.center_;
}

} // namespace tactus
