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
#include "rt_core/scene/outlook.hpp"

#include <algorithm>
#include <span>
#include <variant>

namespace tactus
{

/// One tool: takes its device's samples, knows where surfaces let it be and how far it looks, and
/// answers with a force.
///
/// What kind of tool it is, is decided once, by what becomes its body: a point that surfaces hold
/// back is a Proxy, another core a RigidProxy, a tool that passes through a Follower. Haptic
/// thread. 3 KiB.
class Tool
{
public:
    Tool() noexcept : Tool(ToolSpec{}, nullptr) {}
    /// `planes`: scratch of tools that are held as bodies; others need none.
    Tool(const ToolSpec& spec, RigidProxy::Planes* planes) noexcept TACTUS_NONBLOCKING;

    /// Whether surfaces hold back a tool of this kind as a body, with a force and a torque.
    [[nodiscard]] static bool is_held_as_body(const ToolSpec& spec) noexcept
    {
        return !spec.passes_through && !std::holds_alternative<PointCore>(spec.core);
    }

    /// Surfaces hold it in this frame: not of one that passes through, nor of a body that waits to
    /// be proven clear where the hand is.
    [[nodiscard]] bool is_held() const noexcept TACTUS_NONBLOCKING;

    /// The frame begins: a new sample, and objects that it was near to in the last frame.
    /// `period_s` > 0 is the loop's. Returns what is wrong with the sample.
    [[nodiscard]] FrameFault begin(const ToolState& sample, double period_s,
                                   std::span<const NearObject> objects) noexcept TACTUS_NONBLOCKING;

    /// An object that it was near to is gone; before begin().
    void forget(const PlacedSurface& gone) noexcept TACTUS_NONBLOCKING;
    /// One that it was not near to has moved, all of it in this ball of its model's frame; before
    /// begin(). Where it may have come by the tool in that leap the next output is squeezed.
    void look_for_leap(const ObjectPose& before, const ObjectPose& now,
                       const Ball& object) noexcept TACTUS_NONBLOCKING;

    /// The force, from surfaces that were queried at stance(); from everything else its core is at
    /// least `clear_m` away there.
    [[nodiscard]] ToolOutput respond(std::span<const PlacedSurface> surfaces, double clear_m,
                                     std::uint32_t planes) noexcept TACTUS_NONBLOCKING
    {
        return finish(step(surfaces, clear_m, planes), clear_m);
    }

    /// The same in steps: try_go_on() says whether a tool, from where it came to, would go on. Then
    /// stance() is there, `clear_m` is less by what it went, and the next step() is one more of the
    /// same frame. finish() ends them, with what the frame began with. `planes` are what is left of
    /// Budgets::planes; a step takes away what it used.
    [[nodiscard]] ToolOutput step(std::span<const PlacedSurface> surfaces, double clear_m,
                                  std::uint32_t& planes) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool try_go_on(double& clear_m) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] ToolOutput finish(ToolOutput output, double clear_m) noexcept TACTUS_NONBLOCKING;

    /// In this frame hand and objects are where they were, and the last outputs were alike: with
    /// the same surfaces respond() would say the same.
    [[nodiscard]] bool is_settled() const noexcept
    {
        return is_still_ && equal_outputs_ >= kSettledOutputs;
    }

    [[nodiscard]] const ToolSpec& spec() const noexcept { return spec_; }
    /// As the hand has it.
    [[nodiscard]] const ToolGoal& goal() const noexcept { return goal_; }
    /// As the surfaces let it be, from begin() to respond().
    [[nodiscard]] const ToolStance& stance() const noexcept { return stance_; }
    /// Holds the core, in the world.
    [[nodiscard]] Ball ball() const noexcept
    {
        return {stance_.place.to_there(ball_.center), ball_.radius};
    }
    /// Holds what of a surface it may meet in a frame.
    [[nodiscard]] Ball reach_ball() const noexcept
    {
        const Ball core = ball();
        return {core.center, core.radius + spec_.radius_m + kTouchSlack_m};
    }
    /// What is farther is a jump of an object: the way that makes the tool's largest force.
    [[nodiscard]] double leap_m() const noexcept
    {
        return spec_.force_max_n / spec_.stiffness_n_per_m;
    }
    /// How fast it may go.
    [[nodiscard]] double speed_m_per_s() const noexcept
    {
        return std::max(spec_.speed_max_m_per_s, goal_.velocity_m_per_s.norm());
    }
    /// How far its core's middle went in the last frame, from begin() to finish().
    [[nodiscard]] double went_m() const noexcept { return (center_m() - began_m_).norm(); }
    /// How far round that ball's centre a surface may matter to it soon.
    [[nodiscard]] double near_m() const noexcept TACTUS_NONBLOCKING;
    /// Surfaces are kept at least this far from the core.
    [[nodiscard]] double radius_m() const noexcept TACTUS_NONBLOCKING;
    /// The places that a proxy went by in the last frame, in straight lines, the first and the last
    /// included; empty for other tools.
    [[nodiscard]] std::span<const Vec3> path_m() const noexcept;

private:
    using Body = std::variant<Follower, Proxy, RigidProxy>;
    /// How objects move and carry it in this frame, as ToolOutput tells.
    struct Motion
    {
        double object_way_m{0.0};
        double object_turn_rad{0.0};
        Vec3 carried_m{0.0, 0.0, 0.0};
        Vec3 carried_rad{0.0, 0.0, 0.0};
    };
    /// After so many equal outputs of equal inputs nothing within the body changes any more.
    static constexpr std::uint32_t kSettledOutputs = 4;

    [[nodiscard]] static Body make_body(const ToolSpec& spec, RigidProxy::Planes* planes) noexcept;
    template <typename Function>
    static auto with(auto& body, const Function& function) noexcept;
    void let_carry(auto& body, std::span<const NearObject> objects) noexcept;
    void stand(const auto& body) noexcept;
    [[nodiscard]] FrameFault take(const ToolState& sample) noexcept;
    [[nodiscard]] bool is_jump(const NearObject& object) const noexcept;
    [[nodiscard]] Motion motion_of(std::span<const NearObject> objects) const noexcept;
    /// Of its core, as the last frame left it.
    [[nodiscard]] Vec3 center_m() const noexcept
    {
        return output_.proxy_m + output_.proxy_rotation * ball_.center;
    }

    ToolSpec spec_;
    Ball ball_; ///< Holds the core, in the tool's frame.
    SampleWatch watch_;
    ToolGoal goal_;
    Body body_;
    ToolStance stance_;
    Vec3 began_m_{0.0, 0.0, 0.0}; ///< Its core's middle, when this frame or the last one began.
    double way_left_m_{0.0};      ///< In this frame, by the speed limit.
    ToolOutput output_;           ///< The last frame's.
    Motion motion_;               ///< Of this frame, where has_motion_.
    bool has_motion_{false};
    bool is_still_{false};
    std::uint32_t equal_outputs_{0};
    bool lost_object_{false}; ///< In this one, while it was: an object went or jumped.
    bool leapt_by_{false};    ///< An object that it was not near to, in this frame.
};

} // namespace tactus
