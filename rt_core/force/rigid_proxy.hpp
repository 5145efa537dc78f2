// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/force/carried.hpp"
#include "rt_core/force/catch_up.hpp"
#include "rt_core/force/free_motion.hpp"
#include "rt_core/force/placed_surface.hpp"
#include "rt_core/force/proxy_goal.hpp"
#include "rt_core/force/rigid_planes.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/frame_output.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus
{

/// Virtual proxy of a tool that is more than a point: position and rotation that surfaces allow,
/// coupled to the device's (god-object of six degrees of freedom: Ortega, Redon and Coquillart
/// 2007; virtual coupling: Colgate, Stanley and Brown 1995; friction: rigid_planes.hpp).
///
/// Each step moves towards the device pose. Surfaces near the proxy are planes that the step may
/// not cross, in the metric of the coupling's energy: |translation|^2 + |arm x rotation|^2. The
/// square of the arm is the angular stiffness over the stiffness; by default the arm is the radius
/// of the core's bounding sphere plus the tool's radius. The step is cut to the proven free share
/// (free_motion.hpp), so the core never crosses a surface. A tool slides within its radius; a tool
/// without one gets a skin of kLeastSkin of the core's bounding radius.
///
/// The force is the part of the device's motion that planes and friction hold back, times the lower
/// stiffness of tool and object; the torque likewise, about the device's position. So they never
/// pull, are zero without a holding plane, and a lagging proxy causes no drag. They are, at rest,
/// the stiffness x (proxy - device), and the angular stiffness x the rotation between them. An
/// object's damping acts across its surface in contact, its viscosity along it. Its texture is felt
/// at the middle of the core (texture.hpp), as the set of bearing contacts changes from frame to
/// frame.
///
/// A sticking proxy does not move by a bit. A moving object carries the proxy before the first step
/// if it holds the proxy or would pass over it (carried.hpp). So only motion of objects relative to
/// one another counts.
///
/// If the distance is not exact, the proxy moves no farther than its proven distance from every
/// surface, minus the radius. If that is 0 or less, the proxy is halted: the last planes still
/// resist pressure, and ForceFader fades their force. Afterwards force and torque catch up by
/// kCatchUpShare_per_s. The same limit, besides the device's motion, holds while the tool is
/// over-constrained and in the frame after that. A proxy without known surroundings follows the
/// device pose, without a force, until it is proven to be clear there. A proxy whose core an object
/// has crossed for kFadeTime_s does the same.
///
/// Haptic thread. Cost: 1 to 4 us with 8 to 32 contacts, with friction up to 10 us more.
class RigidProxy
{
public:
    using Planes = RigidPlanes;
    /// Largest number of steps in one frame, each with new queries of the surfaces. One is usual
    /// below 0.1 m/s.
    static constexpr std::uint32_t kStepsPerFrame = 4;

    /// `planes` is scratch memory, which proxies may share; it must outlive them.
    RigidProxy(const ToolSpec& spec, Planes& planes) noexcept TACTUS_NONBLOCKING;

    /// Distance that the tool keeps round its core.
    [[nodiscard]] double radius_m() const noexcept { return radius_m_; }
    /// Pose of the tool in the world.
    [[nodiscard]] const Similarity& place() const noexcept { return place_; }
    /// Bound on the displacement of the core's points from the proxy to the device pose.
    [[nodiscard]] double way_to_m(const ProxyGoal& goal) const noexcept TACTUS_NONBLOCKING;
    /// True if the planes of the last step allowed no motion, or an object may have passed over the
    /// proxy.
    [[nodiscard]] bool is_over_constrained() const noexcept { return is_over_constrained_; }
    /// True if the last step left out a possible contact for lack of capacity.
    [[nodiscard]] bool exceeds_capacity() const noexcept { return exceeds_capacity_; }
    /// True if friction held the proxy in the last step, or, for slides(), the proxy slid against
    /// friction.
    [[nodiscard]] bool sticks() const noexcept { return sticks_; }
    [[nodiscard]] bool slides() const noexcept { return slides_; }
    /// True if surfaces hold the proxy. False: it follows the device pose until it is proven to be
    /// clear there.
    [[nodiscard]] bool is_joined() const noexcept { return is_joined_; }
    /// Expected displacement of the proxy in a frame; infinite without contact. It is about twice
    /// the last one in contact, so that little of a surface is needed at rest.
    [[nodiscard]] double likely_way_m() const noexcept TACTUS_NONBLOCKING;
    /// True if the proxy would move on from its new place, with surfaces queried there.
    [[nodiscard]] bool goes_on() const noexcept { return goes_on_; }
    /// Bound on the displacement of the core's points in the last step.
    [[nodiscard]] double went_m() const noexcept { return went_m_; }

    /// Starts the proxy at the device pose; later goals take effect in respond().
    void see(const ProxyGoal& goal) noexcept TACTUS_NONBLOCKING;
    /// Carries the proxy along with moved objects. Once a frame, before the surfaces are queried.
    void carry(std::span<const NearObject> objects, double elapsed_s) noexcept TACTUS_NONBLOCKING;
    /// Forgets an object that was replaced or removed.
    void forget(std::uint32_t object) noexcept TACTUS_NONBLOCKING;

    /// Moves the proxy one step towards the device pose and returns the force. `surfaces` were
    /// queried at the proxy; the core is at least `clear_m` away from all others there.
    [[nodiscard]] ToolOutput respond(const ProxyGoal& goal, std::span<const PlacedSurface> surfaces,
                                     double clear_m) noexcept TACTUS_NONBLOCKING;
    /// Makes the next respond() a further step of the same frame; its force replaces the last one.
    void go_on() noexcept TACTUS_NONBLOCKING;

private:
    /// Contact that held the tool, kept until the tool slides away from it.
    struct Hold
    {
        std::uint32_t object{0};          ///< Number of the object in the scene.
        Vec3 on_tool_m{0.0, 0.0, 0.0};    ///< Contact point in the tool's frame.
        Vec3 on_surface_m{0.0, 0.0, 0.0}; ///< Contact point in the object's frame.
        Vec3 normal{0.0, 0.0, 0.0};       ///< Normal in the object's frame.
        bool is_face{false};
    };
    /// Push of the last step, for frames in which the proxy is halted.
    struct LastPush
    {
        Motion<6> normal{Motion<6>::Zero()};
        double stiffness_n_per_m{0.0};
    };
    /// Effect of textures on the spring, averaged over the pressing contacts.
    struct Bumps
    {
        Motion<6> aside{Motion<6>::Zero()}; ///< Offset of the goal that the proxy follows.
        /// Addition to the held motion; times K, the textures' force.
        Motion<6> held{Motion<6>::Zero()};
        double stiffness_n_per_m{0.0}; ///< Stiffness K of the pressing contacts.
        double stiffening{1.0};
        bool are_there{false};
    };
    /// State at the frame's beginning.
    struct Frame
    {
        CatchUp force;
        CatchUp torque;
        double halted_s{0.0};
        bool was_over_constrained{false};
    };

    [[nodiscard]] Similarity along(const NearObject& object) const noexcept;
    [[nodiscard]] bool is_overrun(const Similarity& target,
                                  std::span<const NearObject> objects) const noexcept;
    [[nodiscard]] double way_m(const Similarity& from, const Similarity& to) const noexcept;
    void keep_clearances(std::span<const PlacedSurface> surfaces, double clear_m) noexcept;
    [[nodiscard]] Motion<6> way_to(const ProxyGoal& goal) const noexcept;
    [[nodiscard]] RigidWay way_of(const Motion<6>& motion) const noexcept;
    void step(const ProxyGoal& goal, std::span<const PlacedSurface> surfaces,
              const FreeMotion& room, ToolOutput& output) noexcept;
    [[nodiscard]] double advance(const ProxyGoal& goal, const RigidMotion& found,
                                 const FreeMotion& room) noexcept;
    void freeze(const ProxyGoal& goal, bool is_crossed, ToolOutput& output) noexcept;
    void gather(const ProxyGoal& goal, std::span<const PlacedSurface> surfaces) noexcept;
    void add(std::uint32_t surface, std::span<const Contact> contacts, const PlacedSurface& placed,
             double elapsed_s) noexcept;
    void add(const RigidTouch& touch, const PlacedSurface& placed, double elapsed_s) noexcept;
    void add_holds(std::span<const PlacedSurface> surfaces, double elapsed_s) noexcept;
    void keep_holds(const RigidMotion& found, std::span<const PlacedSurface> surfaces) noexcept;
    void keep(const Hold& hold) noexcept;
    void catch_up(const ProxyGoal& goal, ToolOutput& output) noexcept;
    [[nodiscard]] Bumps bumps_of(const RigidMotion& held,
                                 std::span<const PlacedSurface> surfaces) const noexcept;
    void add_forces(const ProxyGoal& goal, const RigidMotion& found, const Bumps& bumps,
                    ToolOutput& output) noexcept;
    void damp(const ProxyGoal& goal, const RigidMotion& found, double reactions,
              ToolOutput& output) const noexcept;
    void clamp(ToolOutput& output) const noexcept;

    ToolSpec spec_;
    double radius_m_{0.0};
    double size_m_{1.0}; ///< Radius of the core's bounding sphere plus radius_m_.
    double arm_m_{1.0};
    Vec3 center_m_{0.0, 0.0, 0.0}; ///< Centre of the core's bounding sphere, in the tool's frame.
    double core_radius_m_{0.0};
    Similarity place_; ///< Pose of the tool in the world.
    bool is_joined_{false};
    bool is_over_constrained_{false};
    bool exceeds_capacity_{false};
    bool sticks_{false};
    bool slides_{false};
    bool goes_on_{false};
    bool is_on_{false}; ///< True if the next step is not the frame's first.
    /// True if the proxy was still before this step: only new contacts can move it.
    bool was_still_{false};
    double went_m_{0.0};
    Motion<6> gone_{Motion<6>::Zero()}; ///< Motion of the proxy in this frame so far.
    /// Object that pushed most in the last step; kNoObject: none.
    std::uint32_t held_by_{kNoObject};
    bool was_overrun_{false}; ///< State at the frame's beginning.
    /// Clearance after the last step from all objects without a surface.
    double clear_m_{kInfinity};
    /// Velocity at which objects carried the proxy at the frame's beginning.
    Vec3 carried_m_per_s_{0.0, 0.0, 0.0};
    /// Angular velocity at which objects carried the proxy.
    Vec3 carried_rad_per_s_{0.0, 0.0, 0.0};
    double halted_s_{0.0};
    CatchUp force_;
    CatchUp torque_;
    Frame frame_;
    StaticVector<LastPush, 6> last_pushes_;
    StaticVector<Hold, kMaxHolds> holds_;
    Planes* planes_;
};

} // namespace tactus
