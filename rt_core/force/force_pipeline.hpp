// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/change_limit.hpp"
#include "rt_core/force/external_force.hpp"
#include "rt_core/force/force_conditioner.hpp"
#include "rt_core/force/force_fader.hpp"
#include "rt_core/force/gravity_compensation.hpp"
#include "rt_core/records/device_record.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

namespace tactus
{

/// Settings of a ForcePipeline, fixed while the loop runs.
struct PipelineSetup
{
    ConditionerSetup conditioner;
    SafetyLimits limits;
    ToolLoad load; ///< Payload; its weight must be at most the device's largest force.
    /// Limits of the change; the pipeline sets device_speed_max_m_per_s (from `limits`) and arm_m.
    ChangeRule change;
    /// Angular stiffness of the tool over its stiffness; 0 for a sphere, which has no rotation.
    double angular_share_m2{0.0};
};

/// Set-up for a device with this tool and loop period, without a payload. Above `speed_max_m_per_s`
/// the device gets no force. Tool stiffness above the device's limit is cut.
/// - `device` has no fault, `period_s` > 0, `tool.stiffness_n_per_m` > 0 (asserted).
[[nodiscard]] PipelineSetup pipeline_setup(const ToolSpec& tool, const DeviceLimits& device,
                                           double period_s,
                                           double speed_max_m_per_s) noexcept TACTUS_NONBLOCKING;

/// All stages of force between the frame of one tool and its device. The stages pass on one
/// ToolForce, made from a ToolOutput and converted to the device's command.
///
///     force of the frame    the proxy's spring, and the program's own (ExternalForce)
///     limits of the device  WrenchConditioner: cap, clamp
///     passivity             WrenchConditioner: damping of energy without a source
///     fade                  ForceFader: out by a cause, and back in
///     payload               GravityCompensation: the payload's force, in addition
///     change                ChangeLimit: no faster than device and objects move
///
/// After the last stage, the earlier stages receive its result. docs/safety.md has the laws.
///
/// Haptic thread, once a frame and tool, after Frame::run(). About 1.5 us; allocates nothing.
class ForcePipeline
{
public:
    /// - Each part of `setup` must be in the ranges that its stage asserts.
    explicit ForcePipeline(const PipelineSetup& setup) noexcept;

    /// Force to send in this period. `tool` and `output` are those of the period's frame. `device`
    /// has further data of the device; its sent forces are ignored. A value of it that is no number
    /// removes the force (ForceOff::garbage).
    const ToolForce& step(const ToolState& tool, const ToolOutput& output,
                          const DeviceRecord& device, const ExternalForce& own,
                          const PeriodContext& context) noexcept TACTUS_NONBLOCKING;

    /// Fades the last force on, in place of step() if there is no frame.
    /// - `elapsed_s` >= 0; `cause` is not none (asserted).
    const ToolForce& fade(double elapsed_s, ForceOff cause) noexcept TACTUS_NONBLOCKING;

    /// Result of the last step() or fade().
    [[nodiscard]] const ToolForce& force() const noexcept { return force_; }
    /// Gain of the ForceFader: share of the force that is sent, 0 .. 1.
    [[nodiscard]] double gain() const noexcept { return force_fader_.gain(); }

private:
    void update_period(const ToolState& tool, const ToolOutput& output, const DeviceRecord& device,
                       const PeriodContext& context) noexcept;
    [[nodiscard]] bool update_device(const ToolState& tool, const DeviceRecord& device) noexcept;
    void take_frame(const ToolState& tool, const ToolOutput& output) noexcept;

    WrenchConditioner conditioner_;
    ForceFader force_fader_;
    GravityCompensation gravity_;
    ChangeLimit change_;
    double angular_share_m2_;
    ToolPeriod period_;
    ToolForce force_;
    double gripper_n_{0.0}; ///< Gripper force commanded in the last frame without a fault.
};

} // namespace tactus
