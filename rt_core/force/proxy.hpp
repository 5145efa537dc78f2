// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/force/carried.hpp"
#include "rt_core/force/catch_up.hpp"
#include "rt_core/force/force_shading.hpp"
#include "rt_core/force/placed_surface.hpp"
#include "rt_core/force/proxy_goal.hpp"
#include "rt_core/force/vicinity.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <cstdint>
#include <span>
#include <utility>

namespace tactus
{

/// Virtual proxy of a tool whose core is a point (god-object: Zilles and Salisbury 1995; virtual
/// proxy: Ruspini, Kolarov and Khatib 1997; friction cone: Harwin and Melder 2002).
///
/// The proxy is the reachable place nearest to the goal at which the tool's sphere enters no
/// triangle, as far as friction permits. It moves in straight steps. Each step is the motion
/// nearest to the goal on the free side of one plane for each near triangle; up to three planes
/// hold it at once. The planes are computed again at the end of each step. So no step enters a
/// triangle, however fast or deep the goal is. Steps stay where the surfaces are certified: within
/// (certified radius - tool radius), or (L - tool radius), of the place of the query.
///
/// The force is that of the spring between goal and proxy, with the lower stiffness of tool and
/// object. Friction, viscosity, texture (texture.hpp) and force shading (force_shading.hpp) only
/// move the proxy's place of rest along the surface, which stretches that spring. Without a
/// certified surface the proxy is halted; if objects leave no free motion, it is over-constrained.
/// ForceFader then fades the force, which is along the last normal and never pulls. After a frame
/// in which the proxy waited for data, the force catches up by kCatchUp_n_per_s, besides the
/// device's motion.
///
/// A list may not hold all triangles in reach. The proxy then moves as far as the list proves, and
/// continues in the same frame with a new list, kListsPerFrame at most.
///
/// Budgets::planes bounds the checks. If they are used up, the proxy stops, reports `under_way`,
/// and continues in the next frame.
///
/// A tool without a radius counts as a sphere with a radius of kPointSkin quanta.
///
/// Haptic thread. Cost: usually one list of triangles per frame and 2 to 6 steps, kProxySteps at
/// most. Each step passes over the list a few times.
class Proxy
{
public:
    static constexpr std::uint32_t kListsPerFrame = 4;

    Proxy() noexcept = default;
    explicit Proxy(ToolSpec spec) noexcept TACTUS_NONBLOCKING;

    /// Starts the proxy at the first goal; later goals take effect in respond().
    void see(const ProxyGoal& goal) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] const Vec3& position_m() const noexcept { return position_; }
    /// Pose of the tool in the world: at the proxy, with the device's rotation.
    [[nodiscard]] Similarity place() const noexcept { return {rotation_, position_, 1.0}; }
    /// Radius of the tool, or the skin of a point.
    [[nodiscard]] double radius_m() const noexcept { return radius_; }
    /// Distance beyond the radius within which surfaces affect the force.
    [[nodiscard]] double feels_beyond_m() const noexcept
    {
        return spec_.shading_m > 0.0 ? ForceShading::reach_beyond_m(radius_, spec_.shading_m) : 0.0;
    }
    /// Distance from the proxy to the goal, in contact along the surface only.
    [[nodiscard]] double way_to_m(const ProxyGoal& goal) const noexcept TACTUS_NONBLOCKING;
    /// Corners of the proxy's path in this frame, which consists of straight lines; both ends are
    /// included.
    [[nodiscard]] std::span<const Vec3> path_m() const noexcept { return path_.view(); }
    [[nodiscard]] bool is_in_contact() const noexcept { return in_contact_; }
    /// True if more triangles touched in the last frame than planes fit: the force may lack some.
    [[nodiscard]] bool exceeds_capacity() const noexcept { return exceeds_capacity_; }

    /// Moves the proxy with the object that it touches, or else with one that would pass over it.
    /// If an object passes over it in each case, it is over-constrained. Once a frame, before the
    /// surfaces are queried.
    void carry(std::span<const NearObject> objects, double elapsed_s) noexcept TACTUS_NONBLOCKING;
    /// Forgets an object that was replaced or removed.
    void forget(std::uint32_t object) noexcept TACTUS_NONBLOCKING;

    /// Moves the proxy towards the goal and returns the force. `surfaces` were queried at
    /// position_m(); all others are at least `clear_m` away there. `planes` is the rest of
    /// Budgets::planes; with 0 the proxy stays, with the contacts there.
    [[nodiscard]] ToolOutput
    respond(const ProxyGoal& goal, std::span<const PlacedSurface> surfaces, double clear_m,
            std::uint32_t planes = Vicinity::kUnlimited) noexcept TACTUS_NONBLOCKING;
    /// Checks left of `planes` after respond().
    [[nodiscard]] std::uint32_t planes_left() const noexcept { return planes_left_; }
    /// True if the proxy reached the end of a list that capacity or budget truncated: with surfaces
    /// queried at its new place it would move on.
    [[nodiscard]] bool goes_on() const noexcept { return goes_on_; }
    /// Bound on the displacement of the proxy in the last respond().
    [[nodiscard]] double went_m() const noexcept { return (position_ - anchor_).norm(); }
    /// Makes the next respond() continue the same frame; its force replaces the last one. A halted
    /// continuation changes nothing.
    void go_on() noexcept { is_on_ = true; }

private:
    enum class Motion : std::uint8_t
    {
        at_rest, ///< The proxy is at the goal, or held by the surface.
        /// Unlisted triangles may be here, as more are near than fit.
        ran_out,
        data_limited, ///< The sphere in which the surface is certified ends here.
        out_of_steps,
        out_of_planes,    ///< No checks are left.
        over_constrained, ///< No place near the proxy is free of surfaces.
    };

