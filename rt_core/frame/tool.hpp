// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/follower.hpp"
#include "rt_core/force/proxy.hpp"
#include "rt_core/force/rigid_proxy.hpp"
#include "rt_core/frame/sample_watch.hpp"
#include "rt_core/scene/outlook.hpp"

#include <span>
#include <variant>

namespace tactus
{

/// One tool: takes its device's samples, knows where surfaces let it be and how far it looks, and
/// answers with a force.
///
/// What kind of tool it is, is decided once, by what becomes its body: a point that surfaces hold
/// back is a Proxy, another core a RigidProxy, a tool that passes through a Follower. Haptic
/// thread. 2.4 KiB.
class Tool
{
public:
    Tool() noexcept : Tool(ToolSpec{}, nullptr) {}
    /// `planes`: scratch of tools that are held as bodies; others need none.
    Tool(const ToolSpec& spec, RigidProxy::Planes* planes) noexcept;

    /// Whether surfaces hold back a tool of this kind as a body, with a force and a torque.
    [[nodiscard]] static bool is_held_as_body(const ToolSpec& spec) noexcept
    {
        return !spec.passes_through && !std::holds_alternative<PointCore>(spec.core);
    }

    /// The frame begins: a new sample, and objects that went from `before` to `now`; in the first
    /// frame `before` is empty. `period_s` > 0 is the loop's. Returns what is wrong with the
    /// sample.
    [[nodiscard]] FrameFault begin(const ToolState& sample, double period_s,
                                   std::span<const ObjectPose> before,
                                   std::span<const ObjectPose> now) noexcept TACTUS_NONBLOCKING;

    /// The force, from the surfaces of all objects in order, which were queried at stance().
    [[nodiscard]] ToolOutput
    respond(std::span<const PlacedSurface> surfaces) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const ToolSpec& spec() const noexcept { return spec_; }
    /// As the hand has it.
    [[nodiscard]] const ToolGoal& goal() const noexcept { return goal_; }
    /// As the surfaces let it be, from begin() to respond().
    [[nodiscard]] const ToolStance& stance() const noexcept { return stance_; }
    /// Surfaces are kept at least this far from the core.
    [[nodiscard]] double radius_m() const noexcept TACTUS_NONBLOCKING;
    /// The places that a proxy went by in the last frame, in straight lines, the first and the last
    /// included; empty for other tools.
    [[nodiscard]] std::span<const Vec3> path_m() const noexcept;

private:
    using Body = std::variant<Follower, Proxy, RigidProxy>;

    [[nodiscard]] static Body make_body(const ToolSpec& spec, RigidProxy::Planes* planes) noexcept;
    template <typename Function>
    static auto with(auto& body, const Function& function) noexcept;
    [[nodiscard]] FrameFault take(const ToolState& sample) noexcept;

    ToolSpec spec_;
    SampleWatch watch_;
    ToolGoal goal_;
    Body body_;
    ToolStance stance_;
    bool is_in_contact_{false}; ///< In the last frame.
};

} // namespace tactus
