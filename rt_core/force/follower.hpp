// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/placed_surface.hpp"
#include "rt_core/force/tool_goal.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/records/frame_output.hpp"

#include <span>

namespace tactus
{

/// A tool that measures: it is where the hand is, in surfaces too, and has no force.
///
/// Has the functions of Proxy and RigidProxy. Haptic thread.
class Follower
{
public:
    explicit Follower(const ToolSpec& spec) noexcept : radius_m_(spec.radius_m), core_(spec.core) {}

    void see(const ToolGoal& goal) noexcept TACTUS_NONBLOCKING;
    /// Objects do not move it.
    void carry(std::span<const NearObject> /*objects*/,
               double /*elapsed_s*/) noexcept TACTUS_NONBLOCKING
    {
    }
    void forget(std::uint32_t /*object*/) noexcept TACTUS_NONBLOCKING {}
    [[nodiscard]] const Similarity& place() const noexcept { return place_; }
    [[nodiscard]] double radius_m() const noexcept { return radius_m_; }
    /// How far the core's farthest point went since the last frame.
    [[nodiscard]] double way_to_m(const ToolGoal& /*goal*/) const noexcept { return way_m_; }

    /// In contact where an upper bound proves that the tool touches.
    [[nodiscard]] ToolOutput respond(const ToolGoal& goal, std::span<const PlacedSurface> surfaces,
                                     double clear_m) const noexcept TACTUS_NONBLOCKING;

private:
    double radius_m_;
    ToolCore core_;
    Similarity place_; ///< In the world.
    double way_m_{0.0};
};

} // namespace tactus
