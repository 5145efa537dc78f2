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

/// Limits of one tool's device for the ForceFader, which asserts that they are finite and not
/// negative.
struct SafetyLimits
{
    double speed_max_m_per_s{0.0}; ///< Device speed above which the device gets no force.
    double force_max_n{0.0};       ///< Largest norm of the force; above zero.
    double stiffness_n_per_m{0.0}; ///< Stiffness of the virtual wall.
    /// Damping added while a force fades out or in: see kDampingShare.
    double damping_n_s_per_m{0.0};
    double torque_max_nm{0.0};        ///< Largest norm of the torque; 0: the device has no torque.
    double stiffness_nm_per_rad{0.0}; ///< Stiffness of the rotational spring.
    double damping_nm_s_per_rad{0.0}; ///< Rotational damping, added likewise.
    double rotation_max_rad_per_s{0.0}; ///< Limit of the rotation speed; 0: none.
};

/// Stage that fades force and torque of one tool by a common gain, between the frame and the
/// device. Torques follow the same law as forces.
///
///     gain  1 |------.                                .------
///             |       \  kFadeTime_s     kRiseTime_s /
///           0 |        '-----------------------------'
///              force    brake      idle              force
///
/// While any cause is present, the gain falls with the true elapsed time and scales the last force
/// from before the cause: no force computed from bad data is sent. A halted or over-constrained
/// proxy still has good data, so the gain scales its present force, and a user who withdraws is
/// released at once.
///
/// Once all causes are gone the gain rises. The scaled force, the base, moves from that last force
/// to the frame's, by at most the device's largest force in kRiseTime_s. The base is the frame's
/// force at once while the gain is zero. From zero the gain rises only while the device can produce
/// the force of the spring between proxy and device.
///
/// Without the damping the force changes in a time dt by at most force_max x dt / kFadeTime_s in a
/// brake, and 2 x force_max x dt / kRiseTime_s afterwards. If the proxy was only held, the frame's
/// own change is added, which CatchUp bounds once data has arrived.
///
/// The device is in reset until its first good sample, and again if it is disconnected.
///
/// The damping works against the device's velocities while the gain is between 0 and 1, most at
/// 1/2. It is at most kDampingForceShare of the largest force or torque. A rising gain without a
/// force has no damping.
///
/// If a device has dropped the force or a part of it by itself, the gain is at once the remaining
/// share. Haptic thread; about 50 ns.
class ForceFader
{
public:
    /// Makes a fader without a device: all its forces are zero.
    ForceFader() noexcept = default;
    explicit ForceFader(const SafetyLimits& limits) noexcept;

    /// Scales force and torque to the ones to send, and sets state and causes. Once a frame, after
    /// the force is computed and before it is written.
    /// - `period.elapsed_s` >= 0 (asserted).
    void step(ToolForce& force, const ToolPeriod& period) noexcept TACTUS_NONBLOCKING;

    /// Fades the last force on, in place of step() if there is no frame.
    /// - `elapsed_s` >= 0; `cause` is not none (asserted).
    void fade(ToolForce& force, double elapsed_s, ForceOff cause) noexcept TACTUS_NONBLOCKING;

    /// Replaces the last result of step() by `sent`, which later stages made of it: at a cause,
    /// this force fades.
    void follow(const ToolForce& sent) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] SafetyState state() const noexcept { return state_; }
    /// Gain: share of the force that is sent, 0 .. 1.
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
    bool is_following_{false}; ///< True once force and torque have reached the frame's values.
    bool has_sample_{false};   ///< True if the device had a good sample since its connection.
    Vec3 position_m_{0.0, 0.0, 0.0}; ///< Position of the last new sample.
    std::int64_t sample_time_ns_{0};
    double since_sample_s_{0.0};
    Vec3 turned_rad_{0.0, 0.0, 0.0}; ///< Value of ToolPeriod::turned_rad at the last new sample.
    Vec3 velocity_m_per_s_{0.0, 0.0, 0.0};   ///< Zero if unknown.
    Vec3 rotation_rad_per_s_{0.0, 0.0, 0.0}; ///< Zero if unknown.
    bool is_too_fast_{false};
    /// True if the last result was a fading force from before a cause.
    bool is_fading_{false};
    Vec3 damping_n_{0.0, 0.0, 0.0};  ///< Damping force in the last result.
    Vec3 damping_nm_{0.0, 0.0, 0.0}; ///< Damping torque in the last result.
};

} // namespace tactus
