// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/force_pipeline.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/force/angular_stiffness.hpp"
#include "rt_core/force/stiffness_rule.hpp"
#include "rt_core/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

const Vec3 kZero(0.0, 0.0, 0.0);

constexpr ForceOff when(bool is_so, ForceOff cause) noexcept
{
    return is_so ? cause : ForceOff::none;
}

/// Component of `way` along `direction`; 0 if the direction is zero.
double along(const Vec3& way, const Vec3& direction) noexcept
{
    const double norm = direction.norm();
    return norm > 0.0 ? way.dot(direction) / norm : 0.0;
}

ChangeRule rule_of(const PipelineSetup& setup) noexcept
{
    ChangeRule rule = setup.change;
    rule.device_speed_max_m_per_s = setup.limits.speed_max_m_per_s;
    rule.arm_m = std::sqrt(setup.angular_share_m2);
    return rule;
}

} // namespace

PipelineSetup pipeline_setup(const ToolSpec& tool, const DeviceLimits& device, double period_s,
                             double speed_max_m_per_s) noexcept
{
    TACTUS_ASSERT(tool.stiffness_n_per_m > 0.0);
    const double angular_nm_per_rad = angular_stiffness_nm_per_rad(tool);
    PipelineSetup setup;
    setup.conditioner.device = device;
    setup.conditioner.period_s = period_s;
    setup.conditioner.lever_max_m = angular_lever_m(tool);
    setup.limits = {speed_max_m_per_s, device.force_max_n,
                    std::min(tool.stiffness_n_per_m, stiffness_limit(device, period_s)),
                    kDampingShare * device.damping_n_s_per_m, device.rotation.torque_max_nm};
    if (device.rotation.torque_max_nm > 0.0)
    {
        const DeviceLimits turning = rotational_limits_of(device);
        setup.limits.stiffness_nm_per_rad =
            std::min(angular_nm_per_rad, stiffness_limit(turning, period_s));
        setup.limits.damping_nm_s_per_rad = kDampingShare * turning.damping_n_s_per_m;
    }
    setup.limits.rotation_max_rad_per_s = kRotationMax_rad_per_s;
    setup.angular_share_m2 = angular_nm_per_rad / tool.stiffness_n_per_m;
    return setup;
}

ForcePipeline::ForcePipeline(const PipelineSetup& setup) noexcept
    : conditioner_(setup.conditioner)
    , force_fader_(setup.limits)
    , gravity_(setup.load, {setup.limits.force_max_n, setup.limits.torque_max_nm})
    , change_(rule_of(setup), setup.conditioner.device, setup.conditioner.period_s)
    , angular_share_m2_(setup.angular_share_m2)
{
}

const ToolForce& ForcePipeline::step(const ToolState& tool, const ToolOutput& output,
                                     const DeviceRecord& device, const ExternalForce& own,
                                     const PeriodContext& context) noexcept
{
    const SafetyState was = force_.state;
    const ForceOff was_off = force_.causes;
    update_period(tool, output, device, context);
    take_frame(tool, output);
    add_external(force_, own);
    const Vec3 commanded_n = force_.push.force_n;
    const Vec3 commanded_nm = force_.torque.force_n;

    conditioner_.condition(force_, period_);
    const Vec3 conditioned_n = force_.push.force_n;
    const Vec3 conditioned_nm = force_.torque.force_n;
    period_.causes |=
        when(has_action(force_.push.actions | force_.torque.actions, ForceAction::refused) ||
                 !std::isfinite(own.gripper_n),
             ForceOff::garbage);
    force_fader_.step(force_, period_);
    gripper_n_ = force_.causes == ForceOff::none ? own.gripper_n : gripper_n_;
    force_.gripper_n = force_fader_.gain() * gripper_n_;
    gravity_.carry(force_, period_);
    const bool is_ramp =
        force_.push.force_n != conditioned_n || force_.torque.force_n != conditioned_nm;
    if (change_.hold(force_, period_))
    {
        gravity_.make_room(force_);
        force_fader_.follow(force_);
    }
    conditioner_.follow(force_, is_ramp);
    change_.follow(force_, force_.push.force_n == commanded_n ? own.force_n : kZero,
                   force_.torque.force_n == commanded_nm ? own.torque_nm : kZero);
    force_.has_changed = force_.state != was || force_.causes != was_off;
    return force_;
}

