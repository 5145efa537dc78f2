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

/// Settings that are fixed while the loop runs.
struct PipelineSetup
{
    ConditionerSetup conditioner;
    SafetyLimits limits;
    ToolLoad load; ///< Its weight is at most the device's largest force.
    /// The pipeline sets hand_speed_max_m_per_s (from `limits`) and arm_m itself.
    ChangeRule change;
    /// The tool's angular stiffness over its stiffness; 0: a sphere, without rotation.
    double angular_share_m2{0.0};
};

/// Set-up for a device with this tool at this period, without a payload. Above `speed_max_m_per_s`
/// the device gets no force. The part of the tool's stiffness above the device's limit is ignored.
/// - `device` has no fault, `period_s` > 0, `tool.stiffness_n_per_m` > 0 (asserted).
[[nodiscard]] PipelineSetup pipeline_setup(const ToolSpec& tool, const DeviceLimits& device,
                                           double period_s,
                                           double speed_max_m_per_s) noexcept TACTUS_NONBLOCKING;

/// All stages between the force of one tool's frame and its device. Only two other records carry
/// the force: ToolOutput before it, and the device's command after it.
///
///     force of the frame    the proxy's spring, and the program's own (ExternalForce)
///     limits of the device  WrenchConditioner: cap, clamp
///     passivity             WrenchConditioner: damping of energy without a source
///     fade                  ForceFader: out by a cause, and back in
///     payload               GravityCompensation: the payload's force, in addition
///     change                ChangeLimit: no faster than device and objects move
///
/// The stages before the last one receive its result. docs/safety.md has the laws.
///
/// Haptic thread, once a frame and tool, after Frame::run(). About 1.5 us; allocates nothing.
class ForcePipeline
{
public:
    /// - Each part in the ranges that its stage asserts.
    explicit ForcePipeline(const PipelineSetup& setup) noexcept;

    /// Force to send now. `tool` and `output` are the frame's of this period; `device` has the
    /// device's other data, of which the sent forces are ignored. Any value of it that is no number
    /// removes the force (ForceOff::garbage).
    const ToolForce& step(const ToolState& tool, const ToolOutput& output,
                          const DeviceRecord& device, const ExternalForce& own,
                          const PeriodContext& context) noexcept TACTUS_NONBLOCKING;

    /// Replaces step() if there is no frame: the last force continues to fade.
    /// - `elapsed_s` >= 0; `cause` is not none (asserted).
    const ToolForce& fade(double elapsed_s, ForceOff cause) noexcept TACTUS_NONBLOCKING;

    /// Last result.
    [[nodiscard]] const ToolForce& force() const noexcept { return force_; }
    /// Share of the force that is sent, 0 .. 1.
    [[nodiscard]] double gain() const noexcept { return force_fader_.gain(); }

private:
    void look(const ToolState& tool, const ToolOutput& output, const DeviceRecord& device,
              const PeriodContext& context) noexcept;
    [[nodiscard]] bool look_at_device(const ToolState& tool, const DeviceRecord& device) noexcept;
    void take_frame(const ToolState& tool, const ToolOutput& output) noexcept;

    WrenchConditioner conditioner_;
    ForceFader force_fader_;
    GravityCompensation gravity_;
    ChangeLimit change_;
    double angular_share_m2_;
    ToolPeriod period_;
    ToolForce force_;
    double gripper_n_{0.0}; ///< Commanded in the last frame without a fault.
};

} // namespace tactus
