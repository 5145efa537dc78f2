// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/tool_port.hpp"

#include "platform/devices/device_force.hpp"
#include "rt_core/force/angular_stiffness.hpp"
#include "rt_core/limits.hpp"

namespace tactus::hrtc
{

namespace
{

PipelineSetup pipeline_of(const ToolSetup& setup) noexcept
{
    PipelineSetup pipeline{setup.conditioner, setup.limits, setup.load, setup.change, 0.0};
    pipeline.conditioner.lever_max_m = angular_lever_m(setup.spec);
    pipeline.angular_share_m2 =
        angular_stiffness_nm_per_rad(setup.spec) / setup.spec.stiffness_n_per_m;
    return pipeline;
}

constexpr Quaternion kUnturned{0.0, 0.0, 0.0, 1.0};

std::optional<Vec3> vector(const std::optional<std::array<double, 3>>& v) noexcept
{
    return v ? std::optional(to_vec3(*v)) : std::nullopt;
}

} // namespace

ToolPort::ToolPort(const ToolSetup& setup) noexcept
    : device_(*setup.device)
    , clutch_(setup.clutch_button)
    , pipeline_(pipeline_of(setup))
    , external_source_(setup.external_force)
{
}

const ToolState& ToolPort::read(std::uint32_t periods) noexcept
{
    sample_ = device_.read();
    const bool is_turn_known =
        sample_.rotation_world || !device_.info().limits.rotation.is_measured;
    const Quaternion rotation = sample_.rotation_world.value_or(kUnturned);
    const bool is_rotation_sound = is_unit(rotation, kRotationTolerance);
    pose_.position_m = to_vec3(sample_.position_world_m);
    state_.sample_time_ns = sample_.time.ns;
    state_.elapsed_periods = periods;
    state_.valid = sample_.valid && sample_.connected && is_turn_known && is_rotation_sound;
    // Without a finite position, neither the device's pose nor its buttons are used.
    if (state_.valid && pose_.position_m.allFinite())
    {
        pose_.rotation = orthonormalised(to_rotation(rotation));
        const DevicePose tool = clutch_.tool_at(pose_, sample_.buttons);
        state_.position_m = tool.position_m;
        state_.rotation = tool.rotation;
    }
    else
    {
        state_.position_m = pose_.position_m;
    }
    record_sample();
    return state_;
}

/// Copies the sample's data that the ToolState lacks into record_.
void ToolPort::record_sample() noexcept
{
    record_.connected = sample_.connected;
    record_.deadman_held = sample_.deadman_held;
    record_.pose = clutch_.has_parted() ? std::optional(pose_) : std::nullopt;
    record_.velocity_m_per_s = vector(sample_.velocity_world_m_per_s);
    record_.angular_velocity_rad_per_s = vector(sample_.angular_velocity_world_rad_per_s);
    record_.buttons = sample_.buttons;
    record_.gripper_m = sample_.gripper_m;
    record_.measures_rotation = sample_.rotation_world.has_value();
}

const ToolForce& ToolPort::make_safe(const ToolOutput& output, PeriodContext context) noexcept
{
    context.causes |= clutch_.is_held() ? ForceOff::clutch : ForceOff::none;
    context.force_left = take_back();
    const ToolForce& force =
        pipeline_.step(state_, output, record_, external_force(output), context);
    record_.sent_n = force.push.force_n;
    record_.sent_nm = force.torque.force_n;
    record_.sent_gripper_n = force.gripper_n;
    return force;
}

ExternalForce ToolPort::external_force(const ToolOutput& output) noexcept
{
    return external_source_ != nullptr ? external_source_->next(sample_, state_, output)
                                       : ExternalForce{};
}

/// Returns the share of the last force that the device still renders: 1, or less after a brake by
/// another thread, or 0 if the device's own watchdog ended the force. Releases the brake.
double ToolPort::take_back() noexcept
{
    static_assert(to_seconds(kBrakeFade) == kFadeTime_s);
    const DeviceStatus status = device_.status();
    switch (status.state)
    {
    case DeviceState::brake:
        release_brake();
        return status.force_left;
    case DeviceState::idle:
        return pipeline_.gain() > 0.0 ? 0.0 : 1.0;
    case DeviceState::force:
        break;
    }
    return 1.0;
}

/// Releases the device's brake unless brake() was called. Another thread may call brake() between
/// check and release, so the flag is checked again.
void ToolPort::release_brake() noexcept
{
    if (is_braked_for_good_.load())
    {
        return;
    }
    device_.release_brake();
    if (is_braked_for_good_.load())
    {
        device_.brake();
    }
}

void ToolPort::brake() noexcept
{
    is_braked_for_good_.store(true);
    device_.brake();
}

void ToolPort::send(const ToolForce& force) noexcept
{
    device_.write({to_array(force.push.force_n + force.load_n),
                   to_array(force.torque.force_n + force.load_nm), force.gripper_n});
}

} // namespace tactus::hrtc
