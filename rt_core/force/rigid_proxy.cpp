// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/rigid_proxy.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/force/angular_stiffness.hpp"
#include "rt_core/force/texture.hpp"
#include "rt_core/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// Slide of the tool at a hold, as a share of the radius, up to which the hold is kept. A tool at
/// rest drops a hold as near as this to a measured contact, as old planes could keep it beside an
/// edge that it should slide off. A rocking tool keeps both, the ends of its support.
constexpr double kHoldSlide = 0.05;
/// Cosine between normals above which two holds may count as one.
constexpr double kSameDirection = 0.999;
/// Motion, as a share of the radius, below which a sticking tool stays: 0.2 um for 2 mm.
constexpr double kLeastMotion = 1e-4;

/// Largest viscous displacement per stretch: more is like sticking and would exceed the numeric
/// range.
constexpr double kMostViscous = 1e6;

/// Length of a step, as a share of the radius, after which other planes may hold.
constexpr double kLongMotion = 0.25;

/// Least displacement expected of a tool in contact, as a share of the radius.
constexpr double kLeastWay = 0.5;

/// Limits of the arm, as shares of the tool's size.
constexpr double kLeastArm = 1e-3;
constexpr double kMostArm = 1e6;
/// Least radius of a tool, for a point core without a radius.
constexpr double kLeastSkin_m = 1e-9;

/// Share of the vector, 0 .. 1, that is no longer than `most`.
double share_within(const Vec3& vector, double most) noexcept
{
    const double length = vector.norm();
    return length > most ? most / length : 1.0;
}

/// True if the query found a contact within `near_m` of the touch.
bool is_measured(const RigidTouch& touch, std::span<const Contact> contacts, double near_m) noexcept
{
    return std::ranges::any_of(
        contacts,
        [&](const Contact& contact)
        {
            return (contact.on_tool_m - touch.on_tool_m).squaredNorm() < near_m * near_m &&
                   (contact.on_surface_m - touch.on_surface_m).squaredNorm() < near_m * near_m;
        });
}

bool turns(const ToolSpec& spec) noexcept
{
    return !spec.query_only && !std::holds_alternative<PointCore>(spec.core);
}

/// Radius of the tool, or its skin if that is larger; never zero. `core_m` is the radius of the
/// core's bounding sphere.
double skin_of(const ToolSpec& spec, double core_m) noexcept
{
    return std::max({spec.radius_m, kLeastSkin * core_m, kLeastSkin_m});
}

/// Radius of the core's bounding sphere plus the radius or skin of the tool.
double size_of(const ToolSpec& spec) noexcept
{
    const double core_m = PlacedCore(spec.core, Similarity{}).radius();
    return core_m + skin_of(spec, core_m);
}

/// Arm of the metric: its square is the angular stiffness over the stiffness. It is limited to
/// shares of the tool's size, to stay in the numeric range; without an angular stiffness it is the
/// size.
double arm_of(const ToolSpec& spec) noexcept
{
    const double size_m = size_of(spec);
    const bool is_set = spec.angular_stiffness_nm_per_rad > 0.0 && spec.stiffness_n_per_m > 0.0;
    return is_set
               ? std::clamp(std::sqrt(spec.angular_stiffness_nm_per_rad / spec.stiffness_n_per_m),
                            kLeastArm * size_m, kMostArm * size_m)
               : size_m;
}

} // namespace

double angular_stiffness_nm_per_rad(const ToolSpec& spec) noexcept
{
    const double arm_m = turns(spec) ? arm_of(spec) : 0.0;
    return spec.stiffness_n_per_m * arm_m * arm_m;
}

double angular_lever_m(const ToolSpec& spec) noexcept
{
    return turns(spec) ? PlacedCore(spec.core, Similarity{}).center().norm() + size_of(spec) : 0.0;
}

RigidProxy::RigidProxy(const ToolSpec& spec, Planes& planes) noexcept
    : spec_(spec), size_m_(size_of(spec)), arm_m_(arm_of(spec)), planes_(&planes)
{
    TACTUS_ASSERT(arm_m_ > 0.0);
    const PlacedCore core(spec.core, Similarity{});
    center_m_ = core.center();
    core_radius_m_ = core.radius();
    radius_m_ = skin_of(spec, core_radius_m_);
}

