// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/placed_surface.hpp"
#include "rt_core/force/proxy_goal.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/records/frame_output.hpp"

#include <span>

namespace tactus
{

/// State of a query-only tool: the tool is at the device pose, even inside surfaces, and has no
/// force.
///
/// The functions are those of Proxy and RigidProxy. Haptic thread.
class Follower
{
public:
    explicit Follower(const ToolSpec& spec) noexcept : radius_m_(spec.radius_m), core_(spec.core) {}

    void see(const ProxyGoal& goal) noexcept TACTUS_NONBLOCKING;
    /// No effect: objects do not move the tool.
    void carry(std::span<const NearObject> /*objects*/,
               double /*elapsed_s*/) noexcept TACTUS_NONBLOCKING
    {
    }
    void forget(std::uint32_t /*object*/) noexcept TACTUS_NONBLOCKING {}
    [[nodiscard]] const Similarity& place() const noexcept { return place_; }
    [[nodiscard]] double radius_m() const noexcept { return radius_m_; }
    /// Displacement of the core's farthest point since the last frame.
    [[nodiscard]] double way_to_m(const ProxyGoal& /*goal*/) const noexcept { return way_m_; }

    /// Output without force; in contact if an upper bound proves that the tool touches.
    [[nodiscard]] ToolOutput respond(const ProxyGoal& goal, std::span<const PlacedSurface> surfaces,
                                     double clear_m) const noexcept TACTUS_NONBLOCKING;

private:
    double radius_m_;
    ToolCore core_;
    Similarity place_; ///< Pose of the tool in the world.
    double way_m_{0.0};
};

} // namespace tactus
