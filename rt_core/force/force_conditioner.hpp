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

/// Settings of a ForceConditioner, fixed while the loop runs.
struct ConditionerSetup
{
    DeviceLimits device;   ///< Limits of the device in world coordinates, as in DeviceInfo.
    double period_s{1e-3}; ///< Period of the loop; above 0.
    /// Largest distance from the device's position at which a surface may touch the tool, >= 0. A
    /// surface damping times its square damps the rotation and lowers the limit of the angular
    /// stiffness. Surface damping counts up to kDampingShare of the device's own damping; the
    /// passivity controller acts beyond that.
    double lever_max_m{0.0};
    bool controls_passivity{true}; ///< False: the energy is only observed, without damping.
    /// Device speed above which a displacement counts as a jump: its energy is not observed.
    double speed_max_m_per_s{kDeviceSpeedMax_m_per_s};
};

/// State of a device for one commanded force. If the force is a torque, metres stand for radians:
/// the position is the sum of the device's rotations about the world's axes.
struct DeviceStep
{
    Vec3 position_m{0.0, 0.0, 0.0}; ///< Position of this frame's sample.
    /// Whole periods since the last step; above 1 after a stall. 0 counts as 1.
    std::uint32_t elapsed_periods{1};
    /// Largest surface damping of the touched objects, which lowers the stiffness limit. Finite, >=
    /// 0.
    double surface_damping_n_s_per_m{0.0};
    /// Displacement of the wall since the last step, by the movers of the object: the force's work
    /// along it does not count as the wall's.
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
/// The first stage only shortens the force. The damping acts only on a force above zero, is at most
/// the device's added_damping_max_n_s_per_m, and never turns a push into a pull. Later stages are
/// ForceFader, which fades the first force in, and ChangeLimit. docs/stability.md has the figures.
///
/// Haptic thread, once a frame and tool, between Frame::run() and ForceFader. About a microsecond,
/// most of it for the velocity.
class ForceConditioner
{
public:
    /// - `setup.device` is within the ranges of DeviceLimits (asserted).
    /// - `setup.period_s` > 0 (asserted).
    explicit ForceConditioner(const ConditionerSetup& setup) noexcept;

    /// Replaces the commanded force by the force to write now. The energy of the next period is
    /// attributed to the result.
    void condition(SpringForce& force, const DeviceStep& device) noexcept TACTUS_NONBLOCKING
    {
        finish(force, begin(force, device));
    }

    /// condition() in two steps, for springs that share a gain: begin() returns the share of the
    /// commanded force, 0 .. 1, that cap and clamp leave. finish() computes the force with that
    /// gain or less.
    /// - finish() follows each begin(), with the same force; `gain` in 0 .. 1.
    [[nodiscard]] double begin(SpringForce& force,
                               const DeviceStep& device) noexcept TACTUS_NONBLOCKING;
    void finish(SpringForce& force, double gain) noexcept TACTUS_NONBLOCKING;

    /// Replaces the last result of condition() by `sent`, the finite force that later stages made
    /// of it. `is_ramp`: a gain fades the force in, and observed energy is cleared. Otherwise
    /// energy counts as ever.
    void follow(const SpringForce& sent, bool is_ramp) noexcept TACTUS_NONBLOCKING;

    /// Stiffness above which a wall is scaled down, with the surface damping of the last step.
    [[nodiscard]] double stiffness_limit_n_per_m() const noexcept { return limit_n_per_m_; }

private:
    void limit_stiffness(const SpringForce& force, double surface_damping_n_s_per_m) noexcept;
    [[nodiscard]] bool observe(const DeviceStep& device) noexcept;
    [[nodiscard]] double limit(SpringForce& force) const noexcept;
    void hold(const SpringForce& force, bool is_again) noexcept;
    void damp(SpringForce& force) const noexcept;

    ConditionerSetup setup_;
    double surface_damping_n_s_per_m_{0.0};
    /// Largest change of limit_n_per_m_ per period under a force.
    double limit_step_n_per_m_;
    /// Stiffness limit of stiffness_rule.hpp with surface_damping_n_s_per_m_.
    double allowed_n_per_m_;
    double limit_n_per_m_; ///< Stiffness limit in use, which moves towards allowed_n_per_m_.
    VelocityWindow velocity_;
    SentForces sent_;
    PassivityObserver observer_;
    Vec3 position_m_{0.0, 0.0, 0.0};
    bool knows_position_{false};
    double gain_{0.0}; ///< Result of begin(), for finish().
};

/// Conditioners for force and torque, with the same law in lengths and in angles. If one of the two
/// is capped or clamped, both are shortened by one gain, and an invalid value in one removes both:
/// a wrench keeps its line of action. Each has its own damping.
class WrenchConditioner
{
public:
    /// Set-up for the force; that of the torque follows from it. A device without torque gets none.
    explicit WrenchConditioner(const ConditionerSetup& setup) noexcept;

    /// Conditions push and torque of `force`, with the motion of device and objects in `period`.
    void condition(ToolForce& force, const ToolPeriod& period) noexcept TACTUS_NONBLOCKING;

    /// ForceConditioner::follow() for force and torque, each only if a later stage changed it.
    void follow(const ToolForce& sent, bool is_ramp) noexcept TACTUS_NONBLOCKING;

private:
    ForceConditioner push_;
    ForceConditioner torque_;
    bool has_torque_;
    double lever_max_m_;
    /// Limit of the surface damping that counts for rotations.
    double rotational_damping_max_nm_s_per_rad_;
    Vec3 last_n_{0.0, 0.0, 0.0};
    Vec3 last_nm_{0.0, 0.0, 0.0};
};

} // namespace tactus