void RigidProxy::see(const ProxyGoal& goal) noexcept
{
    frame_ = {force_, torque_, halted_s_, is_over_constrained_};
    gone_ = Motion<6>::Zero();
    carried_m_per_s_ = Vec3(0.0, 0.0, 0.0);
    carried_rad_per_s_ = Vec3(0.0, 0.0, 0.0);
    was_overrun_ = false;
    is_on_ = false;
    if (!is_joined_)
    {
        place_ = {goal.rotation, goal.position_m, 1.0};
    }
}

void RigidProxy::carry(std::span<const NearObject> objects, double elapsed_s) noexcept
{
    for (const NearObject& object : objects)
    {
        if (object.has_moved())
        {
            TACTUS_ASSERT(elapsed_s > 0.0);
            const ObjectPose& before = *object.before;
            const ObjectPose& now = *object.now;
            const Vec3 along_m = to_world(now, to_model(before, place_.translation_m));
            object.memory->velocity_m_per_s = (along_m - place_.translation_m) / elapsed_s;
            object.memory->spin_rad_per_s =
                rotation_vector(orthonormalised(now.rotation * before.rotation.transpose())) /
                elapsed_s;
        }
    }
    if (!is_joined_ || objects.empty())
    {
        return;
    }
    const Carried<Similarity> target = carried(
        place_, objects, held_by_, [this](const NearObject& object) { return along(object); },
        [&](const Similarity& place) { return is_overrun(place, objects); });
    was_overrun_ = target.is_overrun;
    if (target.by != nullptr)
    {
        place_ = target.place;
        carried_m_per_s_ = target.by->memory->velocity_m_per_s;
        carried_rad_per_s_ = target.by->memory->spin_rad_per_s;
        gone_.head<3>() = elapsed_s * carried_m_per_s_;
        gone_.tail<3>() = arm_m_ * elapsed_s * carried_rad_per_s_;
    }
}

/// Pose of a tool that the object carries: the centre of the core and the rotation stay the same in
/// the object's frame.
Similarity RigidProxy::along(const NearObject& object) const noexcept
{
    const ObjectPose& before = *object.before;
    const ObjectPose& now = *object.now;
    const Mat3 rotation =
        orthonormalised(now.rotation * (before.rotation.transpose() * place_.rotation));
    const Vec3 center_m = to_world(now, to_model(before, place_.local_to_world(center_m_)));
    return {rotation, center_m - rotation * center_m_, 1.0};
}

/// Bound on the displacement of the core's points between two poses. The largest singular value of
/// the difference of two scaled rotations is at most its norm / sqrt(2): two are equal, and the
/// third, along the axis, is not larger.
double RigidProxy::way_m(const Similarity& from, const Similarity& to) const noexcept
{
    constexpr double kOverSqrt2 = 0.7071067811865476;
    const double turned = (to.scale * to.rotation - from.scale * from.rotation).norm();
    return (to.local_to_world(center_m_) - from.local_to_world(center_m_)).norm() +
           kOverSqrt2 * turned * core_radius_m_;
}

/// True if a point of the core could change the side of a surface by a move to `target` while the
/// objects move. A displacement within the poses' rounding does not count.
bool RigidProxy::is_overrun(const Similarity& target,
                            std::span<const NearObject> objects) const noexcept
{
    const double goes_m = way_m(place_, target);
    if (goes_m > 0.0 && goes_m >= clear_m_)
    {
        return true; // The motion exceeds the clearance from all objects without a surface here.
    }
    return std::ranges::any_of(
        objects,
        [&](const NearObject& object)
        {
            const double way =
                way_m(in_frame(*object.before, place_), in_frame(*object.now, target));
            const double relative_m = way * std::max(object.before->scale, object.now->scale);
            const double rounding_m =
                pose_rounding_m(*object.now, target.local_to_world(center_m_), core_radius_m_);
            return relative_m > 4.0 * rounding_m &&
                   relative_m * (1.0 + kContactTolerance) >= object.memory->clearance_m;
        });
}

