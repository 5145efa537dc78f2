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

/// Settings that are fixed while the loop runs.
struct ConditionerSetup
{
    DeviceLimits device;   ///< Limits in world coordinates, as in DeviceInfo.
    double period_s{1e-3}; ///< Period of the loop; above 0.
    /// Largest distance from the device's position at which a surface may touch the tool: it damps
    /// rotation by at most its damping x the square of this, which lowers the limit of the angular
    /// stiffness. No more than half of the device's own damping is counted; beyond that the
    /// passivity controller acts. >= 0.
    double lever_max_m{0.0};
    bool controls_passivity{true}; ///< False: observes only.
    /// Speed above which the device has jumped: its energy isn't observed.
    double speed_max_m_per_s{kDeviceSpeedMax_m_per_s};
};

/// State of a device for a commanded force. For torques in angles: the position is the device's
/// rotation about the world's axes, summed up.
struct DeviceStep
{
    Vec3 position_m{0.0, 0.0, 0.0}; ///< Position of this frame's sample.
    /// Whole periods since the last step; above 1 after a stall. 0 counts as 1.
    std::uint32_t elapsed_periods{1};
    /// Largest surface damping of the touched objects: it lowers the stiffness limit. Finite, >= 0.
    double surface_damping_n_s_per_m{0.0};
    /// Displacement of the wall since the last step by those who move it: the force's work along it
    /// isn't the wall's.
    Vec3 carried_m{0.0, 0.0, 0.0};
};

/// Two stages between the commanded force of one tool's frame and its device.
///
/// Limits of the device:
///
///     usable?   a force or stiffness that is no number: zero
///     cap       a wall stiffer than the device's limit at this rate: scaled down to the limit;
///               under a force the limit moves within kMaterialBlend_s if a damping appears or
///               disappears
///     clamp     to the device's largest force
///
/// Passivity:
///
///     damping   against the velocity, if the port has given away energy (PassivityObserver)
///     clamp     again
///
/// The first stage only shortens the force. The damping is bounded by the device's
/// added_damping_max_n_s_per_m, acts only on a force, and never turns a push into a pull. The rate
/// of change is limited by a ChangeLimit after this, and a ForceFader fades the first force in.
/// docs/stability.md has the figures.
///
/// Haptic thread, once a frame and tool: after Frame::run(), before the ForceFader. Cost: about a
/// microsecond, most of it the velocity's.
class ForceConditioner
{
public:
    /// - `setup.device` is within the ranges of DeviceLimits (asserted).
    /// - `setup.period_s` > 0 (asserted).
    explicit ForceConditioner(const ConditionerSetup& setup) noexcept;

    /// Replaces the commanded force by the one to write now, to which the energy of the next period
    /// belongs.
    void condition(SpringForce& force, const DeviceStep& device) noexcept TACTUS_NONBLOCKING
    {
        finish(force, begin(force, device));
    }

    /// The same in two steps, for springs that share a gain: begin() returns the share of the
    /// commanded force, 0 .. 1, that cap and clamp leave; finish() computes the force with that
    /// gain or less.
    /// - finish() follows each begin(), with the same force; `gain` in 0 .. 1.
    [[nodiscard]] double begin(SpringForce& force,
                               const DeviceStep& device) noexcept TACTUS_NONBLOCKING;
    void finish(SpringForce& force, double gain) noexcept TACTUS_NONBLOCKING;

    /// Continues from `sent`, which replaced the last result of condition(); finite. `is_ramp`: a
    /// gain fades the force in, and energy that this adds beyond the spring's is forgiven.
    /// Otherwise it counts as any other.
    void follow(const SpringForce& sent, bool is_ramp) noexcept TACTUS_NONBLOCKING;

    /// The stiffest wall that is not scaled, with the surface damping of the last step.
    [[nodiscard]] double stiffness_limit_n_per_m() const noexcept { return cap_n_per_m_; }

private:
    void cap_for(const SpringForce& force, double surface_damping_n_s_per_m) noexcept;
    [[nodiscard]] bool observe(const DeviceStep& device) noexcept;
    [[nodiscard]] double limit(SpringForce& force) const noexcept;
    void hold(const SpringForce& force, bool is_again) noexcept;
    void damp(SpringForce& force) const noexcept;

    ConditionerSetup setup_;
    double surface_damping_n_s_per_m_{0.0};
    /// Largest change of the limit per period under a force.
    double cap_step_n_per_m_;
    double allowed_n_per_m_; ///< Limit of the rule with that damping.
    double cap_n_per_m_;     ///< Limit in use, which moves towards that.
    VelocityWindow velocity_;
    SentForces sent_;
    PassivityObserver observer_;
    Vec3 position_m_{0.0, 0.0, 0.0};
    bool knows_position_{false};
    double gain_{0.0}; ///< Result of begin(), for finish().
};

/// A conditioner for the force and one for the torque, by the same law in lengths and in angles. If
/// one of them is capped or clamped, both are shortened by one gain. An invalid value in one
/// removes both. So a wrench keeps its line of action. Each has its own damping.
class WrenchConditioner
{
public:
    /// Same set-up as ForceConditioner. A device without torque gets none.
    explicit WrenchConditioner(const ConditionerSetup& setup) noexcept;

    /// Conditions the push and turn of `force` with the device's motion and the carried motion of
    /// `period`.
    void condition(ToolForce& force, const ToolPeriod& period) noexcept TACTUS_NONBLOCKING;

    /// Same as ForceConditioner::follow(), for each of both that was changed.
    void follow(const ToolForce& sent, bool is_ramp) noexcept TACTUS_NONBLOCKING;

private:
    ForceConditioner push_;
    ForceConditioner turn_;
    bool has_torque_;
    double lever_max_m_;
    double rotational_damping_max_nm_s_per_rad_; ///< Limit of the counted surface damping.
    Vec3 last_n_{0.0, 0.0, 0.0};
    Vec3 last_nm_{0.0, 0.0, 0.0};
};

} // namespace tactus
