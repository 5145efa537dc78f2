// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/force/body_planes.hpp"
#include "rt_core/force/body_room.hpp"
#include "rt_core/force/carried.hpp"
#include "rt_core/force/catch_up.hpp"
#include "rt_core/force/near_object.hpp"
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
/// Coquillart 2007; virtual coupling: Colgate, Stanley and Brown 1995; friction: body_planes.hpp).
///
/// Each step goes towards the hand. What is near the proxy are planes that the step may not cross,
/// in the metric of the coupling's energy: |translation|^2 + |arm x rotation|^2. The square of the
/// arm is the angular stiffness over the stiffness; where none is set, the arm is what the core's
/// ball and the radius measure together. The step is then cut to what is proven free
/// (body_room.hpp): the core never crosses a surface, seen or not, in translation or rotation. The
/// tool's radius is what it has to slide with: a core without one keeps a skin, kLeastSkin of its
/// own radius.
///
/// The force is what planes and friction hold back of the hand's motion, each times the softer
/// stiffness of tool and object; the torque is theirs about the device's position. So they never
/// pull, are zero where no plane holds, and a proxy that lags behind the hand drags at nothing. At
/// rest they are the stiffness x (proxy - hand), and the angular stiffness x the turn between them.
/// An object's damping acts across its surface, where it is touched, its viscosity along it. Its
/// texture is felt where the middle of the core is (texture.hpp): which of its contacts bear
/// changes from frame to frame, and with them the energy of the bumps would.
///
/// Where it sticks, the proxy does not move by a bit. Before its first step in a frame the proxy
/// goes along with an object that moves, if that one holds it or would run over it (carried.hpp):
/// of what moves only that counts by which objects move to one another.
///
/// Where the distance is not exact, the proxy moves no farther than it is proven to be from every
/// surface, less the radius. When that is nothing it is frozen and says so: the last planes hold
/// what pushes against them, and SafeState fades that; afterwards force and torque catch up by
/// kCatchUpShare_per_s. So they do, beside what the hand does, while objects leave it no room and
/// in the frame after that: planes hold then what went free before. A proxy that nothing is known
/// of yet, or whose core an object has crossed for kFadeTime_s, is where the hand is, without a
/// force, until it is proven to be clear there.
///
/// Haptic thread. Cost: 1 to 4 us with 8 to 32 contacts, with friction up to 10 us more.
class RigidProxy
{
public:
    using Planes = BodyPlanes;
    /// Steps of one frame at most; each asks for the surfaces anew. One is usual below 0.1 m/s.
    static constexpr std::uint32_t kStepsPerFrame = 4;

    /// `planes` may serve many proxies, one after the other, and outlives them.
    RigidProxy(const ToolSpec& spec, Planes& planes) noexcept TACTUS_NONBLOCKING;

    /// What the tool keeps round its core.
    [[nodiscard]] double radius_m() const noexcept { return radius_m_; }
    /// Where the tool lies in the world.
    [[nodiscard]] const Similarity& place() const noexcept { return place_; }
    /// How far a point of the tool may have to go from here to the hand, at most.
    [[nodiscard]] double way_to_m(const ToolGoal& goal) const noexcept TACTUS_NONBLOCKING;
    /// No motion was allowed by all planes in the last step, or an object may have come over it.
    [[nodiscard]] bool is_squeezed() const noexcept { return is_squeezed_; }
    /// What may hold the tool was left out in the last step, for want of room.
    [[nodiscard]] bool is_crowded() const noexcept { return is_crowded_; }
    /// Friction holds it, or it slides against it.
    [[nodiscard]] bool sticks() const noexcept { return sticks_; }
    [[nodiscard]] bool slides() const noexcept { return slides_; }
    /// Surfaces hold it: it is not where the hand is until it is proven to be clear there.
    [[nodiscard]] bool is_joined() const noexcept { return is_joined_; }
    /// How far it may be expected to go in a frame. One that pushes goes twice as far as it went at
    /// most, so that it asks for little of a surface that it rests on.
    [[nodiscard]] double likely_way_m() const noexcept TACTUS_NONBLOCKING;
    /// From where it went to, with surfaces that are asked for there, it would go on.
    [[nodiscard]] bool goes_on() const noexcept { return goes_on_; }
    /// How far any point of the core has come in the last step, at most.
    [[nodiscard]] double went_m() const noexcept { return went_m_; }

    /// A proxy that is nowhere yet is at the hand; else nothing changes before it responds.
    void see(const ToolGoal& goal) noexcept TACTUS_NONBLOCKING;
    /// The objects move. Once a frame, before the surfaces are queried.
    void carry(std::span<const NearObject> objects, double elapsed_s) noexcept TACTUS_NONBLOCKING;
    /// The object is another from now on, or gone.
    void forget(std::uint32_t object) noexcept TACTUS_NONBLOCKING;