/// Stores the core's clearance from surfaces after this step, for the next frame.
void RigidProxy::keep_clearances(std::span<const PlacedSurface> surfaces, double clear_m) noexcept
{
    clear_m_ = clear_m - went_m_;
    for (const PlacedSurface& placed : surfaces)
    {
        placed.memory->clearance_m = placed.lower_m - went_m_;
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
    held_by_ = held_by_ == object ? kNoObject : held_by_;
}

void RigidProxy::go_on() noexcept
{
    force_ = frame_.force;
    torque_ = frame_.torque;
    is_on_ = true;
}

double RigidProxy::way_to_m(const ProxyGoal& goal) const noexcept
{
    return way_of(way_to(goal)).length_m();
}

double RigidProxy::likely_way_m() const noexcept
{
    return last_pushes_.empty() ? kInfinity : std::max(2.0 * went_m_, kLeastWay * radius_m_);
}

/// Converts a motion of the tool's origin and a rotation about it to the motion of the core's
/// centre.
RigidWay RigidProxy::way_of(const Motion<6>& motion) const noexcept
{
    const Vec3 turn = motion.tail<3>() / arm_m_;
    const Vec3 center = place_.rotation * center_m_;
    return {motion.head<3>() + (turned_by(turn, Mat3::Identity()) * center - center), turn,
            core_radius_m_};
}

Motion<6> RigidProxy::way_to(const ProxyGoal& goal) const noexcept
{
    const Vec3 turn = rotation_vector(goal.rotation * place_.rotation.transpose());
    Motion<6> way;
    way.head<3>() = goal.position_m - place_.translation_m;
    way.tail<3>() = arm_m_ * turn;
    return way;
}

ToolOutput RigidProxy::respond(const ProxyGoal& goal, std::span<const PlacedSurface> surfaces,
                               double clear_m) noexcept
{
    ToolOutput output;
    const FreeMotion room(surfaces, clear_m, radius_m_);
    is_over_constrained_ = false;
    exceeds_capacity_ = false;
    goes_on_ = false;
    was_still_ = went_m_ <= kLeastMotion * radius_m_;
    went_m_ = 0.0;
    is_joined_ = is_joined_ || room.is_clear();
    if (!is_joined_)
    {
        place_ = {goal.rotation, goal.position_m, 1.0};
    }
    else if (room.is_free())
    {
        halted_s_ = 0.0;
        step(goal, surfaces, room, output);
    }
    else
    {
        halted_s_ += is_on_ ? 0.0 : goal.elapsed_s;
        freeze(goal, room.is_crossed(), output);
    }
    is_over_constrained_ = is_over_constrained_ || was_overrun_;
    catch_up(goal, output);
    keep_clearances(surfaces, clear_m);
    output.over_constrained = is_over_constrained_;
    output.capacity_exceeded = exceeds_capacity_;
    output.proxy_m = place_.translation_m;
    output.proxy_rotation = place_.rotation;
    return output;
}

void RigidProxy::step(const ProxyGoal& goal, std::span<const PlacedSurface> surfaces,
                      const FreeMotion& room, ToolOutput& output) noexcept
{
    gather(goal, surfaces);
    const Motion<6> wanted = way_to(goal);
    RigidMotion found = planes_->nearest(wanted);
    const Bumps bumps = bumps_of(found, surfaces);
    if (bumps.are_there)
    {
        found = planes_->nearest(wanted - bumps.aside);
    }
    exceeds_capacity_ = exceeds_capacity_ || planes_->exceeds_capacity();
    // A contact that was left out may have to hold if hardly any of the radius is left.
    is_over_constrained_ = found.is_over_constrained || (exceeds_capacity_ && room.is_scarce());
    sticks_ = found.sticks;
    slides_ = found.slides;
    output.in_contact = !found.pushes.empty();
    const auto* const most = std::ranges::max_element(found.pushes, {}, &RigidPush::reaction);
    held_by_ = output.in_contact ? surfaces[planes_->touch(most->touch).surface].object : kNoObject;
    add_forces(goal, found, bumps, output);
    keep_holds(found, surfaces);
    output.lag_m = advance(goal, found, room);
}

/// Moves the proxy by the free share of the motion. A sticking proxy keeps its place to the last
/// bit, as it would creep otherwise. Returns the length of the remaining motion.
double RigidProxy::advance(const ProxyGoal& goal, const RigidMotion& found,
                           const FreeMotion& room) noexcept
{
    const RigidWay way = way_of(found.motion);
    const double length_m = way.length_m();
    if (found.sticks && length_m <= kLeastMotion * radius_m_)
    {
        return 0.0;
    }
    const double share = room.share_of(way);
    went_m_ = share * length_m;
    gone_ += share * found.motion;
    goes_on_ = share > 0.0 &&
               (share < 1.0 || (!found.pushes.empty() && length_m > kLongMotion * radius_m_));
    if (found.pushes.empty() && share == 1.0)
    {
        // The proxy is at the device pose, to the last bit.
        place_ = {goal.rotation, goal.position_m, 1.0};
        return 0.0;
    }
    const Vec3 center = place_.rotation * center_m_;
    const Mat3 rotation = turned_by(found.motion.tail<3>() * (share / arm_m_), place_.rotation);
    place_.translation_m += center + share * way.center_m - rotation * center_m_;
    place_.rotation = rotation;
    return length_m - went_m_;
}

/// Sets the output of a halted proxy: the last planes resist pressure. A core that an object has
/// crossed has no proven way out, so the proxy is given up after kFadeTime_s.
void RigidProxy::freeze(const ProxyGoal& goal, bool is_crossed, ToolOutput& output) noexcept
{
    StaticVector<HalfSpace<6>, 6> spaces;
    for (const LastPush& push : last_pushes_)
    {
        spaces.push_back({push.normal, 0.0});
    }
    const NearestMotion<6> nearest = nearest_motion<6>(spaces.view(), way_to(goal));
    output.halted = true;
    output.lag_m = way_of(nearest.motion).length_m();
    output.in_contact = !nearest.held_by.empty();
    double reactions = 0.0;
    for (std::size_t i = 0; i < nearest.held_by.size(); ++i)
    {
        const LastPush& push = last_pushes_[nearest.held_by[i]];
        const Motion<6> held = nearest.reactions[i] * push.stiffness_n_per_m * push.normal;
        output.force_n += held.head<3>();
        output.torque_nm += arm_m_ * held.tail<3>();
        output.stiffness_n_per_m += nearest.reactions[i] * push.stiffness_n_per_m;
        reactions += nearest.reactions[i];
    }
    output.stiffness_n_per_m = reactions > 0.0 ? output.stiffness_n_per_m / reactions : 0.0;
    clamp(output);
    if (is_crossed && halted_s_ >= kFadeTime_s)
    {
        is_joined_ = false;
        halted_s_ = 0.0;
        holds_.clear();
        last_pushes_.clear();
    }
}

/// Lets force and torque catch up. Motion of the device counts only if the tool was
/// over-constrained, as a halted tool's force already contains it.
void RigidProxy::catch_up(const ProxyGoal& goal, ToolOutput& output) noexcept
{
    if (output.halted || !output.in_contact)
    {
        force_.follow(output.force_n);
        torque_.follow(output.torque_nm);
        return;
    }
    const double rate_n = std::min(kCatchUp_n_per_s, kCatchUpShare_per_s * spec_.force_max_n);
    const double rate_nm = kCatchUpShare_per_s * spec_.torque_max_nm;
    const bool has_no_room = is_over_constrained_ || frame_.was_over_constrained;
    const bool has_waited = frame_.halted_s > 0.0 || has_no_room;
    const double way_m =
        goal.elapsed_s * (goal.velocity_m_per_s.norm() + arm_m_ * goal.spin_rad_per_s.norm());
    const double by_device_n = has_no_room ? spec_.stiffness_n_per_m * way_m : 0.0;
    output.force_n = force_.next(
        {output.force_n, by_device_n, spec_.force_max_n, rate_n, goal.elapsed_s, has_waited});
    output.torque_nm = torque_.next({output.torque_nm, arm_m_ * by_device_n, spec_.torque_max_nm,
                                     rate_nm, goal.elapsed_s, has_waited});
}

void RigidProxy::gather(const ProxyGoal& goal, std::span<const PlacedSurface> surfaces) noexcept
{
    planes_->begin(place_.translation_m, arm_m_, size_m_, radius_m_, gone_);
    for (std::uint32_t i = 0; i < surfaces.size(); ++i)
    {
        TACTUS_ASSERT(surfaces[i].touches != nullptr); // Pairs of rigid tools report touches.
        const TouchReport& touches = *surfaces[i].touches;
        exceeds_capacity_ = exceeds_capacity_ || touches.is_truncated;
        add(i, touches.corners.view(), surfaces[i], goal.elapsed_s);
        if (!touches.ends.is_empty)
        {
            add(i, touches.ends.contacts, surfaces[i], goal.elapsed_s);
        }
        add(i, touches.nearest.view(), surfaces[i], goal.elapsed_s);
    }
    add_holds(surfaces, goal.elapsed_s);
}

void RigidProxy::add(std::uint32_t surface, std::span<const Contact> contacts,
                     const PlacedSurface& placed, double elapsed_s) noexcept
{
    for (const Contact& contact : contacts)
    {
        add({surface, contact.on_tool_m, contact.on_surface_m, contact.normal,
             contact.feature == TriangleFeature::interior},
            placed, elapsed_s);
    }
}

void RigidProxy::add(const RigidTouch& touch, const PlacedSurface& placed,
                     double elapsed_s) noexcept
{
    const Material& material = *placed.material;
    const ProxyMemory& memory = *placed.memory;
    RigidGrip grip;
    grip.stiffness_n_per_m = std::min(spec_.stiffness_n_per_m, material.stiffness_n_per_m);
    grip.friction = slides_ ? material.dynamic_friction : material.static_friction;
    grip.dynamic = material.dynamic_friction;
    grip.damping_n_s_per_m = material.damping_n_s_per_m;
    grip.velocity_m_per_s = memory.velocity_m_per_s +
                            memory.spin_rad_per_s.cross(touch.on_surface_m - place_.translation_m);
    grip.viscous =
        std::min(material.viscosity_n_s_per_m / (grip.stiffness_n_per_m * elapsed_s), kMostViscous);
    grip.frame_way_m = elapsed_s * grip.velocity_m_per_s;
    const Vec3 carried_m_per_s =
        carried_m_per_s_ + carried_rad_per_s_.cross(touch.on_surface_m - place_.translation_m);
    grip.way_m =
        is_on_ ? Vec3(0.0, 0.0, 0.0) : Vec3(elapsed_s * (grip.velocity_m_per_s - carried_m_per_s));
    planes_->add(touch, grip);
}

/// Adds the kept holds as touches. Drops holds that the tool has left, and, at rest, holds that
/// were measured again.
void RigidProxy::add_holds(std::span<const PlacedSurface> surfaces, double elapsed_s) noexcept
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
        const RigidTouch touch{static_cast<std::uint32_t>(placed - surfaces.begin()),
                               place_.translation_m + place_.rotation * hold.on_tool_m,
                               to_world(pose, hold.on_surface_m), pose.rotation * hold.normal,
                               hold.is_face};
        const Vec3 gap = touch.on_tool_m - touch.on_surface_m;
        const double height = touch.normal.dot(gap);
        const double slid = (gap - height * touch.normal).norm();
        const double near_m = kHoldSlide * radius_m_;
        const bool is_old =
            was_still_ && (is_measured(touch, placed->touches->nearest.view(), near_m) ||
                           is_measured(touch, placed->touches->corners.view(), near_m));
        if (slid > near_m || height > 2.0 * radius_m_ || is_old)
        {
            continue;
        }
        add(touch, *placed, elapsed_s);
        holds_[kept++] = hold;
    }
    while (holds_.size() > kept)
    {
        (void)holds_.pop_back();
    }
}

