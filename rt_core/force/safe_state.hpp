// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/safety.hpp"
#include "rt_core/records/tool_force.hpp"
#include "rt_core/records/tool_period.hpp"

#include <cstdint>

namespace tactus
{

/// What one tool's device allows; finite and not negative, which SafeState asserts.
struct SafetyLimits
{
    double speed_max_m_per_s{0.0};     ///< Faster hands get no force.
    double force_max_n{0.0};           ///< Norm; above zero.
    double stiffness_n_per_m{0.0};     ///< Of the virtual wall.
    double damping_n_s_per_m{0.0};     ///< Added while a force fades or comes back: see
                                       ///< kDampingShare.
    double torque_max_nm{0.0};         ///< Norm; 0: the device has no torque.
    double stiffness_nm_per_rad{0.0};  ///< Of the virtual wall against turning.
    double damping_nm_s_per_rad{0.0};  ///< As damping_n_s_per_m.
    double turning_max_rad_per_s{0.0}; ///< Hands that turn faster get none; 0: there is no limit.
};

/// Stands between the frame and one tool's device and decides how much of force and torque goes
/// out: the one law by which they fade. Torques go as forces do.
///
///     gain  1 |------.                                .------
///             |       \  kFadeTime_s     kRiseTime_s /
///           0 |        '-----------------------------'
///              force    brake      idle              force
///
/// While any cause is there the gain falls with the true elapsed time, from the frame on that finds
/// it, and scales the last force from before: nothing that is computed from bad data goes out. Only
/// a proxy that is frozen or squeezed still has good data: there the gain scales its present force,
/// so that a hand that draws back is let go at once. When
/// all causes are gone the gain rises, and what it scales moves from that last force to the frame's
/// no faster than the device's largest force in kRiseTime_s, until the gain is full and the frame's
/// force is caught up with; at a gain of zero, where nothing is felt, it is the frame's at once.
/// From zero the gain rises only once the spring between proxy and hand is within the device's
/// range. So, with dt the elapsed time and besides the damping, the force changes by at most
/// force_max x dt / kFadeTime_s in a brake and 2 x force_max x dt / kRiseTime_s on the way back,
/// whatever the frame's force does meanwhile. Where the proxy was only held, both bounds are those
/// of the gain: the frame's own change comes on top, and CatchUp bounds that when data has come.
///
/// The device is in reset until its first good sample, and again when it is gone.
///
/// The damping works against the hand's velocities while the gain is between 0 and 1, most at 1/2
/// and none at either end, by at most kDampingForceShare of the largest force or torque. Where
/// nothing was and nothing is felt there is none on the way back.
///
/// A device that has dropped the force by itself, or some of it, has no ramp left to make of that:
/// the gain is at once what is left. Haptic thread; some 50 ns.
class SafeState
{
public:
    /// Of no device: all forces are zero.
    SafeState() noexcept = default;
    explicit SafeState(const SafetyLimits& limits) noexcept;

    /// Once a frame, after the force is computed and before it is written: force and torque become
    /// what goes out, with state and causes.
    /// - `period.elapsed_s` >= 0 (asserted).
    void step(ToolForce& force, const ToolPeriod& period) noexcept TACTUS_NONBLOCKING;

    /// Instead of step() where there is no frame to go by: the last force fades on.
    /// - `elapsed_s` >= 0; `cause` is not none (asserted).
    void fade(ToolForce& force, double elapsed_s, ForceOff cause) noexcept TACTUS_NONBLOCKING;

    /// This went out in place of what step() has just let out: it is what fades if a cause comes.
    void follow(const ToolForce& sent) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] SafetyState state() const noexcept { return state_; }
    /// Share of the force that goes out, 0 .. 1.
    [[nodiscard]] double gain() const noexcept { return gain_; }

private:
    [[nodiscard]] ForceOff find_causes(const ToolForce& force,
                                       const ToolPeriod& period) const noexcept;
    void observe_speed(const ToolPeriod& period) noexcept;
    [[nodiscard]] bool is_too_fast() const noexcept;
    void move_gain(const ToolPeriod& period, ForceOff causes) noexcept;
    void catch_up(const ToolForce& force, double elapsed_s, bool was_off) noexcept;
    [[nodiscard]] bool may_begin(const ToolPeriod& period) const noexcept;
    void let_out(ToolForce& force, ForceOff causes) noexcept;
    [[nodiscard]] SafetyState next_state(ForceOff causes) const noexcept;

    SafetyLimits limits_;
    SafetyState state_{SafetyState::reset};
    double gain_{0.0};
    Vec3 base_n_{0.0, 0.0, 0.0}; ///< What the gain scales.
    Vec3 base_nm_{0.0, 0.0, 0.0};
    bool is_following_{false};       ///< Both are the frame's and no longer on their way there.
    bool has_sample_{false};         ///< Of this device, since it was connected.
    Vec3 position_m_{0.0, 0.0, 0.0}; ///< Of the last new sample.
    std::int64_t sample_time_ns_{0};
    double since_sample_s_{0.0};
    Vec3 turned_rad_{0.0, 0.0, 0.0};        ///< Likewise.
    Vec3 velocity_m_per_s_{0.0, 0.0, 0.0};  ///< Zero when it isn't known.
    Vec3 turning_rad_per_s_{0.0, 0.0, 0.0}; ///< Likewise.
    bool is_too_fast_{false};
    bool is_fading_{false};          ///< What the last frame let out, from before a cause.
    Vec3 damping_n_{0.0, 0.0, 0.0};  ///< Of what it let out.
    Vec3 damping_nm_{0.0, 0.0, 0.0}; ///< The torque's.
};

} // namespace tactus
