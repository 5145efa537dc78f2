// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/force/catch_up.hpp"
#include "rt_core/force/half_spaces.hpp"
#include "rt_core/force/placed_surface.hpp"
#include "rt_core/force/tool_goal.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/frame_output.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus
{

/// The virtual proxy of a tool that is more than a point: a place and a rotation that surfaces let
/// the tool have, coupled to the hand's (god-object of six degrees of freedom: Ortega, Redon and
/// Coquillart 2007; virtual coupling: Colgate, Stanley and Brown 1995).
///
/// Each frame the proxy makes one step towards the hand. What is near it are planes that the step
/// may not cross (half_spaces.hpp), in the metric of the coupling's energy: |translation|^2 +
/// |arm x rotation|^2, the arm being what the core's ball and the radius measure together. The step
/// is then cut so that no point of the core goes as far as the core is proven to be from every
/// surface, over the whole way: the core never crosses a surface, seen or not. The tool's radius is
/// what it has to slide with: a core without one keeps a skin, kLeastSkin of its own radius.
///
/// The force is what the planes hold back of the hand's motion, times the stiffness; the torque is
/// that of the rotation, times stiffness x arm^2. So they never pull, are zero where no plane
/// holds, and a proxy that lags behind the hand drags at nothing. At rest they are stiffness x
/// (proxy - hand).
///
/// Where the distance is not exact, the proxy moves no farther than it is proven to be from every
/// surface, less the radius. When that is nothing it is frozen and says so: the last planes hold
/// what pushes against them, and SafeState fades that; afterwards force and torque catch up by
/// kCatchUpShare_per_s. A proxy that nothing is known of yet, or whose core an object has crossed
/// for kFadeTime_s, is where the hand is, without a force, until it is proven to be clear there.
///
/// Haptic thread. Cost: 1 to 4 us with 8 to 32 contacts.
class RigidProxy
{
public:
    /// A plane of the step, and where it comes from; world frame.
    struct Touch
    {
        std::uint32_t surface{0}; ///< Of the step's.
        Vec3 on_tool_m{0.0, 0.0, 0.0};
        Vec3 on_surface_m{0.0, 0.0, 0.0};
        Vec3 normal{0.0, 0.0, 0.0};
    };
    /// The planes of one step: scratch, too large for a frame's stack. 9 KiB.
    struct Planes
    {
        StaticVector<HalfSpace<6>, kMaxHalfSpaces> spaces;
        StaticVector<Touch, kMaxHalfSpaces> touches;
    };

    /// `planes` may serve many proxies, one after the other, and outlives them.
    RigidProxy(const ToolSpec& spec, Planes& planes) noexcept TACTUS_NONBLOCKING;

    /// What the tool keeps round its core.
    [[nodiscard]] double radius_m() const noexcept { return radius_m_; }
    /// Where the tool lies in the world.
    [[nodiscard]] const Similarity& place() const noexcept { return place_; }
    /// How far a point of the tool may have to go from here to the hand, at most.
    [[nodiscard]] double way_to_m(const ToolGoal& goal) const noexcept TACTUS_NONBLOCKING;
    /// No motion was allowed by all planes in the last step.
    [[nodiscard]] bool is_squeezed() const noexcept { return is_squeezed_; }
    /// What may hold the tool was left out in the last step, for want of room.
    [[nodiscard]] bool is_crowded() const noexcept { return is_crowded_; }

    /// A proxy that is nowhere yet is at the hand; else nothing changes before it responds.
    void see(const ToolGoal& goal) noexcept TACTUS_NONBLOCKING;
    /// Objects that move push it in its next step.
    void carry(std::span<const NearObject> /*objects*/,
               double /*elapsed_s*/) noexcept TACTUS_NONBLOCKING
    {
    }
    /// The object is another from now on, or gone.
    void forget(std::uint32_t object) noexcept TACTUS_NONBLOCKING;

    /// One step towards the hand, and its force. `surfaces` were queried where the proxy is; from
    /// everything else its core is at least `clear_m` away there.
    [[nodiscard]] ToolOutput respond(const ToolGoal& goal, std::span<const PlacedSurface> surfaces,
                                     double clear_m) noexcept TACTUS_NONBLOCKING;

private:
    /// A place where the tool was held, kept while the tool has not slid away from it.
    struct Hold
    {
        std::uint32_t object{0};          ///< Its number in the scene.
        Vec3 on_tool_m{0.0, 0.0, 0.0};    ///< In the tool's frame.
        Vec3 on_surface_m{0.0, 0.0, 0.0}; ///< In the object's.
        Vec3 normal{0.0, 0.0, 0.0};       ///< In the object's.
    };
    /// How far the proxy may go, and what is known.
    struct Room
    {
        double free_m{0.0};
        bool is_clear{false};   ///< The core is proven to touch nothing.
        bool is_crossed{false}; ///< The core is known to touch something.
    };

    [[nodiscard]] Room find_room(std::span<const PlacedSurface> surfaces,
                                 double clear_m) const noexcept;
    [[nodiscard]] Motion<6> way_to(const ToolGoal& goal) const noexcept;
    [[nodiscard]] double length_of(const Motion<6>& motion) const noexcept;
    void step(const ToolGoal& goal, std::span<const PlacedSurface> surfaces, double free_m,
              ToolOutput& output) noexcept;
    void freeze(const ToolGoal& goal, bool is_crossed, ToolOutput& output) noexcept;
    void gather(std::span<const PlacedSurface> surfaces) noexcept;
    void add(const Touch& touch) noexcept;
    void replace(std::size_t plane, const HalfSpace<6>& space, const Touch& touch) noexcept;
    void add_holds(std::span<const PlacedSurface> surfaces) noexcept;
    [[nodiscard]] NearestMotion<6> find_motion(const Motion<6>& wanted) noexcept;
    void keep_holds(const NearestMotion<6>& nearest,
                    std::span<const PlacedSurface> surfaces) noexcept;
    void keep(const Hold& hold) noexcept;
    void catch_up(bool has_waited, double elapsed_s, ToolOutput& output) noexcept;
    void add_force(const Motion<6>& held_back, ToolOutput& output) const noexcept;

    ToolSpec spec_;
    double radius_m_{0.0};
    double arm_m_{1.0};
    Vec3 center_m_{0.0, 0.0, 0.0}; ///< Of the core's ball, in the tool's frame.
    double core_radius_m_{0.0};
    Similarity place_; ///< Of the tool in the world.
    bool is_joined_{false};
    bool is_squeezed_{false};
    bool is_crowded_{false};
    double frozen_s_{0.0};
    CatchUp force_;
    CatchUp torque_;
    StaticVector<Motion<6>, 6> last_normals_; ///< Of the planes that held last.
    StaticVector<Hold, kMaxHolds> holds_;
    Planes* planes_;
};

} // namespace tactus
