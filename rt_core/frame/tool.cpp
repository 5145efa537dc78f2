// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/tool.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/object_speed_limit.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/rotation.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Margin of the reach beyond the proxy's possible motion, as a share of the tool's radius. So a
/// front that lags by a frame or two still holds the needed surface.
constexpr double kReachMargin = 0.05;

/// Time ahead, in seconds, for which a second place is refined, so that the surface is ready for
/// the tool. A contact needs about 600 splits at 1 M faces, ten frames of 64.
constexpr double kApproachTime_s = 0.01;

/// Time ahead, in seconds, for which chunks are requested within the tool's possible motion.
constexpr double kNearTime_s = 0.15;

/// Rotation vector, about the world's axes, from one rotation to another.
Vec3 rotation_between(const Mat3& from, const Mat3& to) noexcept
{
    return from == to ? Vec3(0.0, 0.0, 0.0)
                      : rotation_vector(orthonormalised(to * from.transpose()));
}

/// Expected displacement of a tool's proxy (Proxy, RigidProxy or Follower) in a frame; infinite if
/// it has no expectation.
double likely_way_m(const auto& proxy) noexcept
{
    if constexpr (requires { proxy.likely_way_m(); })
    {
        return proxy.likely_way_m();
    }
    else
    {
        return kInfinity;
    }
}

} // namespace

Tool::Tool(const ToolSpec& spec, RigidProxy::Planes* planes) noexcept
    : spec_(spec), proxy_(make_proxy(spec, planes))
{
    const PlacedCore core(spec.core, Similarity{});
    sphere_ = {core.center(), core.radius()};
}

Tool::AnyProxy Tool::make_proxy(const ToolSpec& spec, RigidProxy::Planes* planes) noexcept
{
    if (is_held_as_rigid(spec))
    {
        TACTUS_ASSERT(planes != nullptr);
        return RigidProxy(spec, *planes);
    }
    if (spec.query_only)
    {
        return Follower(spec);
    }
    return Proxy(spec);
}

/// Calls `function` with the alternative in `any`, like std::visit, which may throw.
template <typename Function>
auto Tool::with(auto& any, const Function& function) noexcept
{
    if (auto* proxy = std::get_if<Proxy>(&any); proxy != nullptr)
    {
        return function(*proxy);
    }
    if (auto* rigid = std::get_if<RigidProxy>(&any); rigid != nullptr)
    {
        return function(*rigid);
    }
    auto* const follower = std::get_if<Follower>(&any);
    TACTUS_ASSERT(follower != nullptr);
    return function(*follower);
}

FrameFault Tool::begin(const ToolState& sample, double period_s,
                       std::span<const NearObject> objects) noexcept
{
    TACTUS_ASSERT(period_s > 0.0);
    lost_object_ =
        lost_object_ || std::ranges::any_of(objects, [this](const NearObject& object)
                                            { return object.has_moved() && is_jump(object); });
    const ProxyGoal last = goal_;
    goal_.elapsed_s = period_s * static_cast<double>(std::max(sample.elapsed_periods, 1U));
    const FrameFault fault = take(sample);
    is_still_ = fault == FrameFault::none && objects.empty() && !lost_object_ && !leapt_by_ &&
                goal_ == last && goal_.velocity_m_per_s == Vec3(0.0, 0.0, 0.0);
    with(proxy_,
         [&](auto& proxy)
         {
             proxy.see(goal_);
             let_carry(proxy, objects);
             way_left_m_ = spec_.speed_max_m_per_s * goal_.elapsed_s;
             stand(proxy);
         });
    began_m_ = sphere().center;
    // A mesh in contact is refined ahead by its own motion (MeshPair).
    const double ahead_s = output_.in_contact && is_mesh(spec_) ? 0.0 : kApproachTime_s;
    placement_.approach_m = ahead_s * goal_.velocity_m_per_s;
    return fault;
}