    /// One step towards the hand, and its force. `surfaces` were queried where the proxy is; from
    /// everything else its core is at least `clear_m` away there.
    [[nodiscard]] ToolOutput respond(const ToolGoal& goal, std::span<const PlacedSurface> surfaces,
                                     double clear_m) noexcept TACTUS_NONBLOCKING;
    /// The next respond() is one more step of the same frame, whose force takes the place of the
    /// last one's.
    void go_on() noexcept TACTUS_NONBLOCKING;

private:
    /// A place where the tool was held, kept while the tool has not slid away from it.
    struct Hold
    {
        std::uint32_t object{0};          ///< Its number in the scene.
        Vec3 on_tool_m{0.0, 0.0, 0.0};    ///< In the tool's frame.
        Vec3 on_surface_m{0.0, 0.0, 0.0}; ///< In the object's.
        Vec3 normal{0.0, 0.0, 0.0};       ///< In the object's.
        bool is_face{false};
    };
    /// What pushed last, while nothing new is known.
    struct LastPush
    {
        Motion<6> normal{Motion<6>::Zero()};
        double stiffness_n_per_m{0.0};
    };
    /// What textures do to the spring: shares of what presses.
    struct Bumps
    {
        Motion<6> aside{Motion<6>::Zero()}; ///< The hand is drawn along by it, for the proxy.
        Motion<6> held{Motion<6>::Zero()};  ///< Times K, what they add to what is held back.
        double stiffness_n_per_m{0.0};      ///< K
        double stiffening{1.0};
        bool are_there{false};
    };
    /// As they were when the frame began.
    struct Frame
    {
        CatchUp force;
        CatchUp torque;
        double frozen_s{0.0};
        bool was_squeezed{false};
    };

    [[nodiscard]] Similarity along(const NearObject& object) const noexcept;
    [[nodiscard]] bool is_overrun(const Similarity& target,
                                  std::span<const NearObject> objects) const noexcept;
    [[nodiscard]] double way_m(const Similarity& from, const Similarity& to) const noexcept;
    void keep_clearances(std::span<const PlacedSurface> surfaces, double clear_m) noexcept;
    [[nodiscard]] Motion<6> way_to(const ToolGoal& goal) const noexcept;
    [[nodiscard]] BodyWay way_of(const Motion<6>& motion) const noexcept;
    void step(const ToolGoal& goal, std::span<const PlacedSurface> surfaces, const BodyRoom& room,
              ToolOutput& output) noexcept;
    [[nodiscard]] double advance(const ToolGoal& goal, const BodyMotion& found,
                                 const BodyRoom& room) noexcept;
    void freeze(const ToolGoal& goal, bool is_crossed, ToolOutput& output) noexcept;
    void gather(const ToolGoal& goal, std::span<const PlacedSurface> surfaces) noexcept;
    void add(std::uint32_t surface, std::span<const Contact> contacts, const PlacedSurface& placed,
             double elapsed_s) noexcept;
    void add(const BodyTouch& touch, const PlacedSurface& placed, double elapsed_s) noexcept;
    void add_holds(std::span<const PlacedSurface> surfaces, double elapsed_s) noexcept;
    void keep_holds(const BodyMotion& found, std::span<const PlacedSurface> surfaces) noexcept;
    void keep(const Hold& hold) noexcept;
    void catch_up(const ToolGoal& goal, ToolOutput& output) noexcept;
    [[nodiscard]] Bumps bumps_of(const BodyMotion& held,
                                 std::span<const PlacedSurface> surfaces) const noexcept;
    void add_forces(const ToolGoal& goal, const BodyMotion& found, const Bumps& bumps,
                    ToolOutput& output) noexcept;
    void damp(const ToolGoal& goal, const BodyMotion& found, double reactions,
              ToolOutput& output) const noexcept;
    void clamp(ToolOutput& output) const noexcept;

    ToolSpec spec_;
    double radius_m_{0.0};
    double size_m_{1.0}; ///< Core and radius together.
    double arm_m_{1.0};
    Vec3 center_m_{0.0, 0.0, 0.0}; ///< Of the core's ball, in the tool's frame.
    double core_radius_m_{0.0};
    Similarity place_; ///< Of the tool in the world.
    bool is_joined_{false};
    bool is_squeezed_{false};
    bool is_crowded_{false};
    bool sticks_{false};
    bool slides_{false};
    bool goes_on_{false};
    bool is_on_{false};     ///< The step is not the frame's first.
    bool was_still_{false}; ///< Before this step, and so it rests but for what is new.
    double went_m_{0.0};
    Motion<6> gone_{Motion<6>::Zero()};     ///< In this frame.
    std::uint32_t held_by_{kNoObject};      ///< Which pushed most in the last step.
    bool was_overrun_{false};               ///< As the frame began.
    double clear_m_{kInfinity};             ///< Of what is no object here, after the last step.
    Vec3 carried_m_per_s_{0.0, 0.0, 0.0};   ///< It went along so as the frame began,
    Vec3 carried_rad_per_s_{0.0, 0.0, 0.0}; ///< and turned so.
    double frozen_s_{0.0};
    CatchUp force_;
    CatchUp torque_;
    Frame frame_;
    StaticVector<LastPush, 6> last_pushes_;
    StaticVector<Hold, kMaxHolds> holds_;
    Planes* planes_;
};

} // namespace tactus
