// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/force/carried.hpp"
#include "rt_core/force/catch_up.hpp"
#include "rt_core/force/near_object.hpp"
#include "rt_core/force/smooth_normals.hpp"
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
/// penalty on a distance. Friction, viscosity, a texture (texture.hpp) and smooth normals
/// (smooth_normals.hpp) say where along the surface the proxy comes to rest, so all that they do is
/// stretch that spring. Without a certified
/// surface, and where objects leave no room, the proxy is frozen or squeezed and says so: SafeState
/// fades the force, which is along the last normal and never pulls. After a frame in which the
/// proxy had to wait for data the force catches up by kCatchUp_n_per_s, beside what the hand does.
///
/// A fast hand asks for more triangles than fit in a list. The proxy goes as far as those that are
/// listed prove, then on from there with another list of the same frame, kListsPerFrame at most.
///
/// What it looks at is bounded by Budgets::planes. Where they are used up it stays, `under_way`,
/// and goes on in the next frame.
///
/// A tool without a radius is a ball of kPointSkin quanta.
///
/// Haptic thread. Cost: a list of the triangles in reach once a frame as a rule, 2 to 6 steps and
/// kProxySteps at most, each of a few passes over the list.
class Proxy
{
public:
    static constexpr std::uint32_t kListsPerFrame = 4;

    Proxy() noexcept = default;
    explicit Proxy(ToolSpec spec) noexcept TACTUS_NONBLOCKING;

    /// The proxy begins at the first goal; later ones it goes to when it responds.
    void see(const ToolGoal& goal) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] const Vec3& position_m() const noexcept { return position_; }
    /// Where the tool lies in the world: at the proxy, turned as the hand has it.
    [[nodiscard]] Similarity place() const noexcept { return {rotation_, position_, 1.0}; }
    /// The tool's, or a point's skin.
    [[nodiscard]] double radius_m() const noexcept { return radius_; }
    /// How far beyond its radius it looks for what it may feel.
    [[nodiscard]] double feels_beyond_m() const noexcept
    {
        return spec_.smooth_m > 0.0 ? SmoothNormals::reach_beyond_m(radius_, spec_.smooth_m) : 0.0;
    }
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
    /// everything else it is at least `clear_m` away there. `planes` are what is left of
    /// Budgets::planes: with none left it stays where it has come to, and feels what touches there.
    [[nodiscard]] ToolOutput
    respond(const ToolGoal& goal, std::span<const PlacedSurface> surfaces, double clear_m,
            std::uint32_t planes = Vicinity::kUnlimited) noexcept TACTUS_NONBLOCKING;
    /// Of them, after respond().
    [[nodiscard]] std::uint32_t planes_left() const noexcept { return planes_left_; }
    /// It came to the end of a list that room or budget had cut short: from where it is now, with
    /// surfaces that are asked for there, it would go on.
    [[nodiscard]] bool goes_on() const noexcept { return goes_on_; }
    /// How far it came by the last respond(), at most.
    [[nodiscard]] double went_m() const noexcept { return (position_ - anchor_).norm(); }
    /// The next respond() is of the same frame; its force takes the place of the last one's.
    /// Where it is frozen it changes nothing.
    void go_on() noexcept { is_on_ = true; }

