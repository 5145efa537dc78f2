// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/force_conditioner.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/force/force_limiter.hpp"
#include "rt_core/force/stiffness_rule.hpp"
#include "rt_core/math/direction.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/rounding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus
{

namespace
{

bool is_stiffness(double value) noexcept
{
    return value >= 0.0 && value <= std::numeric_limits<double>::max(); // NaN gives false.
}

/// Energy that a wall's spring returns when the tool leaves: the triangle below force over stretch.
/// If the force is clamped below stiffness x stretch, a rectangle is added.
double spring_energy_j(double force_n, double stiffness_n_per_m, double stretch_m) noexcept
{
    const double least_stretch = force_n / stiffness_n_per_m;
    return force_n * (std::max(stretch_m, least_stretch) - 0.5 * least_stretch);
}

/// Set-up for the torque of a device: `setup` with angles for lengths.
ConditionerSetup in_angles(const ConditionerSetup& setup) noexcept
{
    ConditionerSetup angles = setup;
    angles.device = rotational_limits_of(setup.device);
    angles.speed_max_m_per_s = kRotationMax_rad_per_s;
    return angles;
}

} // namespace

ForceConditioner::ForceConditioner(const ConditionerSetup& setup) noexcept
    : setup_(setup)
    , limit_step_n_per_m_(stiffness_limit(setup.device, setup.period_s) * setup.period_s /
                          kMaterialBlend_s)
    , allowed_n_per_m_(stiffness_limit(setup.device, setup.period_s))
    , limit_n_per_m_(allowed_n_per_m_)
    , velocity_(setup.device.quantum_m)
    , sent_(setup.device.delay_s / setup.period_s)
    , observer_(setup.device, setup.period_s)
{
    TACTUS_ASSERT(find_fault(setup.device) == nullptr);
    TACTUS_ASSERT(setup.period_s > 0.0);
}

double ForceConditioner::begin(SpringForce& force, const DeviceStep& device) noexcept
{
    limit_stiffness(force, device.surface_damping_n_s_per_m);
    const bool is_observed = observe(device);
    gain_ = limit(force);
    if (!is_observed || !sent_.knows_delay())
    {
        force.actions |= ForceAction::blind;
    }
    return gain_;
}

void ForceConditioner::finish(SpringForce& force, double gain) noexcept
{
    TACTUS_ASSERT(gain >= 0.0);
    force.force_n = gain < gain_ ? Vec3(force.force_n * (gain / gain_)) : force.force_n;
    hold(force, false);
    if (setup_.controls_passivity)
    {
        damp(force);
    }
    TACTUS_ASSERT(force.force_n.norm() <= setup_.device.force_max_n * kRoundedUp);
    force.work_j = observer_.work_j();
    force.observed_energy_j = observer_.observed_energy_j();
    sent_.send(force.force_n);
}

void ForceConditioner::follow(const SpringForce& sent, bool is_ramp) noexcept
{
    sent_.replace_newest(sent.force_n);
    if (is_ramp)
    {
        observer_.forgive();
        return;
    }
    hold(sent, true);
}

/// Observes the energy since the last frame. False if the position is unusable; the next position
/// then counts as the first one.
bool ForceConditioner::observe(const DeviceStep& device) noexcept
{
    const std::uint32_t periods = std::max<std::uint32_t>(device.elapsed_periods, 1);
    const double elapsed_s = setup_.period_s * periods;
    const Vec3 force_n = sent_.mean_since(periods);
    const Vec3 way = device.position_m - position_m_;
    const double farthest = setup_.speed_max_m_per_s * elapsed_s;
    const bool is_usable =
        device.position_m.allFinite() && (!knows_position_ || way.norm() <= farthest);
    if (!is_usable)
    {
        velocity_.clear();
        observer_.hold_nothing();
    }
    else if (knows_position_)
    {
        observer_.observe(force_n, way, elapsed_s, device.carried_m);
    }
    knows_position_ = device.position_m.allFinite();
    if (knows_position_)
    {
        velocity_.add(device.position_m, elapsed_s);
        position_m_ = device.position_m;
    }
    return is_usable;
}

/// Sets the stiffness limit for the present surface damping. If the damping has changed, the limit
/// moves in steps under a force, and at once without one.
void ForceConditioner::limit_stiffness(const SpringForce& force,
                                       double surface_damping_n_s_per_m) noexcept
{
    if (surface_damping_n_s_per_m != surface_damping_n_s_per_m_)
    {
        surface_damping_n_s_per_m_ = surface_damping_n_s_per_m;
        allowed_n_per_m_ =
            stiffness_limit(setup_.device, setup_.period_s, surface_damping_n_s_per_m_);
    }
    if (limit_n_per_m_ != allowed_n_per_m_)
    {
        const bool is_touching = force.force_n != Vec3(0.0, 0.0, 0.0);
        const double step = is_touching ? limit_step_n_per_m_ : kInfinity;
        limit_n_per_m_ = std::clamp(allowed_n_per_m_, limit_n_per_m_ - step, limit_n_per_m_ + step);
    }
}

/// Limits the force to the device's range. Returns the share of the force that is left, 0 .. 1.
double ForceConditioner::limit(SpringForce& force) const noexcept
{
    force.actions = ForceAction::none;
    force.damping_n_s_per_m = 0.0;
    if (!force.force_n.allFinite() || !is_stiffness(force.stiffness_n_per_m))
    {
        force.force_n.setZero();
        force.stiffness_n_per_m = 0.0;
        force.actions = ForceAction::refused;
        return 0.0;
    }
    const bool is_too_stiff = force.stiffness_n_per_m > limit_n_per_m_;
    const double scale = is_too_stiff ? limit_n_per_m_ / force.stiffness_n_per_m : 1.0;
    const Vec3 capped_n = force.force_n * scale;
    force.force_n = clamp_norm(capped_n, setup_.device.force_max_n);
    const bool is_clamped = force.force_n != capped_n;
    force.stiffness_n_per_m *= scale;
    force.actions |= is_too_stiff ? ForceAction::stiffness_limited : ForceAction::none;
    force.actions |= is_clamped ? ForceAction::clamped : ForceAction::none;
    // The ratio is taken of the largest coordinates, as the square of a huge value is infinite.
    const double share =
        is_clamped && has_direction(capped_n)
            ? largest_coordinate({&force.force_n, 1}) / largest_coordinate({&capped_n, 1})
            : 1.0;
    return scale * share;
}

/// Reports the energy of this force's spring to the observer; `is_again` replaces the last report.
void ForceConditioner::hold(const SpringForce& force, bool is_again) noexcept
{
    const double force_n = force.force_n.norm();
    const bool is_stretched = force_n > 0.0 && force.stiffness_n_per_m > 0.0;
    if (force_n > 0.0 && !is_stretched)
    {
        observer_.hold_nothing();
        return;
    }
    const double stretch_m = std::isfinite(force.stretch_m) ? force.stretch_m : 0.0;
    const double energy_j =
        is_stretched ? spring_energy_j(force_n, force.stiffness_n_per_m, stretch_m) : 0.0;
    is_again ? observer_.hold_instead(energy_j) : observer_.hold(energy_j);
}

/// Adds the damping against the velocity to the wall's force; the sum never pulls.
void ForceConditioner::damp(SpringForce& force) const noexcept
{
    const Vec3 velocity = velocity_.velocity_m_per_s();
    const double damping = observer_.damping_for(velocity.norm());
    const Vec3 wall_n = force.force_n;
    if (!(damping * velocity.norm() > kLeastDamping_n) || !(wall_n.norm() > 0.0))
    {
        return;
    }
    Vec3 total = wall_n - velocity * damping;
    const double along = total.dot(wall_n);
    if (along < 0.0)
    {
        total -= wall_n * (along / wall_n.squaredNorm());
    }
    force.actions |= ForceAction::damped;
    force.damping_n_s_per_m = damping;
    force.force_n = clamp_norm(total, setup_.device.force_max_n);
}

WrenchConditioner::WrenchConditioner(const ConditionerSetup& setup) noexcept
    : push_(setup)
    , torque_(setup.device.rotation.torque_max_nm > 0.0 ? in_angles(setup) : setup)
    , has_torque_(setup.device.rotation.torque_max_nm > 0.0)
    , lever_max_m_(setup.lever_max_m)
    , rotational_damping_max_nm_s_per_rad_(kDampingShare *
                                           rotational_limits_of(setup.device).damping_n_s_per_m)
{
}

void WrenchConditioner::condition(ToolForce& force, const ToolPeriod& period) noexcept
{
    const double damping = period.surface_damping_n_s_per_m;
    double gain = push_.begin(force.push,
                              {period.device_m, period.elapsed_periods, damping, period.carried_m});
    if (has_torque_)
    {
        const double rotational_damping =
            std::min(damping * lever_max_m_ * lever_max_m_, rotational_damping_max_nm_s_per_rad_);
        gain =
            std::min(gain, torque_.begin(force.torque, {period.turned_rad, period.elapsed_periods,
                                                        rotational_damping, period.carried_rad}));
        torque_.finish(force.torque, gain);
    }
    else
    {
        force.torque = {};
    }
    push_.finish(force.push, gain);
    last_n_ = force.push.force_n;
    last_nm_ = force.torque.force_n;
}

void WrenchConditioner::follow(const ToolForce& sent, bool is_ramp) noexcept
{
    if (sent.push.force_n != last_n_)
    {
        push_.follow(sent.push, is_ramp);
    }
    if (has_torque_ && sent.torque.force_n != last_nm_)
    {
        torque_.follow(sent.torque, is_ramp);
    }
}

} // namespace tactus
