// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/proxy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus
{

namespace
{

/// Push-outs after one slide; each at least halves what is left on a smooth surface.
constexpr int kPushOuts = 4;
/// Below this share of the tool's radius a motion isn't worth a step: 0.1 mN at 500 N/m and 2 mm.
constexpr double kLeastStep = 1e-4;

} // namespace

ToolOutput Proxy::respond(const Vec3& goal_m, std::span<const PlacedSurface> surfaces,
                          double elapsed_s) noexcept
{
    anchor_ = position_;
    held_back_ = false;
    const double travel = free_travel(surfaces);
    const bool frozen = !(travel > 0.0);
    if (frozen)
    {
        held_back_ = true;
    }
    else
    {
        follow(goal_m, travel, surfaces);
    }
    ToolOutput output;
    output.proxy_m = position_;
    output.in_contact = in_contact_;
    output.frozen = frozen;
    frozen_s_ = frozen ? frozen_s_ + elapsed_s : 0.0;
    if (in_contact_)
    {
        output.force_n = held_back_ ? fading_force(goal_m) : force_towards(goal_m);
    }
    return output;
}

/// How far the proxy may move with the tool still inside what is proven; <= 0 is not at all.
double Proxy::free_travel(std::span<const PlacedSurface> surfaces) const noexcept
{
    double travel = std::numeric_limits<double>::infinity();
    for (const PlacedSurface& placed : surfaces)
    {
        const DistanceAnswer& answer = placed.surface->answer;
        const double known = std::max(answer.certified_radius_m, answer.lower_m);
        travel = std::min(travel, known * placed.pose->scale - spec_.radius_m);
    }
    return travel;
}

Proxy::Nearest Proxy::nearest(const Vec3& point,
                              std::span<const PlacedSurface> surfaces) const noexcept
{
    Nearest best{std::numeric_limits<double>::infinity(), normal_};
    for (const PlacedSurface& placed : surfaces)
    {
        const Vec3 local = to_model(*placed.pose, point);
        double least_sq = std::numeric_limits<double>::infinity();
        Vec3 foot = local;
        for (std::uint32_t i = 0; i < placed.surface->count; ++i)
        {
            const ClosestPoint closest = closest_point_on_triangle(
                local, to_triangle(placed.surface->triangles[i].corners_m));
            if (closest.distance_sq < least_sq)
            {
                least_sq = closest.distance_sq;
                foot = closest.point;
            }
        }
        const double distance = std::sqrt(least_sq) * placed.pose->scale;
        if (distance < best.distance)
        {
            const Vec3 away = point - to_world(*placed.pose, foot);
            const double length = away.norm();
            best = {distance, length > 0.0 ? Vec3(away / length) : normal_};
        }
    }
    return best;
}

void Proxy::follow(const Vec3& goal, double travel,
                   std::span<const PlacedSurface> surfaces) noexcept
{
    const double radius = spec_.radius_m;
    const double tolerance = kContactTolerance * radius;
    in_contact_ = false;
    for (std::uint32_t i = 0; i < kProxySteps; ++i)
    {
        const Vec3 way = goal - position_;
        const double length = way.norm();
        // Surfaces outside the certified ball are at least this far away.
        const double unseen = travel + radius - (position_ - anchor_).norm();
        const Nearest near = nearest(position_, surfaces);
        const double clearance = std::min(near.distance, unseen);
        const double inward = -way.dot(near.normal);
        const bool touches = near.distance <= radius + tolerance;
        if (length <= kLeastStep * radius)
        {
            in_contact_ = in_contact_ || (touches && inward > 0.0);
            return;
        }
        const double most = touches ? std::min(0.5 * radius, unseen - radius) : clearance - radius;
        if (touches && inward > 0.0)
        {
            in_contact_ = true;
            normal_ = near.normal;
        }
        const Vec3 wanted = touches && inward > 0.0 ? Vec3(way + inward * near.normal) : way;
        const double wanted_length = wanted.norm();
        if (wanted_length <= kLeastStep * radius)
        {
            return; // At rest on the surface.
        }
        if (most <= kLeastStep * radius)
        {
            held_back_ = true;
            return;
        }
        const Vec3 step = wanted * std::min(1.0, most / wanted_length);
        if (!touches)
        {
            position_ += step;
        }
        else if (!try_slide(step, clearance, goal, surfaces) &&
                 !try_slide(0.25 * step, clearance, goal, surfaces))
        {
            return; // A concave corner: no step along this constraint leads nearer to the goal.
        }
    }
}

/// One step along the surface, pushed out to the radius again. Taken only when it ends outside the
/// surface, nearer to the goal and within the ball that is known to be free.
bool Proxy::try_slide(const Vec3& step, double clearance, const Vec3& goal,
                      std::span<const PlacedSurface> surfaces) noexcept
{
    const double radius = spec_.radius_m;
    const double least = radius - kContactTolerance * radius;
    Vec3 candidate = position_ + step;
    Nearest near = nearest(candidate, surfaces);
    for (int i = 0; i < kPushOuts && near.distance < radius; ++i)
    {
        candidate += near.normal * (radius - near.distance);
        near = nearest(candidate, surfaces);
    }
    if (near.distance < least || (candidate - position_).norm() >= clearance ||
        (candidate - goal).squaredNorm() >= (position_ - goal).squaredNorm())
    {
        return false;
    }
    position_ = candidate;
    return true;
}

Vec3 Proxy::force_towards(const Vec3& goal) const noexcept
{
    return clamped(spec_.stiffness_n_per_m * (position_ - goal));
}

/// Along the last normal, never pulling, less with every moment without a certified surface.
Vec3 Proxy::fading_force(const Vec3& goal) const noexcept
{
    const double push = spec_.stiffness_n_per_m * (position_ - goal).dot(normal_);
    const double share = std::max(0.0, 1.0 - frozen_s_ / kFadeTime_s);
    return clamped(normal_ * (std::max(0.0, push) * share));
}

Vec3 Proxy::clamped(const Vec3& force) const noexcept
{
    const double norm = force.norm();
    return norm > spec_.force_max_n ? Vec3(force * (spec_.force_max_n / norm)) : force;
}

} // namespace tactus
