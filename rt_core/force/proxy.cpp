// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/proxy.hpp"

#include "rt_core/math/infinity.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// Over a curved surface a press turns into a way along it: this share of it within a frame.
constexpr double kDipShare = 0.1;
/// A proxy on its way along a surface feels what is this share of the radius below it.
constexpr double kNearlyTouching = 0.1;

/// The planes of one step, and whose they are.
struct StepPlanes
{
    StaticVector<HalfSpace<3>, kMaxHalfSpaces> planes;
    StaticVector<std::uint32_t, kMaxHalfSpaces> faces;

    [[nodiscard]] bool has(std::uint32_t face) const noexcept
    {
        return std::ranges::find(faces.view(), face) != faces.view().end();
    }
    void add(std::uint32_t face, const HalfSpace<3>& plane) noexcept
    {
        faces.push_back(face);
        planes.push_back(plane);
    }
    /// Only those that hold.
    void compact(const NearestMotion<3>& found) noexcept
    {
        const StepPlanes before = *this;
        faces.clear();
        planes.clear();
        for (const std::uint32_t i : found.held_by)
        {
            add(before.faces[i], before.planes[i]);
        }
    }
    /// The shortest motion out of objects that moved into the tool by more than `least`.
    [[nodiscard]] Vec3 way_out(double least) const noexcept
    {
        const bool is_inside = std::ranges::any_of(planes.view(), [least](const HalfSpace<3>& plane)
                                                   { return plane.offset > least; });
        return is_inside ? nearest_motion<3>(planes.view(), Vec3(0.0, 0.0, 0.0)).motion
                         : Vec3(0.0, 0.0, 0.0);
    }
};

/// The motion nearest to `wanted` that enters no triangle. `step` holds its planes then.
NearestMotion<3> nearest_free_motion(Vicinity& near, const Vec3& wanted, double radius,
                                     StepPlanes& step) noexcept
{
    NearestMotion<3> found = nearest_motion<3>(step.planes.view(), wanted);
    for (std::uint32_t round = 0; round < kStepRounds && found.is_feasible; ++round)
    {
        const std::optional<std::uint32_t> entered = near.find_entered(found.motion, radius);
        if (!entered || step.has(*entered))
        {
            return found;
        }
        if (step.planes.full())
        {
            step.compact(found);
        }
        step.add(*entered, near.half_space(*entered, radius));
        found = nearest_motion<3>(step.planes.view(), wanted);
    }
    if (found.is_feasible)
    {
        found.motion *= near.free_share(found.motion, radius);
    }
    return found;
}

/// How far round the tool's centre all of the surface is known, in the world.
double known(const PlacedSurface& placed) noexcept
{
    const DistanceAnswer& answer = placed.surface->answer;
    return std::max(answer.certified_radius_m, answer.lower_m) * placed.pose->scale;
}

} // namespace

Proxy::Proxy(ToolSpec spec) noexcept : spec_(std::move(spec)), radius_(spec_.radius_m) {}

ToolOutput Proxy::respond(const ToolGoal& goal, std::span<const PlacedSurface> surfaces,
                          double clear_m) noexcept
{
    anchor_ = position_;
    radius_ = find_radius(surfaces);
    is_crowded_ = false;
    path_.clear();
    path_.push_back(position_);
    const double travel = free_travel(surfaces, clear_m);
    const bool frozen = !(travel > 0.0);
    Motion motion = Motion::held_back;
    if (frozen)
    {
        keep_clearances(surfaces, nullptr);
    }
    else
    {
        motion = follow(goal.position_m, travel, surfaces);
    }
    ToolOutput output;
    output.proxy_m = position_;
    output.proxy_rotation = goal.rotation;
    output.in_contact = in_contact_;
    output.frozen = frozen;
    output.squeezed = motion == Motion::squeezed || was_overrun_;
    output.crowded = is_crowded_;
    output.held_back = motion == Motion::held_back && !frozen && is_short_of(surfaces, travel);
    output.under_way = !frozen && motion != Motion::at_rest && motion != Motion::squeezed;
    output.stiffness_n_per_m = in_contact_ ? hold_.stiffness / hold_.depth_m : 0.0;
    const bool is_held = frozen || output.squeezed;
    if (in_contact_ && !is_held)
    {
        output.force_n = caught_up(goal);
    }
    else
    {
        output.force_n = in_contact_ ? held_force(goal.position_m) : Vec3(0.0, 0.0, 0.0);
        catch_up_.follow(output.force_n);
    }
    waits_ = is_held || output.held_back;
    return output;
}