/// Lets moved objects carry the proxy, and measures the motion; without near objects there is
/// nothing to measure.
void Tool::let_carry(auto& proxy, std::span<const NearObject> objects) noexcept
{
    has_motion_ = !objects.empty();
    if (!has_motion_)
    {
        proxy.carry(objects, goal_.elapsed_s);
        return;
    }
    motion_ = motion_of(objects);
    const Similarity before = proxy.place();
    proxy.carry(objects, goal_.elapsed_s);
    const Similarity now = proxy.place();
    motion_.carried_m = now.translation_m - before.translation_m;
    motion_.carried_rad = rotation_between(before.rotation, now.rotation);
}

bool Tool::is_held() const noexcept
{
    const auto* const rigid = std::get_if<RigidProxy>(&proxy_);
    return rigid != nullptr ? rigid->is_joined() : !spec_.query_only;
}

/// Updates the placement. The reach covers the proxy's possible way to the goal. Only the expected
/// way counts for a mesh, as surface in reach costs a hundred times as much as for other tools.
void Tool::stand(const auto& proxy) noexcept
{
    const double likely_m = is_mesh(spec_) ? likely_way_m(proxy) : kInfinity;
    const double way_m = std::min({proxy.way_to_m(goal_), way_left_m_, likely_m});
    placement_.place = proxy.place();
    placement_.reach_m = proxy.radius_m() * (1.0 + kReachMargin) + way_m;
    if constexpr (requires { proxy.feels_beyond_m(); })
    {
        placement_.reach_m += proxy.feels_beyond_m();
    }
}

FrameFault Tool::take(const ToolState& sample) noexcept
{
    const SampleWatch::Verdict verdict = watch_.judge(sample, spec_, goal_, goal_.elapsed_s);
    if (!verdict.is_taken)
    {
        goal_.change = GoalChange::none;
        return verdict.fault;
    }
    goal_.change = verdict.is_first                    ? GoalChange::first
                   : verdict.fault != FrameFault::none ? GoalChange::jump
                                                       : GoalChange::motion;
    goal_.velocity_m_per_s = goal_.change == GoalChange::motion
                                 ? Vec3((sample.position_m - goal_.position_m) / verdict.since_s)
                                 : Vec3(0.0, 0.0, 0.0);
    const Mat3 rotation = orthonormalised(sample.rotation);
    goal_.spin_rad_per_s = Vec3(0.0, 0.0, 0.0);
    if (goal_.change == GoalChange::motion)
    {
        goal_.spin_rad_per_s = rotation_between(goal_.rotation, rotation) / verdict.since_s;
    }
    goal_.position_m = sample.position_m;
    goal_.rotation = rotation;
    return verdict.fault;
}

/// True if an object that the tool touches or may meet jumped: it moved by more than leap_m() in
/// one frame.
bool Tool::is_jump(const NearObject& object) const noexcept
{
    const Sphere reach = reach_sphere();
    const double way_m = way_in_sphere_m(*object.before, *object.now, reach.center, reach.radius);
    return way_m > leap_m() &&
           (output_.in_contact || object.lower_m <= spec_.radius_m + kTouchSlack_m + way_m);
}

/// Motion of objects whose surface may be at the tool; others change no force in this frame.
Tool::Motion Tool::motion_of(std::span<const NearObject> objects) const noexcept
{
    Motion motion;
    const Sphere reach = reach_sphere();
    for (const NearObject& object : objects)
    {
        if (!object.has_moved() || object.lower_m > spec_.radius_m + kTouchSlack_m)
        {
            continue;
        }
        const double way_m =
            way_in_sphere_m(*object.before, *object.now, reach.center, reach.radius);
        motion.object_way_m = std::max(motion.object_way_m, way_m);
        motion.object_rotation_rad =
            std::max(motion.object_rotation_rad,
                     rotation_between(object.before->rotation, object.now->rotation).norm());
    }
    return motion;
}

