// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/tool_port.hpp"

#include <algorithm>

namespace tactus::hrtc
{

namespace
{

[[nodiscard]] ForceOff when(bool is_so, ForceOff cause) noexcept
{
    return is_so ? cause : ForceOff::none;
}

} // namespace

ToolPort::ToolPort(const ToolSetup& setup) noexcept
    : device_(*setup.device)
    , conditioner_(setup.conditioner)
    , safe_state_(setup.limits)
    , jump_(setup.limits)
{
}

const ToolState& ToolPort::read(std::uint32_t periods) noexcept
{
    sample_ = device_.read();
    const auto& position_m = sample_.position_world_m;
    state_.position_m = Vec3(position_m[0], position_m[1], position_m[2]);
    state_.sample_time_ns = sample_.time.ns;
    state_.elapsed_periods = periods;
    state_.valid = sample_.valid && sample_.connected;
    return state_;
}

SafetyOutput ToolPort::make_safe(const ToolOutput& output, const PeriodContext& context) noexcept
{
    force_.conditioned = conditioner_.condition(wish_of(output));
    const SafetyOutput safe = safe_state_.step(safety_input(output, context));
    if (safe.force_n != force_.conditioned.force_n)
    {
        conditioner_.follow(safe.force_n);
    }
    force_.sent_n = safe.force_n;
    jump_.remember(output);
    return safe;
}

ForceWish ToolPort::wish_of(const ToolOutput& output) const noexcept
{
    const double norm_n = output.force_n.norm();
    ForceWish wish{output.force_n, state_.position_m, output.stiffness_n_per_m, 0.0,
                   state_.elapsed_periods};
    if (norm_n > 0.0)
    {
        wish.stretch_m = (output.proxy_m - state_.position_m).dot(output.force_n) / norm_n;
    }
    return wish;
}

SafetyInput ToolPort::safety_input(const ToolOutput& output, const PeriodContext& context) noexcept
{
    SafetyInput input;
    input.position_m = state_.position_m;
    if (const auto& velocity = sample_.velocity_world_m_per_s)
    {
        input.velocity_m_per_s = Vec3((*velocity)[0], (*velocity)[1], (*velocity)[2]);
        input.has_velocity = true;
    }
    input.sample_time_ns = state_.sample_time_ns;
    input.elapsed_s = context.elapsed_s;
    input.elapsed_periods = std::max(state_.elapsed_periods, 1U);
    input.force_n = force_.conditioned.force_n;
    input.proxy_m = output.proxy_m;
    input.faults = faults_of(output);
    input.causes = context.causes | own_causes();
    input.force_was_lost = take_back();
    return input;
}

ForceOff ToolPort::own_causes() const noexcept
{
    return when(has_action(force_.conditioned.actions, ForceAction::refused), ForceOff::garbage) |
           when(!sample_.connected, ForceOff::disconnect) |
           when(!sample_.deadman_held, ForceOff::deadman) |
           when(jump_.has_jumped(), ForceOff::jump);
}

/// Returns whether the device has dropped the last force: somebody braked it, or its own watchdog
/// ended the force.
bool ToolPort::take_back() noexcept
{
    switch (device_.status().state)
    {
    case DeviceState::brake:
        release_brake();
        return true;
    case DeviceState::idle:
        return safe_state_.gain() > 0.0;
    case DeviceState::force:
        break;
    }
    return false;
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

void ToolPort::send(const Vec3& force_n) noexcept
{
    device_.write({force_n.x(), force_n.y(), force_n.z()});
}

} // namespace tactus::hrtc
