// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/vicinity.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <cstdint>
#include <span>
#include <utility>

namespace tactus
{

/// The virtual proxy of one spherical tool (Ruspini et al. 1997; god-object: Zilles and Salisbury
/// 1995), with one constraint at a time.
///
/// The proxy is the tool's centre as the surface lets it be. It stays at least the radius away from
/// every triangle. Each of its steps is shorter than its distance to the nearest triangle, so the
/// path of the centre can't cross the surface. It moves only where the surfaces are certified:
/// within (certified radius - tool radius), or (L - tool radius), of where they were
/// queried. The device's force is stiffness x (proxy - goal), clamped; never a penalty on a coarse
/// distance.
///
/// Without a certified surface the proxy is frozen: the force along the last normal never pulls
/// and fades to zero within kFadeTime_s.
///
/// Haptic thread. Cost: kProxySteps steps at most, each of up to 12 distance tests over the few
/// triangles in reach of the tool.
class Proxy
{
public:
    Proxy() noexcept = default;
    explicit Proxy(ToolSpec spec) noexcept : spec_(std::move(spec)) {}

    /// Where the proxy is; before the first frame the first goal.
    [[nodiscard]] const Vec3& position_m() const noexcept { return position_; }
    [[nodiscard]] bool is_in_contact() const noexcept { return in_contact_; }
    void start_at(const Vec3& position_m) noexcept { position_ = position_m; }

    /// Moves towards `goal_m` and returns the force. `surfaces` were queried at position_m().
    [[nodiscard]] ToolOutput respond(const Vec3& goal_m, std::span<const PlacedSurface> surfaces,
                                     double elapsed_s) noexcept TACTUS_NONBLOCKING;

private:
    enum class Motion : std::uint8_t
    {
        at_rest,   ///< At the goal, or held by the surface.
        ran_out,   ///< The vicinity ends here; there may be more behind it.
        held_back, ///< The certified ball ends here.
        out_of_steps,
    };

    [[nodiscard]] double free_travel(std::span<const PlacedSurface> surfaces) const noexcept;
    [[nodiscard]] static double clearance(std::span<const PlacedSurface> surfaces) noexcept;
    void follow(const Vec3& goal, double travel, std::span<const PlacedSurface> surfaces) noexcept;
    [[nodiscard]] Motion follow_within(const Vicinity& vicinity, const Vec3& goal, double travel,
                                       std::uint32_t& steps) noexcept;
    [[nodiscard]] bool try_slide(const Vec3& step, double clearance, const Vec3& goal,
                                 const Vicinity& vicinity) noexcept;
    [[nodiscard]] Vec3 force_towards(const Vec3& goal) const noexcept;
    [[nodiscard]] Vec3 fading_force(const Vec3& goal) const noexcept;
    [[nodiscard]] Vec3 clamped(const Vec3& force) const noexcept;

    ToolSpec spec_;
    Vec3 position_{0.0, 0.0, 0.0};
    Vec3 anchor_{0.0, 0.0, 0.0}; ///< Where this frame's surfaces were queried.
    Vec3 normal_{0.0, 0.0, 0.0}; ///< Of the last contact.
    double frozen_s_{0.0};
    bool in_contact_{false};
    bool held_back_{false}; ///< The certified ball ended the motion, not the surface.
};

} // namespace tactus
