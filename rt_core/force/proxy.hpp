// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/force/catch_up.hpp"
#include "rt_core/force/near_object.hpp"
#include "rt_core/force/tool_goal.hpp"
#include "rt_core/force/vicinity.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <cstdint>
#include <span>
#include <utility>

namespace tactus
{

/// The virtual proxy of a tool whose core is a point (god-object: Zilles and Salisbury 1995;
/// virtual proxy: Ruspini, Kolarov and Khatib 1997; friction cone: Harwin and Melder 2002).
///
/// The proxy is the tool's centre as the surfaces let it be: the place nearest to the goal that can
/// be reached without entering a triangle, and where friction lets it get. It goes there in
/// straight steps. Each step is the nearest motion to the goal that stays on the free side of a
/// plane for every triangle near, so whatever holds it, up to three planes, does so at once; the
/// planes are found again where it ends. No step enters a triangle, however fast or deep the goal
/// is. Steps stay where the surfaces are certified: within (certified radius - tool radius), or
/// (L - tool radius), of where they were queried.
///
/// The force is the spring between goal and proxy, of the softer of tool and object; never a
/// penalty on a distance. Without a certified surface, and where objects leave no room, the proxy
/// is frozen or squeezed and says so: SafeState fades the force, which is along the last normal and
/// never pulls.
/// After a frame in which the proxy had to wait for data the force catches up by
/// kCatchUp_n_per_s, beside what the hand does.
///
/// A tool without a radius is a ball of kPointSkin quanta.
///
/// Haptic thread. Cost: a list of the triangles in reach once a frame, 2 to 6 steps as a rule and
/// kProxySteps at most, each of a few passes over the list.
class Proxy
{
public:
    Proxy() noexcept = default;
    explicit Proxy(ToolSpec spec) noexcept TACTUS_NONBLOCKING;

    /// The proxy begins at the first goal; later ones it goes to when it responds.
    void see(const ToolGoal& goal) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] const Vec3& position_m() const noexcept { return position_; }
    /// Where the tool lies in the world: at the proxy, turned as the hand has it.
    [[nodiscard]] Similarity place() const noexcept { return {rotation_, position_, 1.0}; }
    /// The tool's, or a point's skin.
    [[nodiscard]] double radius_m() const noexcept { return radius_; }
    /// How far it may have to go for this goal: what presses it against what it touches is no way.
    [[nodiscard]] double way_to_m(const ToolGoal& goal) const noexcept TACTUS_NONBLOCKING;
    /// The places that it went by in this frame, the first and the last included: straight lines.
    [[nodiscard]] std::span<const Vec3> path_m() const noexcept { return path_.view(); }
    [[nodiscard]] bool is_in_contact() const noexcept { return in_contact_; }
    /// More triangles touched in the last frame than planes fit: the force may lack some.
    [[nodiscard]] bool is_crowded() const noexcept { return is_crowded_; }

    /// The objects move. The proxy goes along with the one that it touches, or that would run over
    /// it; else it stays. Where one of them runs over it whatever it does, it is squeezed. Once a
    /// frame, before the surfaces are queried.
    void carry(std::span<const NearObject> objects, double elapsed_s) noexcept TACTUS_NONBLOCKING;
    /// The object is another from now on, or gone.
    void forget(std::uint32_t object) noexcept TACTUS_NONBLOCKING;

    /// Moves towards the goal and returns the force. `surfaces` were queried at position_m(); from
    /// everything else it is at least `clear_m` away there.
    [[nodiscard]] ToolOutput respond(const ToolGoal& goal, std::span<const PlacedSurface> surfaces,
                                     double clear_m) noexcept TACTUS_NONBLOCKING;

private:
    static constexpr std::uint32_t kNoObject = 0xFFFF'FFFFU;

    enum class Motion : std::uint8_t
    {
        at_rest,   ///< At the goal, or held by the surface.
        ran_out,   ///< More triangles are near than fit: those that don't may be here.
        held_back, ///< The certified ball ends here.
        out_of_steps,
        squeezed, ///< No place near is free.
    };

