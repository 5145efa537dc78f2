// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/vicinity.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/infinity.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

double nearest_of(std::span<const PlacedSurface> surfaces) noexcept
{
    double nearest = kInfinity;
    for (const PlacedSurface& placed : surfaces)
    {
        for (std::uint32_t i = 0; i < placed.surface->count; ++i)
        {
            nearest = std::min(nearest, placed.surface->distances_m[i] * placed.pose->scale);
        }
    }
    return nearest;
}

/// No more than the distance from `place` to the triangle, and by a side of it less at most.
double least_distance(const LocalTriangle& triangle, const Vec3& place) noexcept
{
    const Vec3 corner = to_vec3(triangle.corners_m[0]);
    const double side_sq = std::max((to_vec3(triangle.corners_m[1]) - corner).squaredNorm(),
                                    (to_vec3(triangle.corners_m[2]) - corner).squaredNorm());
    return (place - corner).norm() - std::sqrt(side_sq);
}

} // namespace

Vicinity::Vicinity(std::span<const PlacedSurface> surfaces, const Vec3& anchor_m,
                   const Vec3& center_m, double reach_m) noexcept
    : surfaces_(surfaces), center_m_(center_m), reach_m_(reach_m)
{
    TACTUS_ASSERT(reach_m >= 0.0);
    const double moved_m = (center_m - anchor_m).norm();
    double nearest_m = -1.0;
    for (int i = 0; !try_gather(moved_m); ++i)
    {
        nearest_m = nearest_m < 0.0 ? nearest_of(surfaces) - moved_m : nearest_m;
        reach_m_ = i < kMaxGatherings ? 0.5 * (reach_m_ + nearest_m) : nearest_m;
        if (i > kMaxGatherings || !(reach_m_ > 0.0))
        {
            faces_.clear();
            reach_m_ = 0.0; // Nothing may move: there is no telling the faces apart.
            return;
        }
    }
}

/// False when there are more faces within reach_m_ than fit. The surfaces' distances are from a
/// place `moved_m` away.
bool Vicinity::try_gather(double moved_m) noexcept
{
    faces_.clear();
    for (std::uint32_t s = 0; s < surfaces_.size(); ++s)
    {
        TACTUS_ASSERT(surfaces_[s].surface != nullptr);
        TACTUS_ASSERT(surfaces_[s].pose != nullptr);
        const LocalSurface& surface = *surfaces_[s].surface;
        TACTUS_ASSERT(surface.count <= surface.triangles.size());
        TACTUS_ASSERT(surfaces_[s].pose->scale > 0.0);
        const double scale = surfaces_[s].pose->scale;
        const double reach = (reach_m_ + moved_m) / scale;
        const Vec3 center = to_model(*surfaces_[s].pose, center_m_);
        for (std::uint32_t i = 0; i < surface.count; ++i)
        {
            if (!(surface.distances_m[i] <= reach))
            {
                continue;
            }
            double distance_m = surface.distances_m[i] * scale - moved_m;
            if (moved_m > 0.0)
            {
                const LocalTriangle& triangle = surface.triangles[i];
                distance_m = std::max(distance_m, least_distance(triangle, center) * scale);
                if (distance_m > reach_m_)
                {
                    continue;
                }
            }
            if (!faces_.try_push_back(
                    {&surface.triangles[i], s, 0, Vec3(0.0, 0.0, 0.0), distance_m}))
            {
                return false;
            }
        }
    }
    return true;
}

double Vicinity::bound_of_surface(std::uint32_t surface, const Vec3& place) const noexcept
{
    double least = kInfinity;
    for (const NearFace& face : faces_)
    {
        if (face.surface == surface)
        {
            least = std::min(least, bound(face, place));
        }
    }
    return least;
}

void Vicinity::stand_at(const Vec3& place, const Vec3& fallback) noexcept
{
    place_ = place;
    fallback_ = fallback;
    ++stand_;
}

void Vicinity::look_at(NearFace& face) const noexcept
{
    if (face.stand == stand_)
    {
        return;
    }
    const ObjectPose& pose = *surfaces_[face.surface].pose;
    const ClosestPoint closest = closest_point_on_triangle(to_model(pose, center_m_ + place_),
                                                           to_triangle(face.triangle->corners_m));
    const double length = std::sqrt(closest.distance_sq);
    face.normal = length > 0.0 ? Vec3(pose.rotation * (closest.gap * (-1.0 / length))) : fallback_;
    face.offset_m = length * pose.scale - face.normal.dot(place_);
    face.stand = stand_;
}

bool Vicinity::is_within(std::uint32_t face, double distance_m) noexcept
{
    NearFace& near = faces_[face];
    if (bound(near, place_) > distance_m)
    {
        return false;
    }
    look_at(near);
    return bound(near, place_) <= distance_m;
}

HalfSpace<3> Vicinity::half_space(std::uint32_t face, double radius_m) noexcept
{
    NearFace& near = faces_[face];
    look_at(near);
    return {near.normal, radius_m - bound(near, place_)};
}

std::optional<std::uint32_t> Vicinity::find_entered(const Vec3& motion, double radius_m) noexcept
{
    const Vec3 place = place_ + motion;
    TACTUS_ASSERT(radius_m > 0.0);
    const double least = radius_m * (1.0 - kContactTolerance);
    double deepest = least;
    std::optional<std::uint32_t> entered;
    for (std::uint32_t i = 0; i < size(); ++i)
    {
        NearFace& face = faces_[i];
        if (bound(face, place) >= least)
        {
            continue;
        }
        look_at(face);
        const double seen = bound(face, place);
        if (seen < deepest)
        {
            deepest = seen;
            entered = i;
        }
    }
    return entered;
}

bool Vicinity::is_free(const Vec3& from, const Vec3& to, double radius_m) noexcept
{
    stand_at(0.5 * (from + to), fallback_);
    for (NearFace& face : faces_)
    {
        if (std::min(bound(face, from), bound(face, to)) < radius_m)
        {
            look_at(face);
            if (std::min(bound(face, from), bound(face, to)) < radius_m)
            {
                return false;
            }
        }
    }
    return true;
}

double Vicinity::free_share(const Vec3& motion, double radius_m) const noexcept
{
    const double least = radius_m * (1.0 - kContactTolerance);
    double share = 1.0;
    for (const NearFace& face : faces_)
    {
        const double here = bound(face, place_);
        const double there = bound(face, place_ + motion);
        if (there < least && there < here)
        {
            share = std::min(share, std::max(0.0, here - radius_m) / (here - there));
        }
    }
    return share;
}

} // namespace tactus