const ToolForce& ForcePipeline::fade(double elapsed_s, ForceOff cause) noexcept
{
    period_.elapsed_s = elapsed_s;
    period_.force_left = 1.0;
    force_fader_.fade(force_, elapsed_s, cause);
    force_.gripper_n = force_fader_.gain() * gripper_n_;
    gravity_.carry(force_, period_);
    change_.follow(force_, kZero, kZero);
    return force_;
}

/// Collects the data of this period for the stages.
void ForcePipeline::update_period(const ToolState& tool, const ToolOutput& output,
                                  const DeviceRecord& device, const PeriodContext& context) noexcept
{
    const bool is_place = update_device(tool, device);
    period_.elapsed_s = context.elapsed_s;
    period_.elapsed_periods = std::max(tool.elapsed_periods, 1U);
    period_.surface_damping_n_s_per_m = context.surface_damping_n_s_per_m;
    period_.force_left = context.force_left;
    period_.causes = context.causes | when(!device.connected, ForceOff::disconnect) |
                     when(!device.deadman_held, ForceOff::deadman) |
                     when(tool.valid && !is_place, ForceOff::garbage);
    period_.faults = faults_of(output);
    period_.is_touching = output.in_contact;
    period_.object_way_m = output.object_way_m;
    period_.object_rotation_rad = output.object_rotation_rad;
    period_.carried_m = output.carried_m;
    period_.carried_rad = output.carried_rad;
}

/// Reads the device's data; true if its pose is valid. An invalid pose does not change the
/// rotation.
bool ForcePipeline::update_device(const ToolState& tool, const DeviceRecord& device) noexcept
{
    const DevicePose pose = device.pose.value_or(DevicePose{tool.position_m, tool.rotation});
    period_.device_m = pose.position_m;
    const bool is_place =
        pose.position_m.allFinite() && is_rotation(pose.rotation, kRotationTolerance);
    if (tool.valid && is_place && pose.rotation != period_.device_rotation)
    {
        period_.turned_rad +=
            rotation_vector(orthonormalised(pose.rotation * period_.device_rotation.transpose()));
        period_.device_rotation = pose.rotation;
    }
    period_.has_velocity = device.velocity_m_per_s.has_value();
    period_.velocity_m_per_s = device.velocity_m_per_s.value_or(kZero);
    period_.has_rotation = device.angular_velocity_rad_per_s.has_value();
    period_.rotation_rad_per_s = device.angular_velocity_rad_per_s.value_or(kZero);
    period_.sample_time_ns = tool.sample_time_ns;
    return is_place;
}

void ForcePipeline::take_frame(const ToolState& tool, const ToolOutput& output) noexcept
{
    const Vec3 stretch = output.proxy_m - tool.position_m;
    const Vec3 twist =
        angular_share_m2_ > 0.0 && is_rotation(output.proxy_rotation, kRotationTolerance) &&
                is_rotation(tool.rotation, kRotationTolerance)
            ? rotation_vector(orthonormalised(output.proxy_rotation * tool.rotation.transpose()))
            : kZero;
    period_.stretch_m = stretch.norm();
    period_.twist_rad = twist.norm();
    force_.push = {output.force_n, output.stiffness_n_per_m, along(stretch, output.force_n)};
    force_.torque = {output.torque_nm, angular_share_m2_ * output.stiffness_n_per_m,
                     along(twist, output.torque_nm)};
    force_.load_n = kZero;
    force_.load_nm = kZero;
    force_.twist_rad = output.in_contact ? period_.twist_rad : 0.0;
}

} // namespace tactus