    /// What the surfaces do at one place. Sums are over the planes that touch, each by how deep the
    /// goal is behind it.
    struct Hold
    {
        Vec3 motion{0.0, 0.0, 0.0}; ///< As far as planes and friction let it go.
        Vec3 slip{0.0, 0.0, 0.0};   ///< As far as those planes let it go that touch.
        Vec3 push_n{0.0, 0.0, 0.0}; ///< Of the planes.
        Vec3 drag_n{0.0, 0.0, 0.0}; ///< Of friction.
        double depth_m{0.0};
        double stiffness{0.0}; ///< N/m x m, and so on.
        double static_m{0.0};
        double dynamic_m{0.0};
        double damping{0.0};
        Vec3 velocity{0.0, 0.0, 0.0}; ///< The objects'.
        double deepest_m{0.0};
        std::uint32_t object{kNoObject}; ///< Whose plane that is.
        bool touches{false};
        bool is_squeezed{false};
    };

    [[nodiscard]] double find_radius(std::span<const PlacedSurface> surfaces) const noexcept;
    [[nodiscard]] double free_travel(std::span<const PlacedSurface> surfaces,
                                     double clear_m) const noexcept;
    [[nodiscard]] bool is_short_of(std::span<const PlacedSurface> surfaces,
                                   double travel) const noexcept;
    [[nodiscard]] Motion follow(const Vec3& goal, double travel,
                                std::span<const PlacedSurface> surfaces) noexcept;
    [[nodiscard]] Motion follow_among(Vicinity& near, std::span<const PlacedSurface> surfaces,
                                      const Vec3& goal, double travel) noexcept;
    void go_straight_on(const Vec3& goal, double clear) noexcept;
    [[nodiscard]] Hold hold_at(Vicinity& near, std::span<const PlacedSurface> surfaces,
                               const Vec3& wanted, double gap_m) noexcept;
    void press(Hold& hold, const PlacedSurface& placed, const Vec3& depth) const noexcept;
    [[nodiscard]] Vec3 go_to_contact(Vicinity& near, const Vec3& wanted,
                                     const Vec3& motion) const noexcept;
    [[nodiscard]] Vec3 rub(Hold& hold, const Vec3& slip) noexcept;
    void keep_clearances(std::span<const PlacedSurface> surfaces, const Vicinity* near) noexcept;
    [[nodiscard]] bool is_overrun(const Vec3& target,
                                  std::span<const NearObject> objects) const noexcept;
    [[nodiscard]] Vec3 force(const ToolGoal& goal) const noexcept;
    [[nodiscard]] Vec3 caught_up(const ToolGoal& goal) noexcept;
    [[nodiscard]] Vec3 held_force(const Vec3& goal) const noexcept;
    [[nodiscard]] Vec3 clamped(const Vec3& force) const noexcept;

    ToolSpec spec_;
    double radius_{0.0};
    Vec3 position_{0.0, 0.0, 0.0};
    Mat3 rotation_{Mat3::Identity()};        ///< The goal's.
    Vec3 anchor_{0.0, 0.0, 0.0};             ///< Where this frame's surfaces were queried.
    Vec3 normal_{0.0, 0.0, 1.0};             ///< Of the last contact.
    StaticVector<std::uint32_t, 3> held_by_; ///< The faces, at the last stand of this frame.
    Hold hold_;
    CatchUp catch_up_;
    bool waits_{false}; ///< Frozen, squeezed or held back in the last frame.
    bool in_contact_{false};
    bool slides_{false};   ///< From the last frame on: the dynamic cone holds.
    bool has_slid_{false}; ///< In this frame.
    bool was_overrun_{false};
    bool is_crowded_{false};
    StaticVector<Vec3, kProxySteps + 2> path_;
};

} // namespace tactus