private:
    enum class Motion : std::uint8_t
    {
        at_rest,   ///< At the goal, or held by the surface.
        ran_out,   ///< More triangles are near than fit: those that don't may be here.
        held_back, ///< The certified ball ends here.
        out_of_steps,
        out_of_planes, ///< Nothing more may be looked at.
        squeezed,      ///< No place near is free.
    };

    /// What the surfaces do at one place. Sums are over the planes that touch, each by how deep the
    /// goal is behind it.
    struct Hold
    {
        Vec3 motion{0.0, 0.0, 0.0}; ///< As far as planes and friction let it go.
        Vec3 push_n{0.0, 0.0, 0.0}; ///< Of the planes.
        Vec3 drag_n{0.0, 0.0, 0.0}; ///< Of friction.
        double depth_m{0.0};
        double stiffness{0.0}; ///< N/m x m, and so on.
        double static_m{0.0};
        double dynamic_m{0.0};
        double damping{0.0};
        double viscosity{0.0};
        Vec3 bump_m{0.0, 0.0, 0.0};   ///< What textures move the proxy along by.
        double stiffening{0.0};       ///< By textures and smooth normals, likewise a sum.
        Vec3 velocity{0.0, 0.0, 0.0}; ///< The objects'.
        double deepest_m{0.0};
        std::uint32_t object{kNoObject}; ///< Whose plane that is.
        bool touches{false};
        bool rubs{false};        ///< Something holds it back along the surface.
        bool has_texture{false}; ///< One that presses is bumpy.
        bool is_smooth{false};   ///< It is held as a hand is that is raised.
        bool is_squeezed{false};
    };

    struct Touch;

    [[nodiscard]] double find_radius(std::span<const PlacedSurface> surfaces) const noexcept;
    [[nodiscard]] double free_travel(std::span<const PlacedSurface> surfaces,
                                     double clear_m) const noexcept;
    [[nodiscard]] bool is_short_of(std::span<const PlacedSurface> surfaces,
                                   double travel) const noexcept;
    [[nodiscard]] bool is_worth_going_on(Motion motion,
                                         std::span<const PlacedSurface> surfaces) const noexcept;
    [[nodiscard]] Motion follow(const Vec3& goal, double travel,
                                std::span<const PlacedSurface> surfaces) noexcept;
    [[nodiscard]] Motion follow_among(Vicinity& near, std::span<const PlacedSurface> surfaces,
                                      const Vec3& goal, double travel) noexcept;
    void begin_frame() noexcept;
    void go_straight_on(const Vec3& goal, double clear) noexcept;
    [[nodiscard]] Hold hold_at(Vicinity& near, std::span<const PlacedSurface> surfaces,
                               const Vec3& wanted, double room) noexcept;
    [[nodiscard]] Touch feel_at(Vicinity& near, std::span<const PlacedSurface> surfaces,
                                const Vec3& wanted, double gap_m) noexcept;
    void press(Hold& hold, const PlacedSurface& placed, const Vec3& depth) const noexcept;
    [[nodiscard]] SmoothNormals::Felt hold_smoothly(Vicinity& near, Touch& touch,
                                                    const Vec3& pressed) const noexcept;
    static void press_smoothly(Hold& hold, const SmoothNormals::Felt& felt,
                               const Vec3& pressed) noexcept;
    void press_into_texture(Hold& hold, const PlacedSurface& placed, const Vec3& pressed,
                            double share) const noexcept;
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
    double clear_m_{kInfinity};              ///< There, of everything else.
    Vec3 normal_{0.0, 0.0, 1.0};             ///< Of the last contact.
    SmoothNormals normals_;                  ///< While the proxy moves.
    StaticVector<std::uint32_t, 3> held_by_; ///< The faces, at the last stand of this frame.
    Hold hold_;
    CatchUp catch_up_;
    CatchUp catch_up_before_; ///< As the frame found it, and
    bool has_waited_{false};  ///< the same of
    bool waits_{false};       ///< frozen, squeezed, held back or cut short in the last frame.
    bool is_on_{false};       ///< A further list of the same frame.
    bool goes_on_{false};
    std::uint32_t lists_{0}; ///< Of this frame, as are
    std::uint32_t steps_{0}; ///< these.
    std::uint32_t planes_left_{0};
    bool in_contact_{false};
    bool slides_{false};    ///< From the last frame on: the dynamic cone holds.
    bool has_slid_{false};  ///< In this frame.
    double rubbed_m_{0.0};  ///< How far it went in touch, in this frame,
    double elapsed_s_{0.0}; ///< and the frame's time.
    bool was_overrun_{false};
    bool is_crowded_{false};
    StaticVector<Vec3, kProxySteps + kListsPerFrame + 1> path_;
};

} // namespace tactus
