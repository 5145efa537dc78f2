// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/tool.hpp"

#include "rt_core/math/rotation.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// The ball is wider than the proxy's possible motion by this share of the tool's radius, so that
/// a front that lags by a frame or two still holds what the proxy needs.
constexpr double kReachMargin = 0.05;

/// Before contact a second ball is refined this far ahead in time, so that the front is there when
/// the tool is: a contact needs some 600 splits at 1 M faces, ten frames of 64.
constexpr double kApproachTime_s = 0.01;

} // namespace

Tool::Tool(const ToolSpec& spec, RigidProxy::Planes* planes) noexcept
    : spec_(spec), body_(make_body(spec, planes))
{
}

Tool::Body Tool::make_body(const ToolSpec& spec, RigidProxy::Planes* planes) noexcept
{
    if (is_held_as_body(spec))
    {
        TACTUS_ASSERT(planes != nullptr);
        return RigidProxy(spec, *planes);
    }
    if (spec.passes_through)
    {
        return Follower(spec);
    }
    return Proxy(spec);
}

/// As std::visit, which would bring an exception.
template <typename Function>
auto Tool::with(auto& body, const Function& function) noexcept
{
    if (auto* proxy = std::get_if<Proxy>(&body); proxy != nullptr)
    {
        return function(*proxy);
    }
    if (auto* rigid = std::get_if<RigidProxy>(&body); rigid != nullptr)
    {
        return function(*rigid);
    }
    return function(*std::get_if<Follower>(&body));
}

FrameFault Tool::begin(const ToolState& sample, double period_s, std::span<const ObjectPose> before,
                       std::span<const ObjectPose> now) noexcept
{
    TACTUS_ASSERT(period_s > 0.0);
    TACTUS_ASSERT(before.empty() || before.size() == now.size());
    goal_.elapsed_s = period_s * static_cast<double>(std::max(sample.elapsed_periods, 1U));
    const FrameFault fault = take(sample);
    with(body_,
         [&](auto& body)
         {
             body.see(goal_);
             if (!before.empty())
             {
                 body.carry(before, now, goal_.elapsed_s);
             }
             const double most_m = spec_.speed_max_m_per_s * goal_.elapsed_s;
             stance_.place = body.place();
             stance_.reach_m =
                 body.radius_m() * (1.0 + kReachMargin) + std::min(body.way_to_m(goal_), most_m);
         });
    stance_.approach_m =
        is_in_contact_ ? Vec3(0.0, 0.0, 0.0) : Vec3(kApproachTime_s * goal_.velocity_m_per_s);
    return fault;
}

FrameFault Tool::take(const ToolState& sample) noexcept
{
    const SampleWatch::Verdict verdict =
        watch_.judge(sample, spec_, goal_.position_m, goal_.elapsed_s);
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
    goal_.position_m = sample.position_m;
    goal_.rotation = orthonormalised(sample.rotation);
    return verdict.fault;
}

ToolOutput Tool::respond(std::span<const PlacedSurface> surfaces) noexcept
{
    ToolOutput output = with(body_, [&](auto& body) { return body.respond(goal_, surfaces); });
    watch_.look_for_return(output, spec_, goal_.position_m);
    output.sample_fault = watch_.fault();
    is_in_contact_ = output.in_contact;
    return output;
}

double Tool::radius_m() const noexcept
{
    return with(body_, [](const auto& body) { return body.radius_m(); });
}

std::span<const Vec3> Tool::path_m() const noexcept
{
    const auto* proxy = std::get_if<Proxy>(&body_);
    return proxy != nullptr ? proxy->path_m() : std::span<const Vec3>{};
}

} // namespace tactus