void Tool::forget(const PlacedSurface& gone) noexcept
{
    lost_object_ = lost_object_ || (output_.in_contact && gone.lower_m <= placement_.reach_m);
    with(proxy_, [&gone](auto& proxy) { proxy.forget(gone.object); });
}

/// Tests the straight path of the core's bounding sphere in the object's frame.
void Tool::look_for_leap(const ObjectPose& before, const ObjectPose& now,
                         const Sphere& object) noexcept
{
    if (spec_.query_only || goal_.elapsed_s == 0.0)
    {
        return; // The tool is not held, or has no place yet.
    }
    const Vec3 from_m = to_model(before, center_m()) - object.center;
    const Vec3 way_m = to_model(now, center_m()) - object.center - from_m;
    const double length_sq = way_m.squaredNorm();
    const double share =
        length_sq > 0.0 ? std::clamp(-from_m.dot(way_m) / length_sq, 0.0, 1.0) : 0.0;
    const double radius_m = object.radius + sphere_.radius / std::min(before.scale, now.scale);
    leapt_by_ = leapt_by_ || (from_m + share * way_m).norm() <= radius_m;
}

double Tool::near_m() const noexcept
{
    const double soon_m =
        std::max(RegionOfInterest::kKeepFactor * placement_.reach_m + placement_.approach_m.norm(),
                 placement_.reach_m + kNearTime_s * goal_.velocity_m_per_s.norm());
    return sphere_.radius + soon_m;
}

bool Tool::try_go_on(double& clear_m) noexcept
{
    if (auto* const proxy = std::get_if<Proxy>(&proxy_); proxy != nullptr)
    {
        way_left_m_ -= proxy->went_m();
        if (!proxy->goes_on() || way_left_m_ <= 0.0)
        {
            return false;
        }
        clear_m -= proxy->went_m();
        proxy->go_on();
        stand(*proxy);
        return true;
    }
    auto* const proxy = std::get_if<RigidProxy>(&proxy_);
    if (proxy == nullptr || !proxy->goes_on())
    {
        return false;
    }
    clear_m -= proxy->went_m();
    proxy->go_on();
    placement_.place = proxy->place();
    return true;
}

ToolOutput Tool::step(std::span<const PlacedSurface> surfaces, double clear_m,
                      std::uint32_t& planes) noexcept
{
    if (auto* const proxy = std::get_if<Proxy>(&proxy_); proxy != nullptr)
    {
        const ToolOutput output = proxy->respond(goal_, surfaces, clear_m, planes);
        planes = proxy->planes_left();
        return output;
    }
    return with(proxy_, [&](auto& proxy) { return proxy.respond(goal_, surfaces, clear_m); });
}

ToolOutput Tool::finish(ToolOutput output, double clear_m) noexcept
{
    watch_.look_for_return(output, spec_, goal_);
    output.sample_fault = watch_.fault();
    output.clear_m = std::max(clear_m, 0.0);
    lost_object_ = lost_object_ || (has_edit_ && output_.in_contact && !output.in_contact);
    has_edit_ = false;
    output.lost_object = lost_object_;
    if (has_motion_ && !lost_object_) // A jump does not count as motion.
    {
        output.object_way_m = motion_.object_way_m;
        output.object_rotation_rad = motion_.object_rotation_rad;
        output.carried_m = motion_.carried_m;
        output.carried_rad = motion_.carried_rad;
    }
    lost_object_ = false;
    output.over_constrained = output.over_constrained || leapt_by_;
    leapt_by_ = false;
    equal_outputs_ = is_still_ && output == output_ ? equal_outputs_ + 1 : 0;
    output_ = output;
    return output;
}

double Tool::radius_m() const noexcept
{
    return with(proxy_, [](const auto& proxy) { return proxy.radius_m(); });
}

std::span<const Vec3> Tool::path_m() const noexcept
{
    const auto* proxy = std::get_if<Proxy>(&proxy_);
    return proxy != nullptr ? proxy->path_m() : std::span<const Vec3>{};
}

} // namespace tactus
