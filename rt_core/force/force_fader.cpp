// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/force_fader.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/limits.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// Faults of a sample after which neither its position nor its force is used.
constexpr FrameFault kSampleFaults =
    FrameFault::tool_invalid | FrameFault::tool_stuck | FrameFault::tool_jumped;

/// Causes of a held proxy, under which the frame's force still comes from good data.
constexpr ForceOff kHeldProxy = ForceOff::halted | ForceOff::over_constrained | ForceOff::starved;

bool is_trusted(ForceOff causes) noexcept
{
    return (causes | kHeldProxy) == kHeldProxy;
}

bool is_good(const ToolPeriod& period) noexcept
{
    return (period.faults & kSampleFaults) == FrameFault::none;
}

bool is_finite(const Vec3& v) noexcept
{
    return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

/// Returns `v`, shortened to `norm_max` if it is longer.
Vec3 shortened(const Vec3& v, double norm_max) noexcept
{
    const double norm = v.norm();
    return norm > norm_max ? Vec3(v * (norm_max / norm)) : v;
}

} // namespace

ForceFader::ForceFader(const SafetyLimits& limits) noexcept : limits_(limits)
{
    TACTUS_ASSERT(limits.force_max_n > 0.0);
    TACTUS_ASSERT(limits.speed_max_m_per_s >= 0.0);
    TACTUS_ASSERT(limits.stiffness_n_per_m >= 0.0);
    TACTUS_ASSERT(limits.damping_n_s_per_m >= 0.0);
    TACTUS_ASSERT(limits.torque_max_nm >= 0.0);
    TACTUS_ASSERT(limits.stiffness_nm_per_rad >= 0.0);
    TACTUS_ASSERT(limits.damping_nm_s_per_rad >= 0.0);
    TACTUS_ASSERT(limits.rotation_max_rad_per_s >= 0.0);
}

void ForceFader::step(ToolForce& force, const ToolPeriod& period) noexcept
{
    TACTUS_ASSERT(period.elapsed_s >= 0.0);
    observe_speed(period);
    const ForceOff causes = find_causes(force, period);
    const bool was_off = gain_ <= 0.0;
    move_gain(period, causes);
    if (is_trusted(causes))
    {
        catch_up(force, period.elapsed_s, was_off);
    }
    let_out(force, causes);
}

void ForceFader::fade(ToolForce& force, double elapsed_s, ForceOff cause) noexcept
{
    TACTUS_ASSERT(cause != ForceOff::none);
    gain_ = std::max(gain_ - elapsed_s / kFadeTime_s, 0.0);
    is_following_ = false;
    velocity_m_per_s_ = Vec3(0.0, 0.0, 0.0);
    rotation_rad_per_s_ = Vec3(0.0, 0.0, 0.0);
    let_out(force, cause);
}

/// Sets the base only if the last result was not a fade: a fading base is the force from before the
/// cause.
void ForceFader::follow(const ToolForce& sent) noexcept
{
    if (gain_ > 0.0 && !is_fading_)
    {
        base_n_ = (sent.push.force_n - damping_n_) / gain_;
        base_nm_ = (sent.torque.force_n - damping_nm_) / gain_;
    }
}

void ForceFader::let_out(ToolForce& force, ForceOff causes) noexcept
{
    const bool feels_nothing = base_n_.squaredNorm() <= 0.0 && base_nm_.squaredNorm() <= 0.0;
    // A rising gain in free air needs no damping.
    const double share =
        causes == ForceOff::none && feels_nothing ? 0.0 : 4.0 * gain_ * (1.0 - gain_);
    damping_n_ = shortened(-share * limits_.damping_n_s_per_m * velocity_m_per_s_,
                           kDampingForceShare * limits_.force_max_n);
    damping_nm_ = shortened(-share * limits_.damping_nm_s_per_rad * rotation_rad_per_s_,
                            kDampingForceShare * limits_.torque_max_nm);
    is_fading_ = !is_trusted(causes);
    state_ = next_state(causes);
    force.push.force_n = shortened(gain_ * base_n_ + damping_n_, limits_.force_max_n);
    force.torque.force_n = shortened(gain_ * base_nm_ + damping_nm_, limits_.torque_max_nm);
    force.state = state_;
    force.causes = causes;
}

