// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/vicinity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus
{

Vicinity::Vicinity(std::span<const PlacedSurface> surfaces, const Vec3& center_m, double reach_m,
                   bool is_query_center) noexcept
    : reach_m_(reach_m)
{
    for (const PlacedSurface& placed : surfaces)
    {
        const Vec3 local = to_model(*placed.pose, center_m);
        for (std::uint32_t i = 0; i < placed.surface->count; ++i)
        {
            const LocalTriangle& triangle = placed.surface->triangles[i];
            const double distance =
                placed.pose->scale *
                (is_query_center
                     ? placed.surface->distances_m[i]
                     : std::sqrt(closest_point_on_triangle(local, to_triangle(triangle.corners_m))
                                     .distance_sq));
            if (distance <= reach_m && !entries_.try_push_back({placed.pose, &triangle}))
            {
                reach_m_ = std::min(reach_m_, distance);
            }
        }
    }
}

NearestSurface Vicinity::nearest(const Vec3& point_m, const Vec3& fallback) const noexcept
{
    NearestSurface best{std::numeric_limits<double>::infinity(), fallback};
    const ObjectPose* pose = nullptr;
    Vec3 local = point_m;
    Vec3 foot = point_m;
    for (const Entry& entry : entries_)
    {
        if (pose == nullptr || entry.pose != pose)
        {
            pose = entry.pose;
            TACTUS_ASSERT(pose != nullptr);
            local = to_model(*pose, point_m);
        }
        const ClosestPoint closest =
            closest_point_on_triangle(local, to_triangle(entry.triangle->corners_m));
        const double distance = std::sqrt(closest.distance_sq) * pose->scale;
        if (distance < best.distance_m)
        {
            best.distance_m = distance;
            foot = to_world(*pose, closest.point);
        }
    }
    const Vec3 away = point_m - foot;
    const double length = away.norm();
    best.normal = length > 0.0 ? Vec3(away / length) : fallback;
    return best;
}

} // namespace tactus
