// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/change_limit.hpp"
#include "rt_core/force/force_conditioner.hpp"
#include "rt_core/force/gravity_compensation.hpp"
#include "rt_core/force/own_force.hpp"
#include "rt_core/force/safe_state.hpp"
#include "rt_core/records/device_record.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

namespace tactus
{

/// Fixed while the loop runs.
struct PipelineSetup
{
    ConditionerSetup conditioner;
    SafetyLimits limits;
    ToolLoad load; ///< Its weight no more than the device's largest force.
    /// Of it, the pipeline itself sets the hand's speed, which is `limits`', and the arm.
    ChangeRule change;
    /// The tool's angular stiffness over its stiffness; 0: a sphere, which nothing turns.
    double angular_share_m2{0.0};
};

/// What a device that is held by this tool allows at this period, with nothing hung on it. Hands
/// above `speed_max_m_per_s` get no force. What the tool's stiffness is beyond the device's cap
/// doesn't count.
/// - `device` has no fault, `period_s` > 0, `tool.stiffness_n_per_m` > 0 (asserted).
[[nodiscard]] PipelineSetup pipeline_setup(const ToolSpec& tool, const DeviceLimits& device,
                                           double period_s,
                                           double speed_max_m_per_s) noexcept TACTUS_NONBLOCKING;

/// Everything between the force of one tool's frame and its device, stage by stage. Only two other
/// records carry the force: ToolOutput before it and what the device is written behind it.
///
///     force of the frame    the proxy's spring, and the program's own (OwnForce)
///     limits of the device  WrenchConditioner: cap, clamp
///     passivity             WrenchConditioner: damping of energy from nowhere
///     fade                  SafeState: by a cause, and back
///     payload               GravityCompensation: what carries a load, beside the rest
///     change                ChangeLimit: no faster than hand and objects move
///
/// The stages before the last one are told what it let out. docs/safety.md has the laws.
///
/// Haptic thread, once a frame and tool, after Frame::run(). Some 1.5 us; allocates nothing.
class ForcePipeline
{
public:
    /// - Each part as its stage asserts.
    explicit ForcePipeline(const PipelineSetup& setup) noexcept;

    /// What to send now. `tool` and `output` are the frame's of this period. `device`: what else it
    /// said; what it was sent isn't looked at. Anything of it that is no number takes the force
    /// away (ForceOff::garbage).
    const ToolForce& step(const ToolState& tool, const ToolOutput& output,
                          const DeviceRecord& device, const OwnForce& own,
                          const PeriodContext& context) noexcept TACTUS_NONBLOCKING;

    /// Instead of step() where there is no frame to go by: the last force fades on.
    /// - `elapsed_s` >= 0; `cause` is not none (asserted).
    const ToolForce& fade(double elapsed_s, ForceOff cause) noexcept TACTUS_NONBLOCKING;

    /// The last one that was let out.
    [[nodiscard]] const ToolForce& force() const noexcept { return force_; }
    /// Share of the force that goes out, 0 .. 1.
    [[nodiscard]] double gain() const noexcept { return safe_state_.gain(); }

private:
    void look(const ToolState& tool, const ToolOutput& output, const DeviceRecord& device,
              const PeriodContext& context) noexcept;
    [[nodiscard]] bool look_at_device(const ToolState& tool, const DeviceRecord& device) noexcept;
    void take_frame(const ToolState& tool, const ToolOutput& output) noexcept;

    WrenchConditioner conditioner_;
    SafeState safe_state_;
    GravityCompensation gravity_;
    ChangeLimit change_;
    double angular_share_m2_;
    ToolPeriod period_;
    ToolForce force_;
    double gripper_n_{0.0}; ///< Wanted by the last frame in which nothing was wrong.
};

} // namespace tactus
