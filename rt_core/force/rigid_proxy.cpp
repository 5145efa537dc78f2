// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/rigid_proxy.hpp"

#include "rt_core/force/angular_stiffness.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// Never more of the proven distance than this is gone, and of the radius half is kept: what dips
/// into it has room to come back.
constexpr double kMostOfDistance = 0.9;
constexpr double kKeptOfRadius = 0.5;
/// Planes this alike are one: a share of the arm. The one that holds back most is kept.
constexpr double kSamePlane = 1e-3;
/// A hold is kept until the tool has slid this share of its radius. What it bends a motion round an
/// edge by is half the square of it.
constexpr double kHoldSlide = 0.05;
/// Cosine between the normals of holds that are one.
constexpr double kSameDirection = 0.999;

Motion<6> to_motion(const Vec3& translation, const Vec3& rotation) noexcept
{
    Motion<6> motion;
    motion.head<3>() = translation;
    motion.tail<3>() = rotation;
    return motion;
}

/// How much of it is no longer than this.
double share_within(const Vec3& vector, double most) noexcept
{
    const double length = vector.norm();
    return length > most ? most / length : 1.0;
}

/// The core's ball and the radius.
double arm_of(const ToolSpec& spec) noexcept
{
    const double core_m = PlacedCore(spec.core, Similarity{}).radius();
    return core_m + std::max(spec.radius_m, kLeastSkin * core_m);
}

} // namespace

double angular_stiffness_nm_per_rad(const ToolSpec& spec) noexcept
{
    const bool turns = !spec.passes_through && !std::holds_alternative<PointCore>(spec.core);
    const double arm_m = turns ? arm_of(spec) : 0.0;
    return spec.stiffness_n_per_m * arm_m * arm_m;
}

RigidProxy::RigidProxy(const ToolSpec& spec, Planes& planes) noexcept
    : spec_(spec), arm_m_(arm_of(spec)), planes_(&planes)
{
    const PlacedCore core(spec.core, Similarity{});
    center_m_ = core.center();
    core_radius_m_ = core.radius();
    radius_m_ = std::max(spec.radius_m, kLeastSkin * core_radius_m_);
}

void RigidProxy::see(const ToolGoal& goal) noexcept
{
    if (!is_joined_)
    {
        place_ = {goal.rotation, goal.position_m, 1.0};
    }
}

void RigidProxy::forget(std::uint32_t object) noexcept
{
    std::size_t kept = 0;
    for (const Hold& hold : holds_)
    {
        if (hold.object != object)
        {
            holds_[kept++] = hold;
        }
    }
    while (holds_.size() > kept)
    {
        (void)holds_.pop_back();
    }
}

double RigidProxy::way_to_m(const ToolGoal& goal) const noexcept
{
    return length_of(way_to(goal));
}

/// No point of the core goes farther, over a way on which its centre goes straight while it turns
/// round one axis: chords are shorter than arcs.
double RigidProxy::length_of(const Motion<6>& motion) const noexcept
{
    const Vec3 turn = motion.tail<3>() / arm_m_;
    const Vec3 center = place_.rotation * center_m_;
    return motion.head<3>().norm() + turn.cross(center).norm() + turn.norm() * core_radius_m_;
}

Motion<6> RigidProxy::way_to(const ToolGoal& goal) const noexcept
{
    const Vec3 turn = rotation_vector(goal.rotation * place_.rotation.transpose());
    return to_motion(goal.position_m - place_.translation_m, arm_m_ * turn);
}

ToolOutput RigidProxy::respond(const ToolGoal& goal, std::span<const PlacedSurface> surfaces,
                               double clear_m) noexcept
{
    ToolOutput output;
    const Room room = find_room(surfaces, clear_m);
    const bool has_waited = frozen_s_ > 0.0;
    is_squeezed_ = false;
    is_crowded_ = false;
    is_joined_ = is_joined_ || room.is_clear;
    if (!is_joined_)
    {
        see(goal);
    }
    else if (room.free_m > 0.0)
    {
        frozen_s_ = 0.0;
        step(goal, surfaces, room.free_m, output);
    }
    else
    {
        frozen_s_ += goal.elapsed_s;
        freeze(goal, room.is_crossed, output);
    }
    output.stiffness_n_per_m = output.in_contact ? spec_.stiffness_n_per_m : 0.0;
    catch_up(has_waited, goal.elapsed_s, output);
    output.squeezed = is_squeezed_;
    output.crowded = is_crowded_;
    output.proxy_m = place_.translation_m;
    output.proxy_rotation = place_.rotation;
    return output;
}

