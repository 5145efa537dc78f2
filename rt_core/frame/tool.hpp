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

/// One tool: takes its device's samples, keeps its placement among surfaces, and computes a force.
///
/// The kind of tool is fixed at construction: a Proxy for a point core, a RigidProxy for other
/// cores, and a Follower for a query-only tool. Haptic thread. 3 KiB.
class Tool
{
public:
    Tool() noexcept : Tool(ToolSpec{}, nullptr) {}
    /// Makes a tool. `planes` is scratch memory for rigid tools; null for others.
    Tool(const ToolSpec& spec, RigidProxy::Planes* planes) noexcept TACTUS_NONBLOCKING;

    /// True if a tool of this kind is a RigidProxy, with a force and a torque.
    [[nodiscard]] static bool is_held_as_rigid(const ToolSpec& spec) noexcept
    {
        return !spec.query_only && !std::holds_alternative<PointCore>(spec.core);
    }

    /// True if surfaces hold the tool in this frame. False for a query-only tool, and for a rigid
    /// tool until it is proven clear at the device pose.
    [[nodiscard]] bool is_held() const noexcept TACTUS_NONBLOCKING;

    /// Begins the frame with a new sample, and with the objects that were near in the last frame.
    /// `period_s` > 0 is the loop's period. Returns the sample's fault.
    [[nodiscard]] FrameFault begin(const ToolState& sample, double period_s,
                                   std::span<const NearObject> objects) noexcept TACTUS_NONBLOCKING;

    /// Forgets a removed object that was near; before begin().
    void forget(const PlacedSurface& gone) noexcept TACTUS_NONBLOCKING;
    /// Notes an edit of a near surface; before begin(). If the tool touches nothing afterwards, it
    /// has lost its object.
    void note_edit() noexcept { has_edit_ = true; }
    /// Checks the motion of an object that was not near; before begin(). `object` is its bounding
    /// sphere in its model's frame. If the object may have passed over the tool, the next output is
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

    /// The work of respond() in steps. try_go_on() is true if the tool would move on from its new
    /// place. It then moves placement() there, reduces `clear_m` by the motion, and makes the next
    /// step() belong to the same frame. finish() ends the steps, with `clear_m` as of the frame's
    /// beginning. `planes` is the rest of Budgets::planes; a step subtracts what it used.
    [[nodiscard]] ToolOutput step(std::span<const PlacedSurface> surfaces, double clear_m,
                                  std::uint32_t& planes) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool try_go_on(double& clear_m) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] ToolOutput finish(ToolOutput output, double clear_m) noexcept TACTUS_NONBLOCKING;

    /// True if device and objects did not move in this frame and the last kSettledOutputs outputs
    /// were equal: with the same surfaces, respond() would repeat them.
    [[nodiscard]] bool is_settled() const noexcept
    {
        return is_still_ && equal_outputs_ >= kSettledOutputs;
    }

    [[nodiscard]] const ToolSpec& spec() const noexcept { return spec_; }
    /// Goal of the tool: its place at the device pose.
    [[nodiscard]] const ProxyGoal& goal() const noexcept { return goal_; }
    /// Place of the tool that surfaces allow, and its reach; valid from begin() to respond().
    [[nodiscard]] const ToolPlacement& placement() const noexcept { return placement_; }
    /// Bounding sphere of the core, in the world.
    [[nodiscard]] Sphere sphere() const noexcept
    {
        return {placement_.place.local_to_world(sphere_.center), sphere_.radius};
    }
    /// Sphere round all points of surfaces that the tool may meet in a frame.
    [[nodiscard]] Sphere reach_sphere() const noexcept
    {
        const Sphere core = sphere();
        return {core.center, core.radius + spec_.radius_m + kTouchSlack_m};
    }
    /// Displacement of an object in a frame above which it counts as a jump: the spring's stretch
    /// at the tool's largest force.
    [[nodiscard]] double leap_m() const noexcept
    {
        return spec_.force_max_n / spec_.stiffness_n_per_m;
    }
    /// The larger of the speed limit of the proxy and the speed of the device.
    [[nodiscard]] double speed_m_per_s() const noexcept
    {
        return std::max(spec_.speed_max_m_per_s, goal_.velocity_m_per_s.norm());
    }
    /// Displacement of the core's centre in the last frame, from begin() to finish().
    [[nodiscard]] double went_m() const noexcept { return (center_m() - began_m_).norm(); }
    /// Distance from the centre of sphere() within which a surface may matter soon.
    [[nodiscard]] double near_m() const noexcept TACTUS_NONBLOCKING;
    /// Least distance of surfaces from the core: the tool's radius or its skin.
    [[nodiscard]] double radius_m() const noexcept TACTUS_NONBLOCKING;
    /// Corners of the path of a sphere's proxy in the last frame, including both ends; empty for
    /// other tools.
    [[nodiscard]] std::span<const Vec3> path_m() const noexcept;

private:
    using AnyProxy = std::variant<Follower, Proxy, RigidProxy>;
    /// Motion of objects, and of the tool with them, in this frame; the fields are those of
    /// ToolOutput.
    struct Motion
    {
        double object_way_m{0.0};
        double object_rotation_rad{0.0};
        Vec3 carried_m{0.0, 0.0, 0.0};
        Vec3 carried_rad{0.0, 0.0, 0.0};
    };
    /// Number of equal outputs, for equal inputs, after which `proxy_` no longer changes.
    static constexpr std::uint32_t kSettledOutputs = 4;

    [[nodiscard]] static AnyProxy make_proxy(const ToolSpec& spec,
                                             RigidProxy::Planes* planes) noexcept;
    template <typename Function>
    static auto with(auto& any, const Function& function) noexcept;
    void let_carry(auto& proxy, std::span<const NearObject> objects) noexcept;
    void stand(const auto& proxy) noexcept;
    [[nodiscard]] FrameFault take(const ToolState& sample) noexcept;
    [[nodiscard]] bool is_jump(const NearObject& object) const noexcept;
    [[nodiscard]] Motion motion_of(std::span<const NearObject> objects) const noexcept;
    /// Centre of the core after the last frame.
    [[nodiscard]] Vec3 center_m() const noexcept
    {
        return output_.proxy_m + output_.proxy_rotation * sphere_.center;
    }

    ToolSpec spec_;
    Sphere sphere_; ///< Bounding sphere of the core, in the tool's frame.
    SampleWatch watch_;
    ProxyGoal goal_;
    AnyProxy proxy_;
    ToolPlacement placement_;
    /// Centre of the core at the beginning of this frame; between frames, of the last one.
    Vec3 began_m_{0.0, 0.0, 0.0};
    double way_left_m_{0.0}; ///< Displacement that the speed limit leaves in this frame.
    ToolOutput output_;      ///< Output of the last frame.
    Motion motion_;          ///< Motion of this frame; valid if has_motion_.
    bool has_motion_{false};
    bool is_still_{false};
    std::uint32_t equal_outputs_{0};
    bool has_edit_{false};    ///< True if a near surface was edited in this frame.
    bool lost_object_{false}; ///< True if an object in reach was removed or jumped in this frame.
    /// True if a distant object may have passed over the tool in this frame.
    bool leapt_by_{false};
};

} // namespace tactus