void Proxy::see(const ToolGoal& goal) noexcept
{
    rotation_ = goal.rotation;
    if (goal.change == GoalChange::first)
    {
        position_ = goal.position_m;
    }
}

double Proxy::way_to_m(const ToolGoal& goal) const noexcept
{
    const Vec3 way = goal.position_m - position_;
    const double inward = -way.dot(normal_);
    if (!in_contact_ || inward <= 0.0)
    {
        return way.norm();
    }
    return (way + inward * normal_).norm() + kDipShare * inward;
}

/// A point's is a share of the coarsest model's quantum.
double Proxy::find_radius(std::span<const PlacedSurface> surfaces) const noexcept
{
    double skin = 0.0;
    for (const PlacedSurface& placed : surfaces)
    {
        skin = std::max(skin, kPointSkin * placed.quantum_m * placed.pose->scale);
    }
    return std::max(spec_.radius_m, skin);
}

/// How far the proxy may move with the tool still inside what is proven; <= 0 is not at all.
double Proxy::free_travel(std::span<const PlacedSurface> surfaces, double clear_m) const noexcept
{
    double travel = clear_m - radius_;
    for (const PlacedSurface& placed : surfaces)
    {
        travel = std::min(travel, known(placed) - radius_);
    }
    return travel;
}

/// Whether less is known than was asked for where the proxy's way ends.
bool Proxy::is_short_of(std::span<const PlacedSurface> surfaces, double travel) const noexcept
{
    return std::ranges::any_of(surfaces,
                               [&](const PlacedSurface& placed)
                               {
                                   const double known_m = known(placed);
                                   return known_m <= travel + radius_ &&
                                          known_m < placed.reach_m * (1.0 - kContactTolerance);
                               });
}

/// First straight on as far as nothing is in the way, then among the triangles in reach.
Proxy::Motion Proxy::follow(const Vec3& goal, double travel,
                            std::span<const PlacedSurface> surfaces) noexcept
{
    in_contact_ = false;
    has_slid_ = false;
    held_by_.clear();
    double clear = travel;
    for (const PlacedSurface& placed : surfaces)
    {
        clear = std::min(clear, placed.surface->answer.lower_m * placed.pose->scale - radius_);
    }
    go_straight_on(goal, clear);
    Vicinity near(surfaces, anchor_, radius_ + travel);
    const Motion motion = follow_among(near, surfaces, goal, travel);
    if (motion != Motion::at_rest && motion != Motion::squeezed)
    {
        near.stand_at(position_ - anchor_, normal_);
        hold_ = hold_at(near, surfaces, goal - position_, kNearlyTouching * radius_);
    }
    in_contact_ = hold_.touches;
    slides_ = has_slid_ && in_contact_;
    keep_clearances(surfaces, &near);
    return motion;
}

void Proxy::go_straight_on(const Vec3& goal, double clear) noexcept
{
    const Vec3 way = goal - position_;
    const double length = way.norm();
    if (clear > kLeastStep * radius_ && length > 0.0)
    {
        position_ += way * std::min(1.0, clear / length);
        path_.push_back(position_);
    }
}

Proxy::Motion Proxy::follow_among(Vicinity& near, std::span<const PlacedSurface> surfaces,
                                  const Vec3& goal, double travel) noexcept
{
    const double least_step = kLeastStep * radius_;
    for (std::uint32_t steps = 1;; ++steps)
    {
        near.stand_at(position_ - anchor_, normal_);
        hold_ = hold_at(near, surfaces, goal - position_, kTouchShare * radius_);
        const double length = hold_.motion.norm();
        if (hold_.is_squeezed)
        {
            return Motion::squeezed;
        }
        if (length <= (hold_.static_m > 0.0 ? kSlipShare * radius_ : least_step))
        {
            return Motion::at_rest;
        }
        if (steps == kProxySteps)
        {
            return Motion::out_of_steps;
        }
        // What is not among them, or not certified, is at least this far away.
        const double moved = (position_ - anchor_).norm();
        const double room = std::min(near.reach_m() - radius_, travel) - moved;
        if (room <= least_step)
        {
            return travel - moved <= least_step ? Motion::held_back : Motion::ran_out;
        }
        position_ += hold_.motion * std::min(1.0, room / length);
        path_.push_back(position_);
    }
}