RigidProxy::Room RigidProxy::find_room(std::span<const PlacedSurface> surfaces,
                                       double clear_m) const noexcept
{
    Room room{std::min(clear_m - radius_m_, kMostOfDistance * clear_m), clear_m > 0.0, false};
    for (const PlacedSurface& placed : surfaces)
    {
        const bool is_exact = placed.surface->answer.kind == AnswerKind::exact;
        const double lower_m = placed.lower_m;
        const double beyond_m = is_exact ? std::max(lower_m - kKeptOfRadius * radius_m_,
                                                    (1.0 - kKeptOfRadius) * lower_m)
                                         : lower_m - radius_m_;
        room.free_m = std::min({room.free_m, beyond_m, kMostOfDistance * lower_m});
        room.is_clear = room.is_clear && lower_m > 0.0;
        room.is_crossed = room.is_crossed || (is_exact && !(lower_m > 0.0));
    }
    return room;
}

void RigidProxy::step(const ToolGoal& goal, std::span<const PlacedSurface> surfaces, double free_m,
                      ToolOutput& output) noexcept
{
    const Motion<6> wanted = way_to(goal);
    gather(surfaces);
    const NearestMotion<6> nearest = find_motion(wanted);
    output.in_contact = !nearest.held_by.empty();
    add_force(nearest.motion - wanted, output);
    keep_holds(nearest, surfaces);
    const double length = length_of(nearest.motion);
    if (!output.in_contact && length <= free_m)
    {
        place_ = {goal.rotation, goal.position_m, 1.0}; // As the hand has it, to the last bit.
        return;
    }
    const double share = length > free_m ? free_m / length : 1.0;
    place_.translation_m += share * nearest.motion.head<3>();
    place_.rotation = turned_by(nearest.motion.tail<3>() * (share / arm_m_), place_.rotation);
}

/// Where the proxy is the last planes hold what pushes against them. A core that an object came
/// over has no way out that is known to be clear: when its force has faded it is given up.
void RigidProxy::freeze(const ToolGoal& goal, bool is_crossed, ToolOutput& output) noexcept
{
    planes_->spaces.clear();
    for (const Motion<6>& normal : last_normals_)
    {
        planes_->spaces.push_back({normal, 0.0});
    }
    const Motion<6> wanted = way_to(goal);
    const NearestMotion<6> nearest = nearest_motion<6>(planes_->spaces.view(), wanted);
    output.frozen = true;
    output.in_contact = !nearest.held_by.empty();
    add_force(nearest.motion - wanted, output);
    if (is_crossed && frozen_s_ >= kFadeTime_s)
    {
        is_joined_ = false;
        frozen_s_ = 0.0;
        holds_.clear();
        last_normals_.clear();
    }
}

void RigidProxy::catch_up(bool has_waited, double elapsed_s, ToolOutput& output) noexcept
{
    if (output.frozen || !output.in_contact)
    {
        force_.follow(output.force_n);
        torque_.follow(output.torque_nm);
        return;
    }
    const double rate_n = std::min(kCatchUp_n_per_s, kCatchUpShare_per_s * spec_.force_max_n);
    const double rate_nm = kCatchUpShare_per_s * spec_.torque_max_nm;
    output.force_n =
        force_.next({output.force_n, 0.0, spec_.force_max_n, rate_n, elapsed_s, has_waited});
    output.torque_nm =
        torque_.next({output.torque_nm, 0.0, spec_.torque_max_nm, rate_nm, elapsed_s, has_waited});
}

void RigidProxy::gather(std::span<const PlacedSurface> surfaces) noexcept
{
    planes_->spaces.clear();
    planes_->touches.clear();
    for (std::uint32_t i = 0; i < surfaces.size(); ++i)
    {
        const TouchReport& touches = *surfaces[i].touches;
        is_crowded_ = is_crowded_ || touches.is_truncated;
        for (const ContactSet* contacts : {&touches.nearest, &touches.corners})
        {
            for (const Contact& contact : *contacts)
            {
                add({i, contact.on_tool_m, contact.on_surface_m, contact.normal});
            }
        }
    }
    add_holds(surfaces);
}

/// When there is no room, what holds back least goes.
void RigidProxy::add(const Touch& touch) noexcept
{
    if (touch.normal == Vec3(0.0, 0.0, 0.0))
    {
        return; // Of a face without area: those round it hold.
    }
    const Vec3 lever = (touch.on_tool_m - place_.translation_m) / arm_m_;
    const HalfSpace<6> space{to_motion(touch.normal, lever.cross(touch.normal)),
                             radius_m_ - touch.normal.dot(touch.on_tool_m - touch.on_surface_m)};
    std::size_t least = 0;
    for (std::size_t i = 0; i < planes_->spaces.size(); ++i)
    {
        const HalfSpace<6>& other = planes_->spaces[i];
        if ((other.normal - space.normal).norm() < kSamePlane)
        {
            replace(i, space, touch);
            return;
        }
        least = other.offset < planes_->spaces[least].offset ? i : least;
    }
    if (!planes_->spaces.full())
    {
        planes_->spaces.push_back(space);
        planes_->touches.push_back(touch);
        return;
    }
    is_crowded_ = true;
    replace(least, space, touch);
}

