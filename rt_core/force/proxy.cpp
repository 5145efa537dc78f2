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

/// How far beyond the tool's radius triangles are listed, as a share of the radius, and how many
/// lists one frame may make: together a slide of a third of the radius a frame.
constexpr double kWindow = 0.12;
constexpr int kVicinities = 3;
/// Push-outs after one slide; each at least halves what is left on a smooth surface.
constexpr int kPushOuts = 4;
/// Below this share of the tool's radius a motion isn't worth a step: 0.1 mN at 500 N/m and 2 mm.
constexpr double kLeastStep = 1e-4;

} // namespace

ToolOutput Proxy::respond(const Vec3& goal_m, std::span<const PlacedSurface> surfaces,
                          double elapsed_s) noexcept
{
    anchor_ = position_;
    const double travel = free_travel(surfaces);
    const bool frozen = !(travel > 0.0);
    held_back_ = frozen;
    if (!frozen)
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

/// First straight on as far as nothing is in the way, then step by step among the triangles in
/// reach; where those end, among those in reach of there.
void Proxy::follow(const Vec3& goal, double travel,
                   std::span<const PlacedSurface> surfaces) noexcept
{
    in_contact_ = false;
    const double clear = std::min(travel, clearance(surfaces) - spec_.radius_m);
    const Vec3 way = goal - position_;
    const double length = way.norm();
    if (clear > kContactTolerance * spec_.radius_m && length > 0.0)
    {
        position_ += way * std::min(1.0, clear / length);
    }
    std::uint32_t steps = kProxySteps;
    Motion motion = Motion::ran_out;
    for (int round = 0; round < kVicinities && motion == Motion::ran_out; ++round)
    {
        const double left = travel - (position_ - anchor_).norm();
        const double window = std::min(left, kWindow * spec_.radius_m);
        const Vicinity vicinity(surfaces, position_, spec_.radius_m + window, position_ == anchor_);
        motion = follow_within(vicinity, goal, left, steps);
    }
    held_back_ = motion == Motion::held_back;
}

/// To the nearest triangle from where the surfaces were queried.
double Proxy::clearance(std::span<const PlacedSurface> surfaces) noexcept
{
    double least = std::numeric_limits<double>::infinity();
    for (const PlacedSurface& placed : surfaces)
    {
        const auto& distances = placed.surface->distances_m;
        for (std::uint32_t i = 0; i < placed.surface->count; ++i)
        {
            least = std::min(least, distances[i] * placed.pose->scale);
        }
    }
    return least;
}

Proxy::Motion Proxy::follow_within(const Vicinity& vicinity, const Vec3& goal, double travel,
                                   std::uint32_t& steps) noexcept
{
    const double radius = spec_.radius_m;
    const double least_step = kLeastStep * radius;
    const Vec3 center = position_;
    for (; steps > 0; --steps)
    {
        const Vec3 way = goal - position_;
        const double moved = (position_ - center).norm();
        const NearestSurface near = vicinity.nearest(position_, normal_);
        const bool touches = near.distance_m <= radius + kContactTolerance * radius;
        const double inward = -way.dot(near.normal);
        const bool is_held = touches && inward > 0.0;
        if (is_held)
        {
            in_contact_ = true;
            normal_ = near.normal;
        }
        const Vec3 wanted = is_held ? Vec3(way + inward * near.normal) : way;
        const double wanted_length = wanted.norm();
        if (wanted_length <= least_step)
        {
            return Motion::at_rest;
        }
        // What is not in the vicinity, or not certified, is at least this far away.
        const double unlisted = vicinity.reach_m() - moved - radius;
        const double uncertified = travel - moved;
        const double open = touches ? 0.5 * radius : near.distance_m - radius;
        const double most = std::min({open, unlisted, uncertified});
        if (most <= least_step)
        {
            return uncertified <= least_step ? Motion::held_back : Motion::ran_out;
        }
        const Vec3 step = wanted * std::min(1.0, most / wanted_length);
        if (!touches)
        {
            position_ += step;
        }
        else if (!try_slide(step, near.distance_m, goal, vicinity) &&
                 !try_slide(0.25 * step, near.distance_m, goal, vicinity))
        {
            return Motion::at_rest; // A concave corner: this constraint leads no nearer.
        }
    }
    return Motion::out_of_steps;
}

/// One step along the surface, pushed out to the radius again. Taken only when it ends outside the
/// surface, nearer to the goal and within the ball that is known to be free.
bool Proxy::try_slide(const Vec3& step, double clearance, const Vec3& goal,
                      const Vicinity& vicinity) noexcept
{
    const double radius = spec_.radius_m;
    const double least = radius - kContactTolerance * radius;
    Vec3 candidate = position_ + step;
    NearestSurface near = vicinity.nearest(candidate, normal_);
    for (int i = 0; i < kPushOuts && near.distance_m < radius; ++i)
    {
        candidate += near.normal * (radius - near.distance_m);
        near = vicinity.nearest(candidate, normal_);
    }
    if (near.distance_m < least || (candidate - position_).norm() >= clearance ||
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
