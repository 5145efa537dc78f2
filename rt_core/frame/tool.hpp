// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/follower.hpp"
#include "rt_core/force/proxy.hpp"
#include "rt_core/force/rigid_proxy.hpp"
#include "rt_core/frame/sample_watch.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/object_touch.hpp"
#include "rt_core/scene/region_of_interest.hpp"

#include <algorithm>
#include <span>
#include <variant>

namespace tactus
{

/// One tool: takes its device's samples, keeps its place at surfaces and its range, and computes a
/// force.
///
/// The kind of tool is fixed at construction by its body: a Proxy for a point that surfaces hold
/// back, a RigidProxy for another core, a Follower for a query-only tool. Haptic thread. 3 KiB.
class Tool
{
public:
    Tool() noexcept : Tool(ToolSpec{}, nullptr) {}
    /// `planes`: scratch memory of rigid tools; null for others.
    Tool(const ToolSpec& spec, RigidProxy::Planes* planes) noexcept TACTUS_NONBLOCKING;

    /// True if surfaces hold back a tool of this kind as a rigid tool, with a force and a torque.
    [[nodiscard]] static bool is_held_as_body(const ToolSpec& spec) noexcept
    {
        return !spec.query_only && !std::holds_alternative<PointCore>(spec.core);
    }

    /// True if surfaces hold the tool in this frame: neither a query-only tool, nor a rigid tool
    /// that waits to be proven clear at the device pose.
    [[nodiscard]] bool is_held() const noexcept TACTUS_NONBLOCKING;

    /// Begins the frame with a new sample, and with the objects near the tool in the last frame.
    /// `period_s` > 0 is the loop's. Returns the sample's fault.
    [[nodiscard]] FrameFault begin(const ToolState& sample, double period_s,
                                   std::span<const NearObject> objects) noexcept TACTUS_NONBLOCKING;

    /// Drops a removed object that was near; before begin().
    void forget(const PlacedSurface& gone) noexcept TACTUS_NONBLOCKING;
    /// Checks a moved object that was not near, all of which is in this sphere of its model's
    /// frame; before begin(). If its motion may have passed over the tool, the next output is
    /// over-constrained.
    void look_for_leap(const ObjectPose& before, const ObjectPose& now,
                       const Sphere& object) noexcept TACTUS_NONBLOCKING;

    /// Computes the force from surfaces that were queried at placement(); the core is at least
    /// `clear_m` away from all others there.
    [[nodiscard]] ToolOutput respond(std::span<const PlacedSurface> surfaces, double clear_m,
                                     std::uint32_t planes) noexcept TACTUS_NONBLOCKING
    {
        return finish(step(surfaces, clear_m, planes), clear_m);
    }

    /// The same in steps: try_go_on() is true if the tool would move on from its new place. Then
    /// placement() is that place, `clear_m` is reduced by the motion, and the next step() belongs
    /// to the same frame. finish() ends the steps with the `clear_m` of the frame's beginning.
    /// `planes` are the rest of Budgets::planes; a step subtracts what it used.
    [[nodiscard]] ToolOutput step(std::span<const PlacedSurface> surfaces, double clear_m,
                                  std::uint32_t& planes) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool try_go_on(double& clear_m) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] ToolOutput finish(ToolOutput output, double clear_m) noexcept TACTUS_NONBLOCKING;

    /// True if device and objects did not move in this frame and the last outputs were equal: with
    /// the same surfaces respond() would repeat them.
    [[nodiscard]] bool is_settled() const noexcept
    {
        return is_still_ && equal_outputs_ >= kSettledOutputs;
    }

    [[nodiscard]] const ToolSpec& spec() const noexcept { return spec_; }
    /// Place of the tool at the device pose.
    [[nodiscard]] const ProxyGoal& goal() const noexcept { return goal_; }
    /// Place that the surfaces allow, from begin() to respond().
    [[nodiscard]] const ToolPlacement& placement() const noexcept { return placement_; }
    /// Sphere that holds the core, in the world.
    [[nodiscard]] Sphere sphere() const noexcept
    {
        return {placement_.place.local_to_world(sphere_.center), sphere_.radius};
    }
    /// Sphere that holds all of a surface that the tool may meet in a frame.
    [[nodiscard]] Sphere reach_sphere() const noexcept
    {
        const Sphere core = sphere();
        return {core.center, core.radius + spec_.radius_m + kTouchSlack_m};
    }
    /// Displacement of an object above which it jumps: the stretch for the tool's largest force.
    [[nodiscard]] double leap_m() const noexcept
    {
        return spec_.force_max_n / spec_.stiffness_n_per_m;
    }
    /// Largest speed of the tool.
    [[nodiscard]] double speed_m_per_s() const noexcept
    {
        return std::max(spec_.speed_max_m_per_s, goal_.velocity_m_per_s.norm());
    }
    /// Displacement of the core's centre in the last frame, from begin() to finish().
    [[nodiscard]] double went_m() const noexcept { return (center_m() - began_m_).norm(); }
    /// Distance from the sphere's centre within which a surface may matter soon.
    [[nodiscard]] double near_m() const noexcept TACTUS_NONBLOCKING;
    /// Distance from the core that surfaces keep at least.
    [[nodiscard]] double radius_m() const noexcept TACTUS_NONBLOCKING;
    /// Corners of a proxy's path in the last frame, including both ends; empty for other tools.
    [[nodiscard]] std::span<const Vec3> path_m() const noexcept;

private:
    using Body = std::variant<Follower, Proxy, RigidProxy>;
    /// Motion of objects, and of the tool with them, in this frame, as in ToolOutput.
    struct Motion
    {
        double object_way_m{0.0};
        double object_turn_rad{0.0};
        Vec3 carried_m{0.0, 0.0, 0.0};
        Vec3 carried_rad{0.0, 0.0, 0.0};
    };
    /// Equal outputs for equal inputs after which nothing in `body_` changes any more.
    static constexpr std::uint32_t kSettledOutputs = 4;

    [[nodiscard]] static Body make_body(const ToolSpec& spec, RigidProxy::Planes* planes) noexcept;
    template <typename Function>
    static auto with(auto& body, const Function& function) noexcept;
    void let_carry(auto& body, std::span<const NearObject> objects) noexcept;
    void stand(const auto& body) noexcept;
    [[nodiscard]] FrameFault take(const ToolState& sample) noexcept;
    [[nodiscard]] bool is_jump(const NearObject& object) const noexcept;
    [[nodiscard]] Motion motion_of(std::span<const NearObject> objects) const noexcept;
    /// Centre of the core after the last frame.
    [[nodiscard]] Vec3 center_m() const noexcept
    {
        return output_.proxy_m + output_.proxy_rotation * sphere_.center;
    }

    ToolSpec spec_;
    Sphere sphere_; ///< Sphere round the core, in the tool's frame.
    SampleWatch watch_;
    ProxyGoal goal_;
    Body body_;
    ToolPlacement placement_;
    /// Centre of the core when this frame or, after it, the last one began.
    Vec3 began_m_{0.0, 0.0, 0.0};
    double way_left_m_{0.0}; ///< Displacement left in this frame by the speed limit.
    ToolOutput output_;      ///< Output of the last frame.
    Motion motion_;          ///< Motion of this frame; valid if has_motion_.
    bool has_motion_{false};
    bool is_still_{false};
    std::uint32_t equal_outputs_{0};
    bool lost_object_{false}; ///< An object was removed or jumped in this frame.
    bool leapt_by_{false};    ///< A distant object passed over it in this frame.
};

} // namespace tactus