void RigidProxy::replace(std::size_t plane, const HalfSpace<6>& space, const Touch& touch) noexcept
{
    if (space.offset > planes_->spaces[plane].offset)
    {
        planes_->spaces[plane] = space;
        planes_->touches[plane] = touch;
    }
}

/// Adds what held before, and forgets where the tool is no longer.
void RigidProxy::add_holds(std::span<const PlacedSurface> surfaces) noexcept
{
    std::size_t kept = 0;
    for (const Hold& hold : holds_)
    {
        const auto placed = std::ranges::find(surfaces, hold.object, &PlacedSurface::object);
        if (placed == surfaces.end())
        {
            continue;
        }
        const ObjectPose& pose = *placed->pose;
        const Touch touch{static_cast<std::uint32_t>(placed - surfaces.begin()),
                          place_.translation_m + place_.rotation * hold.on_tool_m,
                          to_world(pose, hold.on_surface_m), pose.rotation * hold.normal};
        const Vec3 gap = touch.on_tool_m - touch.on_surface_m;
        const double height = touch.normal.dot(gap);
        const double slid = (gap - height * touch.normal).norm();
        if (slid > kHoldSlide * radius_m_ || height > 2.0 * radius_m_)
        {
            continue;
        }
        add(touch);
        holds_[kept++] = hold;
    }
    while (holds_.size() > kept)
    {
        (void)holds_.pop_back();
    }
}

/// A gap that is too narrow for the tool holds it where it is.
NearestMotion<6> RigidProxy::find_motion(const Motion<6>& wanted) noexcept
{
    NearestMotion<6> nearest = nearest_motion<6>(planes_->spaces.view(), wanted);
    if (nearest.is_feasible)
    {
        return nearest;
    }
    is_squeezed_ = true;
    for (HalfSpace<6>& space : planes_->spaces)
    {
        space.offset = std::min(space.offset, 0.0);
    }
    return nearest_motion<6>(planes_->spaces.view(), wanted);
}

void RigidProxy::keep_holds(const NearestMotion<6>& nearest,
                            std::span<const PlacedSurface> surfaces) noexcept
{
    last_normals_.clear();
    for (const std::uint32_t plane : nearest.held_by)
    {
        last_normals_.push_back(planes_->spaces[plane].normal);
        const Touch& touch = planes_->touches[plane];
        const ObjectPose& pose = *surfaces[touch.surface].pose;
        keep({surfaces[touch.surface].object,
              place_.rotation.transpose() * (touch.on_tool_m - place_.translation_m),
              to_model(pose, touch.on_surface_m), pose.rotation.transpose() * touch.normal});
    }
}

/// In place of one that is all but the same; else the oldest goes when there is no room.
void RigidProxy::keep(const Hold& hold) noexcept
{
    const auto is_same = [&hold, this](const Hold& other)
    {
        return other.object == hold.object && hold.normal.dot(other.normal) > kSameDirection &&
               (hold.on_tool_m - other.on_tool_m).norm() < kHoldSlide * radius_m_;
    };
    auto* old = std::ranges::find_if(holds_, is_same);
    if (old == holds_.end() && !holds_.full())
    {
        holds_.push_back(hold);
        return;
    }
    is_crowded_ = is_crowded_ || old == holds_.end();
    old = old == holds_.end() ? holds_.begin() : old;
    std::move(old + 1, holds_.end(), old);
    holds_[holds_.size() - 1] = hold;
}

void RigidProxy::add_force(const Motion<6>& held_back, ToolOutput& output) const noexcept
{
    const Vec3 force_n = spec_.stiffness_n_per_m * held_back.head<3>();
    const Vec3 torque_nm = spec_.stiffness_n_per_m * arm_m_ * held_back.tail<3>();
    const double most_nm = spec_.torque_max_nm;
    double share = share_within(force_n, spec_.force_max_n);
    share = most_nm > 0.0 ? std::min(share, share_within(torque_nm, most_nm)) : share;
    output.force_n = share * force_n;
    output.torque_nm = most_nm > 0.0 ? Vec3(share * torque_nm) : Vec3(0.0, 0.0, 0.0);
}

} // namespace tactus