void RigidProxy::keep_holds(const RigidMotion& found,
                            std::span<const PlacedSurface> surfaces) noexcept
{
    last_pushes_.clear();
    for (const RigidPush& push : found.pushes)
    {
        last_pushes_.push_back({push.normal, planes_->grip(push.touch).stiffness_n_per_m});
        const RigidTouch& touch = planes_->touch(push.touch);
        const ObjectPose& pose = *surfaces[touch.surface].pose;
        keep({surfaces[touch.surface].object,
              place_.rotation.transpose() * (touch.on_tool_m - place_.translation_m),
              to_model(pose, touch.on_surface_m), pose.rotation.transpose() * touch.normal,
              touch.is_face});
    }
}

/// Keeps a hold, in place of an almost equal one. If the list is full, drops the oldest hold.
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
    exceeds_capacity_ = exceeds_capacity_ || old == holds_.end();
    old = old == holds_.end() ? holds_.begin() : old;
    std::move(old + 1, holds_.end(), old);
    holds_[holds_.size() - 1] = hold;
}

/// Effect of the textures: the spring's energy has K e(d) h besides K d^2 / 2. Here d is the motion
/// that planes hold back, in the metric, and h is taken at the middle of the core.
RigidProxy::Bumps RigidProxy::bumps_of(const RigidMotion& held,
                                       std::span<const PlacedSurface> surfaces) const noexcept
{
    Bumps bumps;
    Motion<6> pressed = Motion<6>::Zero();
    double reactions = 0.0;
    for (const RigidPush& push : held.pushes)
    {
        const RigidTouch& touch = planes_->touch(push.touch);
        const Vec3 lever = planes_->lever_m(push.touch) / arm_m_;
        pressed.head<3>() += push.reaction * touch.normal;
        pressed.tail<3>() += push.reaction * lever.cross(touch.normal);
        reactions += push.reaction;
        bumps.are_there =
            bumps.are_there || surfaces[touch.surface].material->texture_height_m > 0.0;
    }
    const double depth_m = pressed.norm();
    bumps.are_there = bumps.are_there && depth_m > 0.0 && !held.is_over_constrained;
    if (!bumps.are_there)
    {
        return bumps;
    }
    const Vec3 middle = place_.rotation * center_m_;
    double push_m = 0.0;
    Vec3 slope_m(0.0, 0.0, 0.0);
    bumps.stiffening = 0.0;
    for (const RigidPush& push : held.pushes)
    {
        const PlacedSurface& placed = surfaces[planes_->touch(push.touch).surface];
        const double share = push.reaction / reactions;
        const Texture texture =
            Texture::at(*placed.material, *placed.pose, place_.translation_m + middle, depth_m);
        push_m += share * texture.push_m;
        slope_m += share * texture.slope_m;
        bumps.stiffness_n_per_m += share * planes_->grip(push.touch).stiffness_n_per_m;
        bumps.stiffening += share * Texture::stiffening(*placed.material);
    }
    bumps.aside.head<3>() = slope_m;
    bumps.aside.tail<3>() = middle.cross(slope_m) / arm_m_;
    bumps.held = push_m / depth_m * pressed - bumps.aside;
    return bumps;
}