/// Takes the speed from the device, or from the motion between its last two new samples and the
/// true time between them.
void ForceFader::observe_speed(const ToolPeriod& period) noexcept
{
    since_sample_s_ += period.elapsed_s;
    if (!is_good(period) || has_cause(period.causes, ForceOff::disconnect))
    {
        velocity_m_per_s_ = Vec3(0.0, 0.0, 0.0);
        rotation_rad_per_s_ = Vec3(0.0, 0.0, 0.0);
        return;
    }
    const bool is_new = period.sample_time_ns == 0 || period.sample_time_ns != sample_time_ns_;
    if (!is_new && has_sample_)
    {
        return;
    }
    if (period.has_velocity && is_finite(period.velocity_m_per_s))
    {
        velocity_m_per_s_ = period.velocity_m_per_s;
    }
    else if (has_sample_ && since_sample_s_ > 0.0)
    {
        velocity_m_per_s_ = (period.device_m - position_m_) / since_sample_s_;
    }
    if (period.has_rotation && is_finite(period.rotation_rad_per_s))
    {
        rotation_rad_per_s_ = period.rotation_rad_per_s;
    }
    else if (has_sample_ && since_sample_s_ > 0.0)
    {
        rotation_rad_per_s_ = (period.turned_rad - turned_rad_) / since_sample_s_;
    }
    position_m_ = period.device_m;
    turned_rad_ = period.turned_rad;
    sample_time_ns_ = period.sample_time_ns;
    since_sample_s_ = 0.0;
    has_sample_ = true;
    is_too_fast_ = is_too_fast();
}

bool ForceFader::is_too_fast() const noexcept
{
    const double share = is_too_fast_ ? kCalmSpeedShare : 1.0;
    return velocity_m_per_s_.norm() > share * limits_.speed_max_m_per_s ||
           (limits_.rotation_max_rad_per_s > 0.0 &&
            rotation_rad_per_s_.norm() > share * limits_.rotation_max_rad_per_s);
}

ForceOff ForceFader::find_causes(const ToolForce& force, const ToolPeriod& period) const noexcept
{
    const auto when = [](bool is_so, ForceOff cause) { return is_so ? cause : ForceOff::none; };
    return period.causes | when(is_too_fast_, ForceOff::velocity) |
           when(period.force_left < 1.0, ForceOff::watchdog) |
           when(has_fault(period.faults, FrameFault::tool_stuck), ForceOff::stale) |
           when(has_fault(period.faults, FrameFault::tool_invalid | FrameFault::tool_jumped) ||
                    !is_finite(force.push.force_n) || !is_finite(force.torque.force_n),
                ForceOff::garbage) |
           when(has_fault(period.faults, FrameFault::object_lost), ForceOff::jump) |
           when(has_fault(period.faults, FrameFault::proxy_halted), ForceOff::halted) |
           when(has_fault(period.faults, FrameFault::proxy_over_constrained),
                ForceOff::over_constrained) |
           when(period.elapsed_periods > 1, ForceOff::stall);
}

void ForceFader::move_gain(const ToolPeriod& period, ForceOff causes) noexcept
{
    if (!has_sample_)
    {
        gain_ = 0.0;
    }
    else if (causes != ForceOff::none)
    {
        const double left = gain_ * period.force_left;
        gain_ = std::max(std::min(gain_ - period.elapsed_s / kFadeTime_s, left), 0.0);
    }
    else if (gain_ > 0.0 || may_begin(period))
    {
        gain_ = std::min(gain_ + period.elapsed_s / kRiseTime_s, 1.0);
    }
    // After a disconnection the first sample starts over: the device may be another one, or may
    // have been moved.
    has_sample_ = has_sample_ && (gain_ > 0.0 || !has_cause(causes, ForceOff::disconnect));
    is_following_ = is_following_ && is_trusted(causes);
}

/// False if the user is so deep in a wall that the device can't produce the spring's force: the
/// user must come out first.
bool ForceFader::may_begin(const ToolPeriod& period) const noexcept
{
    const double spring_n = limits_.stiffness_n_per_m * period.stretch_m;
    const double spring_nm = limits_.stiffness_nm_per_rad * period.twist_rad;
    return spring_n <= limits_.force_max_n &&
           (limits_.torque_max_nm <= 0.0 || spring_nm <= limits_.torque_max_nm);
}

/// Moves the base towards the frame's force. Once it has arrived at full gain, the frame's force is
/// sent as it is. If no force was sent, the base arrives at once.
void ForceFader::catch_up(const ToolForce& force, double elapsed_s, bool was_off) noexcept
{
    const Vec3 target_n = shortened(force.push.force_n, limits_.force_max_n);
    const Vec3 target_nm = shortened(force.torque.force_n, limits_.torque_max_nm);
    const Vec3 way_n = target_n - base_n_;
    const Vec3 way_nm = target_nm - base_nm_;
    const double share = elapsed_s / kRiseTime_s;
    const double step_n = limits_.force_max_n * share;
    const double step_nm = limits_.torque_max_nm * share;
    const bool has_arrived =
        is_following_ || was_off || (way_n.norm() <= step_n && way_nm.norm() <= step_nm);
    base_n_ = has_arrived ? target_n : Vec3(base_n_ + shortened(way_n, step_n));
    base_nm_ = has_arrived ? target_nm : Vec3(base_nm_ + shortened(way_nm, step_nm));
    is_following_ = is_following_ || (has_arrived && gain_ >= 1.0);
}

SafetyState ForceFader::next_state(ForceOff causes) const noexcept
{
    if (!has_sample_)
    {
        return SafetyState::reset;
    }
    if (gain_ <= 0.0)
    {
        return SafetyState::idle;
    }
    return causes == ForceOff::none ? SafetyState::force : SafetyState::brake;
}

} // namespace tactus