    /// Effect of the surfaces at one place of the proxy. Sums are over the touching planes, each
    /// weighted by the depth of the goal behind it, in metres.
    struct Hold
    {
        Vec3 motion{0.0, 0.0, 0.0}; ///< Motion that planes and friction allow.
        Vec3 push_n{0.0, 0.0, 0.0}; ///< Force of the planes.
        Vec3 drag_n{0.0, 0.0, 0.0}; ///< Force of friction.
        double depth_m{0.0};
        /// Weighted sum of stiffnesses, N/m x m; damping and viscosity below likewise.
        double stiffness{0.0};
        double static_m{0.0};
        double dynamic_m{0.0};
        double damping{0.0};
        double viscosity{0.0};
        Vec3 bump_m{0.0, 0.0, 0.0}; ///< Displacement of the proxy by textures.
        double stiffening{0.0}; ///< Weighted sum of the stiffening by textures and force shading.
        Vec3 velocity{0.0, 0.0, 0.0}; ///< Weighted sum of the velocities of the objects.
        double deepest_m{0.0};
        std::uint32_t object{kNoObject}; ///< Object of the deepest plane.
        bool touches{false};
        bool rubs{false}; ///< True if friction, viscosity or a texture acts along the surface.
        bool has_texture{false}; ///< True if a pressing surface has a texture.
        bool is_smooth{false};   ///< True if force shading raised the goal.
        bool is_over_constrained{false};
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
    [[nodiscard]] ForceShading::Felt hold_smoothly(Vicinity& near, Touch& touch,
                                                   const Vec3& pressed) const noexcept;
    static void press_smoothly(Hold& hold, const ForceShading::Felt& felt,
                               const Vec3& pressed) noexcept;
    void press_into_texture(Hold& hold, const PlacedSurface& placed, const Vec3& pressed,
                            double share) const noexcept;
    [[nodiscard]] Vec3 go_to_contact(Vicinity& near, const Vec3& wanted,
                                     const Vec3& motion) const noexcept;
    [[nodiscard]] Vec3 rub(Hold& hold, const Vec3& slip) noexcept;
    void keep_clearances(std::span<const PlacedSurface> surfaces, const Vicinity* near) noexcept;
    [[nodiscard]] bool is_overrun(const Vec3& target,
                                  std::span<const NearObject> objects) const noexcept;
    [[nodiscard]] Vec3 force(const ProxyGoal& goal) const noexcept;
    [[nodiscard]] Vec3 caught_up(const ProxyGoal& goal) noexcept;
    [[nodiscard]] Vec3 held_force(const Vec3& goal) const noexcept;
    [[nodiscard]] Vec3 clamped(const Vec3& force) const noexcept;

    ToolSpec spec_;
    double radius_{0.0};
    Vec3 position_{0.0, 0.0, 0.0};
    Mat3 rotation_{Mat3::Identity()}; ///< Rotation of the goal.
    Vec3 anchor_{0.0, 0.0, 0.0};      ///< Place of the proxy at the last query.
    double clear_m_{kInfinity};       ///< Clearance at anchor_ from all objects without a surface.
    Vec3 normal_{0.0, 0.0, 1.0};      ///< Normal of the last contact.
    ForceShading normals_;            ///< Force shading of this frame; valid while the proxy moves.
    /// Faces that hold the proxy at its last stop in this frame.
    StaticVector<std::uint32_t, 3> held_by_;
    Hold hold_;
    CatchUp catch_up_;
    CatchUp catch_up_before_; ///< State of catch_up_ at the frame's beginning.
    bool has_waited_{false};  ///< Value of waits_ at the frame's beginning.
    /// True if the proxy was halted, over-constrained, data-limited or cut short in the last frame.
    bool waits_{false};
    bool is_on_{false}; ///< True if the next respond() continues the same frame.
    bool goes_on_{false};
    std::uint32_t lists_{0}; ///< Lists used in this frame.
    std::uint32_t steps_{0}; ///< Steps made in this frame.
    std::uint32_t planes_left_{0};
    bool in_contact_{false};
    bool slides_{false};    ///< True if the proxy slides, so that the dynamic cone holds.
    bool has_slid_{false};  ///< True if the proxy slid in this frame.
    double rubbed_m_{0.0};  ///< Displacement in contact in this frame.
    double elapsed_s_{0.0}; ///< Duration of the frame in seconds.
    bool was_overrun_{false};
    bool exceeds_capacity_{false};
    StaticVector<Vec3, kProxySteps + kListsPerFrame + 1> path_;
};

} // namespace tactus
