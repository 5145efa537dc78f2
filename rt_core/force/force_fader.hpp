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

/// Limits of one tool's device; finite and not negative, which ForceFader asserts.
struct SafetyLimits
{
    double speed_max_m_per_s{0.0};      ///< Above it the device gets no force.
    double force_max_n{0.0};            ///< Norm; above zero.
    double stiffness_n_per_m{0.0};      ///< Stiffness of the virtual wall.
    double damping_n_s_per_m{0.0};      ///< Added while a force fades out or in: see kDampingShare.
    double torque_max_nm{0.0};          ///< Norm; 0: the device has no torque.
    double stiffness_nm_per_rad{0.0};   ///< The same against rotation.
    double damping_nm_s_per_rad{0.0};   ///< The same against rotation.
    double rotation_max_rad_per_s{0.0}; ///< Limit of the rotation speed; 0: none.
};

/// Stage between the frame and one tool's device that scales force and torque: the one law by which
/// they fade. Torques follow the same law as forces.
///
///     gain  1 |------.                                .------
///             |       \  kFadeTime_s     kRiseTime_s /
///           0 |        '-----------------------------'
///              force    brake      idle              force
///
/// While any cause is present the gain falls with the true elapsed time, from the frame on that
/// finds it, and scales the last force from before: no force computed from bad data is sent. Only a
/// halted or over-constrained proxy still has good data. The gain then scales its present force, so
/// that a user who withdraws is released at once. Once all causes are gone the gain rises. Its base
/// then moves from that last force to the frame's, no faster than the device's largest force in
/// kRiseTime_s. This ends when the gain is full and the frame's force is reached. At a gain of
/// zero, where nothing is felt, the base is the frame's force at once. From zero the gain rises
/// only once the spring between proxy and device is within the device's range. So the force changes
/// by at most force_max x dt / kFadeTime_s in a brake and 2 x force_max x dt / kRiseTime_s
/// afterwards, with dt the elapsed time and without the damping. These bounds do not depend on the
/// frame's force meanwhile. If the proxy was only held, both bounds are those of the gain: the
/// frame's own change is added, and CatchUp bounds that once data has arrived.
///
/// The device is in reset until its first good sample, and again if it is disconnected.
///
/// The damping works against the device's velocities while the gain is between 0 and 1, most at 1/2
/// and none at either end. It is at most kDampingForceShare of the largest force or torque. If
/// there was no force and is none, a rising gain has no damping.
///
/// If a device has dropped the force by itself, or part of it, the gain is at once the remaining
/// share, without a ramp. Haptic thread; about 50 ns.
class ForceFader
{
public:
    /// State without a device: all forces are zero.
    ForceFader() noexcept = default;
    explicit ForceFader(const SafetyLimits& limits) noexcept;

    /// Scales force and torque to the ones to send, with state and causes; once a frame, after the
    /// force is computed and before it is written.
    /// - `period.elapsed_s` >= 0 (asserted).
    void step(ToolForce& force, const ToolPeriod& period) noexcept TACTUS_NONBLOCKING;

    /// Replaces step() if there is no frame: the last force continues to fade.
    /// - `elapsed_s` >= 0; `cause` is not none (asserted).
    void fade(ToolForce& force, double elapsed_s, ForceOff cause) noexcept TACTUS_NONBLOCKING;

    /// Continues from `sent`, which replaced the last result of step() and is the force that fades
    /// at a cause.
    void follow(const ToolForce& sent) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] SafetyState state() const noexcept { return state_; }
    /// Share of the force that is sent, 0 .. 1.
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
    Vec3 base_n_{0.0, 0.0, 0.0}; ///< Force that the gain scales.
    Vec3 base_nm_{0.0, 0.0, 0.0};
    bool is_following_{false};       ///< True once both have converged to the frame's values.
    bool has_sample_{false};         ///< This device had a sample since its connection.
    Vec3 position_m_{0.0, 0.0, 0.0}; ///< Position of the last new sample.
    std::int64_t sample_time_ns_{0};
    double since_sample_s_{0.0};
    Vec3 turned_rad_{0.0, 0.0, 0.0};         ///< Rotation of the last new sample.
    Vec3 velocity_m_per_s_{0.0, 0.0, 0.0};   ///< Zero if unknown.
    Vec3 rotation_rad_per_s_{0.0, 0.0, 0.0}; ///< Zero if unknown.
    bool is_too_fast_{false};
    /// The last frame's result was a force from before a cause.
    bool is_fading_{false};
    Vec3 damping_n_{0.0, 0.0, 0.0};  ///< Damping in the last result.
    Vec3 damping_nm_{0.0, 0.0, 0.0}; ///< Damping of the torque.
};

} // namespace tactus
