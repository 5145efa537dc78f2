// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/passivity_observer.hpp"
#include "rt_core/force/velocity_window.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/device_limits.hpp"
#include "rt_core/records/tool_force.hpp"
#include "rt_core/records/tool_period.hpp"

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

/// Where a device was when a force was wished for it; of a device that turns, in angles: its
/// position is how far it has turned about the world's axes, summed up.
struct DeviceStep
{
    Vec3 position_m{0.0, 0.0, 0.0};   ///< From this frame's sample.
    std::uint32_t elapsed_periods{1}; ///< Since the last step; more after a stall. 0 counts as 1.
    /// The largest surface damping of what the tool touches: it lowers the stiffness cap. Finite,
    /// >= 0.
    double surface_damping_n_s_per_m{0.0};
    /// How far the wall was moved since the last step, by those who move it: what the force does
    /// along that way isn't the wall's work.
    Vec3 carried_m{0.0, 0.0, 0.0};
};

/// Two stages between the force that one tool's frame wants and its device.
///
/// Limits of the device:
///
///     usable?   a force or stiffness that is no number: zero
///     cap       a wall stiffer than the device may have at this rate: scaled down to the cap,
///               which under a force moves by its own within kMaterialGlide_s when a damping comes
///               or goes
///     clamp     to the device's largest force
///
/// Passivity:
///
///     damping   against the velocity, when the port has given away energy (PassivityObserver)
///     clamp     again
///
/// The first only shortens the force. The damping is bounded by the device's
/// added_damping_max_n_s_per_m, acts only where there is a force, and never turns a push into a
/// pull. How fast the force may change is for a ChangeLimit behind it, and a SafeState brings the
/// first force in. docs/stability.md says what this is worth in figures.
///
/// Haptic thread, once a frame and tool: after Frame::run(), before the SafeState. Cost:
/// about a microsecond, most of it the velocity's.
class ForceConditioner
{
public:
    /// - `setup.device` is within the ranges of DeviceLimits (asserted).
    /// - `setup.period_s` > 0 (asserted).
    explicit ForceConditioner(const ConditionerSetup& setup) noexcept;

    /// From the force that is wished for to the one to write now: the energy of the next period is
    /// its.
    void condition(SpringForce& force, const DeviceStep& device) noexcept TACTUS_NONBLOCKING
    {
        finish(force, begin(force, device));
    }

    /// The same in two steps, for what shares a gain with others: how much of the wish, 0 .. 1, cap
    /// and clamp leave; then the force of it, or of less.
    /// - finish() follows each begin(), with the same force; `gain` in 0 .. 1.
    [[nodiscard]] double begin(SpringForce& force,
                               const DeviceStep& device) noexcept TACTUS_NONBLOCKING;
    void finish(SpringForce& force, double gain) noexcept TACTUS_NONBLOCKING;

    /// `sent` went out in place of the force that condition() has just made; finite. `is_ramp`: a
    /// gain brought it in, and what energy that makes beyond the spring's is forgiven. Else it
    /// counts as any other.
    void follow(const SpringForce& sent, bool is_ramp) noexcept TACTUS_NONBLOCKING;

    /// The stiffest wall that goes through unscaled, with the surface damping of the last step.
    [[nodiscard]] double stiffness_cap_n_per_m() const noexcept { return cap_n_per_m_; }

private:
    void cap_for(const SpringForce& force, double surface_damping_n_s_per_m) noexcept;
    [[nodiscard]] bool observe(const DeviceStep& device) noexcept;
    [[nodiscard]] double limit(SpringForce& force) const noexcept;
    void hold(const SpringForce& force, bool is_again) noexcept;
    void damp(SpringForce& force) const noexcept;

    ConditionerSetup setup_;
    double surface_damping_n_s_per_m_{0.0};
    double cap_step_n_per_m_; ///< By which a period may move the cap under a force.
    double allowed_n_per_m_;  ///< The rule's, with that damping.
    double cap_n_per_m_;      ///< In force: that, or on its way there.
    VelocityWindow velocity_;
    SentForces sent_;
    PassivityObserver observer_;
    Vec3 position_m_{0.0, 0.0, 0.0};
    bool knows_position_{false};
    double gain_{0.0}; ///< What begin() said, for finish().
};

/// Two of them for a device that turns: the law of the ways for the force, that of the angles for
/// the torque. What caps or clamps one of them shortens both by one gain, and garbage in one takes
/// both away, so that a wrench keeps its line of action; damping is each one's own.
class WrenchConditioner
{
public:
    /// As ForceConditioner. A device that makes no torque gets none.
    explicit WrenchConditioner(const ConditionerSetup& setup) noexcept;

    /// Of `force` its push and turn; of `period` what the device did and what was carried.
    void condition(ToolForce& force, const ToolPeriod& period) noexcept TACTUS_NONBLOCKING;

    /// As ForceConditioner::follow(); each for itself, where it was another.
    void follow(const ToolForce& sent, bool is_ramp) noexcept TACTUS_NONBLOCKING;

private:
    ForceConditioner push_;
    ForceConditioner turn_;
    bool has_torque_;
    double lever_max_m_;
    double turning_damping_max_nm_s_per_rad_; ///< Of a surface's, that is counted.
    Vec3 last_n_{0.0, 0.0, 0.0};
    Vec3 last_nm_{0.0, 0.0, 0.0};
};

} // namespace tactus