Proxy::Hold Proxy::hold_at(Vicinity& near, std::span<const PlacedSurface> surfaces,
                           const Vec3& wanted, double gap_m) noexcept
{
    std::array<std::uint32_t, kMaxHalfSpaces> faces; // NOLINT(*-member-init): it is written first.
    const std::size_t found_faces = near.list_within(radius_ + gap_m, faces);
    is_crowded_ = is_crowded_ || found_faces > faces.size();
    StepPlanes touching;
    for (const std::uint32_t face : std::span(faces).first(std::min(found_faces, faces.size())))
    {
        touching.add(face, near.half_space(face, radius_));
    }
    StepPlanes step = touching;
    for (const std::uint32_t face : held_by_)
    {
        if (!step.planes.full() && !step.has(face))
        {
            step.add(face, near.half_space(face, radius_));
        }
    }
    const std::size_t asked = step.planes.size();
    const NearestMotion<3> found = nearest_free_motion(near, wanted, radius_, step);
    held_by_.clear();
    for (const std::uint32_t plane : found.held_by)
    {
        held_by_.push_back(step.faces[plane]);
    }
    Hold hold;
    hold.motion = found.motion;
    hold.is_squeezed = !found.is_feasible;
    const bool is_same = asked == touching.planes.size() && asked == step.planes.size();
    const NearestMotion<3> held =
        is_same ? found : nearest_motion<3>(touching.planes.view(), wanted);
    for (std::size_t i = 0; i < held.held_by.size(); ++i)
    {
        const std::uint32_t plane = held.held_by[i];
        press(hold, surfaces[near.surface_of(touching.faces[plane])],
              held.reactions[i] * touching.planes[plane].normal);
    }
    if (hold.touches)
    {
        normal_ = hold.push_n.normalized();
        hold.slip = held.motion - touching.way_out(kContactTolerance * radius_);
        const Vec3 kept = rub(hold, hold.slip);
        hold.slip -= kept;
        if (hold.static_m > 0.0)
        {
            hold.motion = nearest_free_motion(near, wanted - kept, radius_, step).motion;
        }
        return hold;
    }
    if (std::ranges::any_of(surfaces, [](const PlacedSurface& placed)
                            { return placed.material->static_friction > 0.0; }))
    {
        hold.motion = go_to_contact(near, wanted, hold.motion);
    }
    return hold;
}

/// Adds one plane that touches; `depth` is how far the goal is behind it, along its normal.
void Proxy::press(Hold& hold, const PlacedSurface& placed, const Vec3& depth) const noexcept
{
    const Material& material = *placed.material;
    const double length = depth.norm();
    const double stiffness = std::min(spec_.stiffness_n_per_m, material.stiffness_n_per_m);
    hold.object = length >= hold.deepest_m ? placed.object : hold.object;
    hold.deepest_m = std::max(hold.deepest_m, length);
    hold.touches = hold.touches || length > 0.0;
    hold.push_n += stiffness * depth;
    hold.depth_m += length;
    hold.stiffness += stiffness * length;
    hold.static_m += material.static_friction * length;
    hold.dynamic_m += material.dynamic_friction * length;
    hold.damping += material.damping_n_s_per_m * length;
    hold.velocity += placed.memory->velocity_m_per_s * length;
}

/// Friction begins where the tool touches, so it goes there straight: to where the first of the
/// faces in the way is, each looked at from ever nearer.
Vec3 Proxy::go_to_contact(Vicinity& near, const Vec3& wanted, const Vec3& motion) const noexcept
{
    StaticVector<std::uint32_t, kStepRounds> passed;
    double share = 1.0;
    while (const auto entered = near.find_entered(wanted * share, radius_, passed.view()))
    {
        if (!passed.try_push_back(*entered))
        {
            share = std::min(share, near.free_share(wanted, radius_));
            break;
        }
        share = std::min(share, near.share_before(*entered, wanted, radius_));
    }
    const Vec3 straight = wanted * share;
    return !passed.empty() && straight.norm() > kLeastStep * radius_ ? straight : motion;
}

/// Coulomb's cone: the tool sticks while what pulls it along, `slip`, is within the static one, and
/// slides until it is within the dynamic one. Returns the part of it that friction takes.
Vec3 Proxy::rub(Hold& hold, const Vec3& slip) noexcept
{
    const double length = slip.norm();
    const bool slips = length > (slides_ ? hold.dynamic_m : hold.static_m) + kSlipShare * radius_;
    slides_ = slides_ || slips;
    has_slid_ = has_slid_ || slips;
    const double most = slips || slides_ ? hold.dynamic_m : hold.static_m;
    const Vec3 kept = length > most ? Vec3(slip * (most / length)) : slip;
    hold.drag_n = kept * (-hold.stiffness / hold.depth_m);
    return kept;
}

