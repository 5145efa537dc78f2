// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/force_limiter.hpp"
#include "rt_core/force/passivity_observer.hpp"
#include "rt_core/force/velocity_window.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/conditioned_force.hpp"
#include "rt_core/records/device_limits.hpp"

#include <cstdint>

namespace tactus
{

/// Fixed while the loop runs.
struct ConditionerSetup
{
    DeviceLimits device;   ///< In world coordinates, as DeviceInfo has them.
    double period_s{1e-3}; ///< Of the loop; above 0.
    /// How far from the device's position a surface may touch the tool: it damps turning by at most
    /// its damping x the square of this, which lowers the cap of the torque's stiffness. No more
    /// than half of the device's own is counted; beyond that the passivity controller acts. >= 0.
    double lever_max_m{0.0};
    bool controls_passivity{true}; ///< False: observes only.
    /// A device that is faster has jumped: its energy isn't observed.
    double speed_max_m_per_s{kDeviceSpeedMax_m_per_s};
};

/// What stands between the force that one tool's frame wants and its device. In this order:
///
///     usable?   a force or stiffness that is no number: zero
///     cap       a wall stiffer than the device may have at this rate: scaled down to the cap,
///     which
///               under a force rises by its own within kMaterialGlide_s when a damping goes
///     clamp     to the device's largest force
///     growth    at most slew x period a frame
///     damping   against the velocity, when the port has given away energy (PassivityObserver)
///     clamp     again
///
/// All but the damping only shorten the force. The damping is bounded by the device's
/// added_damping_max_n_s_per_m, acts only where there is a force, and never turns a push into a
/// pull. After a stall the force may grow by one period's step. A SafeState
/// brings the first force in.
/// docs/stability.md says what this is worth in figures.
///
/// Haptic thread, once a frame and tool: after Frame::run(), before the SafeState. Cost:
/// about a microsecond, most of it the velocity's.
class ForceConditioner
{
public:
    /// - `setup.device` is within the ranges of DeviceLimits (asserted).
    /// - `setup.period_s` > 0 (asserted).
    explicit ForceConditioner(const ConditionerSetup& setup) noexcept;

    /// The force to write now: the energy of the next period is its.
    [[nodiscard]] ConditionedForce condition(const ForceWish& wish) noexcept TACTUS_NONBLOCKING;

    /// The same in two steps, for what shares a gain with others: how much of the wish, 0 .. 1, cap
    /// and clamp leave; then the force of it, or of less.
    /// - finish() follows each begin(); `gain` in 0 .. 1.
    [[nodiscard]] double begin(const ForceWish& wish) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] ConditionedForce finish(double gain) noexcept TACTUS_NONBLOCKING;

    /// This went out in place of the force that condition() has just returned; finite. The next one
    /// grows from it, and what energy it makes beyond the spring's is forgiven.
    void follow(const Vec3& sent_n) noexcept TACTUS_NONBLOCKING;

    /// The stiffest wall that goes through unscaled, with the surface damping of the last wish.
    [[nodiscard]] double stiffness_cap_n_per_m() const noexcept { return cap_n_per_m_; }

private:
    void cap_for(const ForceWish& wish) noexcept;
    [[nodiscard]] bool observe(const ForceWish& wish) noexcept;
    [[nodiscard]] double limit(const ForceWish& wish, ConditionedForce& output) noexcept;
    void hold(const ForceWish& wish, const Vec3& wall_n, double stiffness_n_per_m) noexcept;
    [[nodiscard]] Vec3 damp(const Vec3& wall_n, ConditionedForce& output) const noexcept;

    ConditionerSetup setup_;
    double surface_damping_n_s_per_m_{0.0};
    double cap_step_n_per_m_; ///< By which a period may raise the cap under a force.
    double allowed_n_per_m_;  ///< The rule's, with that damping.
    double cap_n_per_m_;      ///< In force: that, or on its way up to it.
    VelocityWindow velocity_;
    SentForces sent_;
    PassivityObserver observer_;
    Vec3 wall_n_{0.0, 0.0, 0.0}; ///< The last force, without the damping.
    Vec3 position_m_{0.0, 0.0, 0.0};
    bool knows_position_{false};
    // From begin() to finish().
    ForceWish wish_;
    Vec3 wished_n_{0.0, 0.0, 0.0}; ///< Within the limits.
    double gain_{0.0};             ///< What begin() said.
    ConditionedForce output_;
};

/// Two of them for a device that turns: the law of the ways for the force, that of the angles for
/// the torque. What caps or clamps one of them shortens both by one gain, and garbage in one takes
/// both away, so that a wrench keeps its line of action; growth and damping are each one's own.
class WrenchConditioner
{
public:
    /// As ForceConditioner. A device that makes no torque gets none.
    explicit WrenchConditioner(const ConditionerSetup& setup) noexcept;

    [[nodiscard]] ConditionedWrench condition(const WrenchWish& wish) noexcept TACTUS_NONBLOCKING;

    /// As ForceConditioner::follow(); each for itself, where it was another.
    void follow(const Vec3& sent_n, const Vec3& sent_nm) noexcept TACTUS_NONBLOCKING;

private:
    ForceConditioner force_;
    ForceConditioner torque_;
    bool has_torque_;
    double lever_max_m_;
    double turning_damping_max_nm_s_per_rad_; ///< Of a surface's, that is counted.
    Vec3 last_n_{0.0, 0.0, 0.0};
    Vec3 last_nm_{0.0, 0.0, 0.0};
};

} // namespace tactus