/// Adds the force of each push, with the spring of its own object, which keeps the wrench's line of
/// action.
void RigidProxy::add_forces(const ProxyGoal& goal, const RigidMotion& found, const Bumps& bumps,
                            ToolOutput& output) noexcept
{
    double reactions = 0.0;
    for (const RigidPush& push : found.pushes)
    {
        const double stiffness_n_per_m = planes_->grip(push.touch).stiffness_n_per_m;
        const Motion<6> held = stiffness_n_per_m * push.reaction * push.normal;
        output.force_n += held.head<3>();
        output.torque_nm += arm_m_ * held.tail<3>();
        output.stiffness_n_per_m += stiffness_n_per_m * push.reaction;
        reactions += push.reaction;
    }
    output.stiffness_n_per_m = reactions > 0.0     ? output.stiffness_n_per_m / reactions
                               : output.in_contact ? spec_.stiffness_n_per_m
                                                   : 0.0;
    if (bumps.are_there && output.in_contact)
    {
        output.force_n += bumps.stiffness_n_per_m * bumps.held.head<3>();
        output.torque_nm += bumps.stiffness_n_per_m * arm_m_ * bumps.held.tail<3>();
        output.stiffness_n_per_m *= bumps.stiffening;
    }
    damp(goal, found, reactions, output);
    clamp(output);
}