/// What the surfaces say of how far the proxy is from each object now.
void Proxy::keep_clearances(std::span<const PlacedSurface> surfaces, const Vicinity* near) noexcept
{
    const double moved = (position_ - anchor_).norm();
    for (std::uint32_t i = 0; i < surfaces.size(); ++i)
    {
        const DistanceAnswer& answer = surfaces[i].surface->answer;
        const double scale = surfaces[i].pose->scale;
        double clearance_m = answer.lower_m * scale - moved;
        if (near != nullptr)
        {
            const Vec3 place = position_ - anchor_;
            const double known = answer.certified_radius_m * scale - moved;
            const double listed =
                std::min(near->reach_m() - place.norm(), near->bound_of_surface(i, place));
            clearance_m = std::max(clearance_m, std::min(known, listed));
        }
        surfaces[i].memory->clearance_m = clearance_m;
    }
}

void Proxy::carry(std::span<const NearObject> objects, double elapsed_s) noexcept
{
    const auto along = [this](const NearObject& object)
    { return to_world(*object.now, to_model(*object.before, position_)); };
    const Vec3 stays = position_;
    Vec3 target = stays;
    for (const NearObject& object : objects)
    {
        object.memory->velocity_m_per_s = (along(object) - position_) / elapsed_s;
        target = in_contact_ && object.object == hold_.object ? along(object) : target;
    }
    was_overrun_ = is_overrun(target, objects);
    if (was_overrun_ && !is_overrun(stays, objects))
    {
        target = stays;
        was_overrun_ = false;
    }
    for (std::size_t i = 0; i < objects.size() && was_overrun_; ++i)
    {
        if (!is_overrun(along(objects[i]), objects))
        {
            target = along(objects[i]);
            was_overrun_ = false;
        }
    }
    position_ = target;
}

void Proxy::forget(std::uint32_t object) noexcept
{
    hold_.object = hold_.object == object ? kNoObject : hold_.object;
}

/// Whether the proxy could be on the other side of a surface if it goes to `target` while the
/// objects move.
bool Proxy::is_overrun(const Vec3& target, std::span<const NearObject> objects) const noexcept
{
    return std::ranges::any_of(
        objects,
        [&](const NearObject& object)
        {
            const Vec3 before = to_model(*object.before, position_);
            const double way = (to_model(*object.now, target) - before).norm();
            const double way_m = way * std::max(object.before->scale, object.now->scale);
            const bool moves = way_m > 4.0 * pose_rounding_m(*object.now, target, 0.0);
            return moves && way_m * (1.0 + kContactTolerance) >= object.memory->clearance_m;
        });
}

/// The spring's, and what damps the motion across the surface; together they never pull.
Vec3 Proxy::force(const ToolGoal& goal) const noexcept
{
    const double inward = (hold_.velocity / hold_.depth_m - goal.velocity_m_per_s).dot(normal_);
    const double push = hold_.push_n.norm();
    const double damped = std::max(-push, hold_.damping / hold_.depth_m * inward);
    return clamped(hold_.push_n + damped * normal_ + hold_.drag_n);
}

/// The hand's way across the object may change a spring's force by stiffness x way.
Vec3 Proxy::caught_up(const ToolGoal& goal) noexcept
{
    const Vec3 velocity = goal.velocity_m_per_s - hold_.velocity / hold_.depth_m;
    const double by_hand_n = hold_.stiffness / hold_.depth_m * velocity.norm() * goal.elapsed_s;
    const double rate = std::min(kCatchUp_n_per_s, kCatchUpShare_per_s * spec_.force_max_n);
    return catch_up_.next(
        {force(goal), by_hand_n, spec_.force_max_n, rate, goal.elapsed_s, waits_});
}

/// Along the last normal, never pulling.
Vec3 Proxy::held_force(const Vec3& goal) const noexcept
{
    const double push = spec_.stiffness_n_per_m * (position_ - goal).dot(normal_);
    return clamped(normal_ * std::max(0.0, push));
}

Vec3 Proxy::clamped(const Vec3& force) const noexcept
{
    const double norm = force.norm();
    return norm > spec_.force_max_n ? Vec3(force * (spec_.force_max_n / norm)) : force;
}

} // namespace tactus
