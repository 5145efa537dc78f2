// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/tool_port.hpp"

#include "platform/device_force.hpp"
#include "rt_core/force/angular_stiffness.hpp"
#include "rt_core/limits.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::hrtc
{

namespace
{

[[nodiscard]] ForceOff when(bool is_so, ForceOff cause) noexcept
{
    return is_so ? cause : ForceOff::none;
}

ConditionerSetup with_lever(const ToolSetup& setup) noexcept
{
    ConditionerSetup conditioner = setup.conditioner;
    conditioner.lever_max_m = angular_lever_m(setup.spec);
    return conditioner;
}

constexpr Quaternion kUnturned{0.0, 0.0, 0.0, 1.0};

/// Its part in this direction; 0 when there is none.
double along(const Vec3& way, const Vec3& direction) noexcept
{
    const double norm = direction.norm();
    return norm > 0.0 ? way.dot(direction) / norm : 0.0;
}

} // namespace

ToolPort::ToolPort(const ToolSetup& setup) noexcept
    : device_(*setup.device)
    , clutch_(setup.clutch_button)
    , conditioner_(with_lever(setup))
    , safe_state_(setup.limits)
    , gravity_(setup.load, {setup.limits.force_max_n, setup.limits.torque_max_nm})
    , own_source_(setup.own_force)
    , angular_share_m2_(angular_stiffness_nm_per_rad(setup.spec) / setup.spec.stiffness_n_per_m)
{
}

const ToolState& ToolPort::read(std::uint32_t periods) noexcept
{
    sample_ = device_.read();
    const bool is_turn_known = sample_.rotation_world || !device_.info().limits.turn.is_measured;
    const Quaternion rotation = sample_.rotation_world.value_or(kUnturned);
    const bool is_rotation_sound = is_unit(rotation, kRotationTolerance);
    hand_.position_m = to_vec3(sample_.position_world_m);
    state_.sample_time_ns = sample_.time.ns;
    state_.elapsed_periods = periods;
    state_.valid = sample_.valid && sample_.connected && is_turn_known && is_rotation_sound;
    // Of a hand that isn't where it says nothing is taken, nor of its button.
    if (state_.valid && hand_.position_m.allFinite())
    {
        turn_hand(orthonormalised(to_rotation(rotation)));
        const HandPlace tool = clutch_.tool_at(hand_, sample_.buttons);
        state_.position_m = tool.position_m;
        state_.rotation = tool.rotation;
    }
    else
    {
        state_.position_m = hand_.position_m;
    }
    return state_;
}

void ToolPort::turn_hand(const Mat3& rotation) noexcept
{
    if (rotation != hand_.rotation)
    {
        turned_rad_ += rotation_vector(orthonormalised(rotation * hand_.rotation.transpose()));
        hand_.rotation = rotation;
    }
}

DeviceRecord ToolPort::record() const noexcept
{
    const auto vector = [](const std::optional<std::array<double, 3>>& v)
    { return v ? std::optional(to_vec3(*v)) : std::nullopt; };
    DeviceRecord record;
    record.connected = sample_.connected;
    record.deadman_held = sample_.deadman_held;
    record.hand = clutch_.has_parted() ? std::optional(hand_) : std::nullopt;
    record.velocity_m_per_s = vector(sample_.velocity_world_m_per_s);
    record.angular_velocity_rad_per_s = vector(sample_.angular_velocity_world_rad_per_s);
    record.buttons = sample_.buttons;
    record.gripper_m = sample_.gripper_m;
    record.measures_rotation = sample_.rotation_world.has_value();
    record.sent_n = force_.sent_n;
    record.sent_nm = force_.sent_nm;
    record.sent_gripper_n = force_.sent_gripper_n;
    return record;
}

SafetyOutput ToolPort::make_safe(const ToolOutput& output, const PeriodContext& context) noexcept
{
    const OwnForce own = own_force(output);
    const ConditionedWrench wrench =
        conditioner_.condition(with_own(wish_of(output, context.surface_damping_n_s_per_m), own));
    force_.own_n = own.force_n.norm();
    force_.conditioned = wrench.force;
    force_.turned = wrench.torque;
    const SafetyInput input = safety_input(output, context);
    const SafetyOutput safe = safe_state_.step(input);
    const LoadedWrench sent = carry(safe, context.elapsed_s, input.force_left);
    conditioner_.follow(sent.force_n, sent.torque_nm);
    gripper_n_ = safe.causes == ForceOff::none ? own.gripper_n : gripper_n_;
    force_.sent_gripper_n = safe_state_.gain() * gripper_n_;
    force_.sent_n = sent.force_n;
    force_.sent_nm = sent.torque_nm;
    force_.load_n = sent.load_n;
    force_.load_nm = sent.load_nm;
    force_.twist_rad = output.in_contact ? twist_of(output).norm() : 0.0;
    return safe;
}

/// A gripper's force that is no number takes the others with it.
OwnForce ToolPort::own_force(const ToolOutput& output) noexcept
{
    OwnForce own = own_source_ != nullptr ? own_source_->next(sample_, state_, output) : OwnForce{};
    if (!std::isfinite(own.gripper_n))
    {
        own.force_n.setConstant(own.gripper_n);
        own.gripper_n = 0.0;
    }
    return own;
}

WrenchWish ToolPort::wish_of(const ToolOutput& output,
                             double surface_damping_n_s_per_m) const noexcept
{
    const double stiffness_nm_per_rad = angular_share_m2_ * output.stiffness_n_per_m;
    return {{output.force_n, hand_.position_m, output.stiffness_n_per_m,
             along(output.proxy_m - state_.position_m, output.force_n), state_.elapsed_periods,
             surface_damping_n_s_per_m},
            {output.torque_nm, turned_rad_, stiffness_nm_per_rad,
             along(twist_of(output), output.torque_nm), state_.elapsed_periods}};
}

/// From the hand to the proxy, about the world's axes.
Vec3 ToolPort::twist_of(const ToolOutput& output) const noexcept
{
    return angular_share_m2_ > 0.0 && output.proxy_rotation.allFinite()
               ? rotation_vector(
                     orthonormalised(output.proxy_rotation * state_.rotation.transpose()))
               : Vec3(0.0, 0.0, 0.0);
}

SafetyInput ToolPort::safety_input(const ToolOutput& output, const PeriodContext& context) noexcept
{
    SafetyInput input;
    input.position_m = state_.position_m;
    if (const auto& velocity = sample_.velocity_world_m_per_s)
    {
        input.velocity_m_per_s = to_vec3(*velocity);
        input.has_velocity = true;
    }
    input.sample_time_ns = state_.sample_time_ns;
    input.elapsed_s = context.elapsed_s;
    input.elapsed_periods = std::max(state_.elapsed_periods, 1U);
    input.force_n = force_.conditioned.force_n;
    input.torque_nm = force_.turned.force_n;
    input.proxy_m = output.proxy_m;
    input.twist_rad = twist_of(output).norm();
    if (const auto& turning = sample_.angular_velocity_world_rad_per_s)
    {
        input.turning_rad_per_s = to_vec3(*turning);
        input.has_turning = true;
    }
    input.turned_rad = turned_rad_;
    input.faults = faults_of(output);
    input.causes = context.causes | own_causes();
    input.force_left = take_back();
    return input;
}

ForceOff ToolPort::own_causes() const noexcept
{
    const ForceAction actions = force_.conditioned.actions | force_.turned.actions;
    return when(has_action(actions, ForceAction::refused), ForceOff::garbage) |
           when(!sample_.connected, ForceOff::disconnect) |
           when(!sample_.deadman_held, ForceOff::deadman) |
           when(clutch_.is_held(), ForceOff::clutch);
}

/// Returns how much the device has left of the last force: less than all when somebody braked it,
/// nothing when its own watchdog ended the force.
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
        return safe_state_.gain() > 0.0 ? 0.0 : 1.0;
    case DeviceState::force:
        break;
    }
    return 1.0;
}

/// Another thread may call brake() between the look at the flag and the release, so it looks again.
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

/// A load hangs on the device: it turns with the hand, even where a clutch has parted the tool.
LoadedWrench ToolPort::carry(const SafetyOutput& safe, double elapsed_s, double force_left) noexcept
{
    return gravity_.carry({safe.force_n, safe.torque_nm, safe.causes, hand_.rotation,
                           safe.state != SafetyState::reset, force_left, elapsed_s});
}

void ToolPort::send(const LoadedWrench& wrench, double gripper_n) noexcept
{
    device_.write({to_array(wrench.force_n + wrench.load_n),
                   to_array(wrench.torque_nm + wrench.load_nm), gripper_n});
}

} // namespace tactus::hrtc