/// Damps motion across the surface at each pushing contact, by its share of the pushes. No damping
/// exceeds its push, so nothing pulls.
void RigidProxy::damp(const ProxyGoal& goal, const RigidMotion& found, double reactions,
                      ToolOutput& output) const noexcept
{
    for (const RigidPush& push : found.pushes)
    {
        const RigidGrip& grip = planes_->grip(push.touch);
        if (!(grip.damping_n_s_per_m > 0.0) || !(reactions > 0.0))
        {
            continue;
        }
        const Vec3& normal = planes_->touch(push.touch).normal;
        const Vec3 lever_m = planes_->lever_m(push.touch);
        const Vec3 device_m_per_s = goal.velocity_m_per_s + goal.spin_rad_per_s.cross(lever_m);
        const double inward = normal.dot(grip.velocity_m_per_s - device_m_per_s);
        const double part = push.reaction / reactions;
        const double damping_n = std::max(part * grip.damping_n_s_per_m * inward,
                                          -grip.stiffness_n_per_m * push.reaction);
        output.force_n += damping_n * normal;
        output.torque_nm += damping_n * lever_m.cross(normal);
    }
}

void RigidProxy::clamp(ToolOutput& output) const noexcept
{
    const double most_nm = spec_.torque_max_nm;
    double share = share_within(output.force_n, spec_.force_max_n);
    share = most_nm > 0.0 ? std::min(share, share_within(output.torque_nm, most_nm)) : share;
    output.force_n *= share;
    output.torque_nm = most_nm > 0.0 ? Vec3(share * output.torque_nm) : Vec3(0.0, 0.0, 0.0);
}

} // namespace tactus
