// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/force_conditioner.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/force/stiffness_rule.hpp"
#include "rt_core/math/direction.hpp"
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
    return value >= 0.0 && value <= std::numeric_limits<double>::max(); // False for NaN.
}

/// What the spring of a wall gives back when the tool leaves: triangle, or, where the force is cut
/// at `force_n` short of stiffness x stretch, triangle and rectangle.
double spring_energy_j(double force_n, double stiffness_n_per_m, double stretch_m) noexcept
{
    const double least_stretch = force_n / stiffness_n_per_m;
    return force_n * (std::max(stretch_m, least_stretch) - 0.5 * least_stretch);
}

/// For a device that makes a torque.
ConditionerSetup in_angles(const ConditionerSetup& setup) noexcept
{
    ConditionerSetup angles = setup;
    angles.device = turning_of(setup.device);
    angles.speed_max_m_per_s = kTurningMax_rad_per_s;
    return angles;
}

} // namespace

ForceConditioner::ForceConditioner(const ConditionerSetup& setup) noexcept
    : setup_(setup)
    , cap_step_n_per_m_(stiffness_cap(setup.device, setup.period_s) * setup.period_s /
                        kMaterialGlide_s)
    , allowed_n_per_m_(stiffness_cap(setup.device, setup.period_s))
    , cap_n_per_m_(allowed_n_per_m_)
    , velocity_(setup.device.quantum_m)
    , sent_(setup.device.delay_s / setup.period_s)
    , observer_(setup.device, setup.period_s)
{
    TACTUS_ASSERT(find_fault(setup.device) == nullptr);
    TACTUS_ASSERT(setup.period_s > 0.0);
}

ConditionedForce ForceConditioner::condition(const ForceWish& wish) noexcept
{
    return finish(begin(wish));
}

double ForceConditioner::begin(const ForceWish& wish) noexcept
{
    wish_ = wish;
    output_ = {};
    cap_for(wish);
    const bool is_observed = observe(wish);
    if (!is_observed || !sent_.knows_delay())
    {
        output_.actions |= ForceAction::blind;
    }
    gain_ = limit(wish, output_);
    return gain_;
}

ConditionedForce ForceConditioner::finish(double gain) noexcept
{
    TACTUS_ASSERT(gain >= 0.0);
    const Vec3 wished_n = gain < gain_ ? Vec3(wished_n_ * (gain / gain_)) : wished_n_;
    const double step_n = setup_.device.slew_max_n_per_s * setup_.period_s;
    wall_n_ = limit_growth(wall_n_, wished_n, step_n);
    output_.actions |= wall_n_ != wished_n ? ForceAction::slew_limited : ForceAction::none;
    hold(wish_, wall_n_, output_.stiffness_n_per_m);
    output_.force_n = setup_.controls_passivity ? damp(wall_n_, output_) : wall_n_;
    TACTUS_ASSERT(output_.force_n.norm() <= setup_.device.force_max_n * kRoundedUp);
    output_.work_j = observer_.work_j();
    output_.surplus_j = observer_.surplus_j();
    sent_.send(output_.force_n);
    return output_;
}

void ForceConditioner::follow(const Vec3& sent_n) noexcept
{
    sent_.replace_newest(sent_n);
    observer_.forgive();
    wall_n_ = sent_n;
}

/// The energy since the last frame. False when the position is of no use for that; then the next
/// one is a first one.
bool ForceConditioner::observe(const ForceWish& wish) noexcept
{
    const std::uint32_t periods = std::max<std::uint32_t>(wish.elapsed_periods, 1);
    const double elapsed_s = setup_.period_s * periods;
    const Vec3 force_n = sent_.mean_since(periods);
    const Vec3 way = wish.position_m - position_m_;
    const double farthest = setup_.speed_max_m_per_s * elapsed_s;
    const bool is_usable =
        wish.position_m.allFinite() && (!knows_position_ || way.norm() <= farthest);
    if (!is_usable)
    {
        velocity_.clear();
        observer_.hold_nothing();
    }
    else if (knows_position_)
    {
        observer_.observe(force_n, way, elapsed_s);
    }
    knows_position_ = wish.position_m.allFinite();
    if (knows_position_)
    {
        velocity_.add(wish.position_m, elapsed_s);
        position_m_ = wish.position_m;
    }
    return is_usable;
}

/// Most frames touch what the last one touched. Where a surface damps less than before, the wall
/// that its damping had forbidden comes back step by step; in free air it may at once.
void ForceConditioner::cap_for(const ForceWish& wish) noexcept
{
    if (wish.surface_damping_n_s_per_m != surface_damping_n_s_per_m_)
    {
        surface_damping_n_s_per_m_ = wish.surface_damping_n_s_per_m;
        allowed_n_per_m_ =
            stiffness_cap(setup_.device, setup_.period_s, surface_damping_n_s_per_m_);
    }
    if (cap_n_per_m_ != allowed_n_per_m_)
    {
        const bool is_touching = wish.force_n != Vec3(0.0, 0.0, 0.0);
        cap_n_per_m_ = is_touching ? std::min(allowed_n_per_m_, cap_n_per_m_ + cap_step_n_per_m_)
                                   : allowed_n_per_m_;
    }
}

/// How much of the wish is within the device's limits, and what acted, in `output`.
double ForceConditioner::limit(const ForceWish& wish, ConditionedForce& output) noexcept
{
    wished_n_ = Vec3(0.0, 0.0, 0.0);
    if (!wish.force_n.allFinite() || !is_stiffness(wish.stiffness_n_per_m))
    {
        output.actions |= ForceAction::refused;
        return 0.0;
    }
    const bool is_too_stiff = wish.stiffness_n_per_m > cap_n_per_m_;
    const double scale = is_too_stiff ? cap_n_per_m_ / wish.stiffness_n_per_m : 1.0;
    const Vec3 capped_n = wish.force_n * scale;
    wished_n_ = clamp_norm(capped_n, setup_.device.force_max_n);
    const bool is_clamped = wished_n_ != capped_n;
    output.stiffness_n_per_m = wish.stiffness_n_per_m * scale;
    output.actions |= is_too_stiff ? ForceAction::stiffness_capped : ForceAction::none;
    output.actions |= is_clamped ? ForceAction::clamped : ForceAction::none;
    // By the largest coordinate: the square of what is huge is infinite.
    const double share =
        is_clamped && has_direction(capped_n)
            ? largest_coordinate({&wished_n_, 1}) / largest_coordinate({&capped_n, 1})
            : 1.0;
    return scale * share;
}

void ForceConditioner::hold(const ForceWish& wish, const Vec3& wall_n,
                            double stiffness_n_per_m) noexcept
{
    const double force_n = wall_n.norm();
    const bool is_wall = wish.stiffness_n_per_m > 0.0 || force_n == 0.0;
    if (!is_wall)
    {
        observer_.hold_nothing();
        return;
    }
    const bool is_stretched = force_n > 0.0 && stiffness_n_per_m > 0.0;
    const double stretch_m = std::isfinite(wish.stretch_m) ? wish.stretch_m : 0.0;
    observer_.hold(is_stretched ? spring_energy_j(force_n, stiffness_n_per_m, stretch_m) : 0.0);
}

/// The wall's force and the damping against the velocity; never a pull.
Vec3 ForceConditioner::damp(const Vec3& wall_n, ConditionedForce& output) const noexcept
{
    const Vec3 velocity = velocity_.velocity_m_per_s();
    const double damping = observer_.damping_for(velocity.norm());
    if (!(damping * velocity.norm() > kLeastDamping_n) || !(wall_n.norm() > 0.0))
    {
        return wall_n;
    }
    Vec3 total = wall_n - velocity * damping;
    const double along = total.dot(wall_n);
    if (along < 0.0)
    {
        total -= wall_n * (along / wall_n.squaredNorm());
    }
    output.actions |= ForceAction::damped;
    output.damping_n_s_per_m = damping;
    return clamp_norm(total, setup_.device.force_max_n);
}

WrenchConditioner::WrenchConditioner(const ConditionerSetup& setup) noexcept
    : force_(setup)
    , torque_(setup.device.turn.torque_max_nm > 0.0 ? in_angles(setup) : setup)
    , has_torque_(setup.device.turn.torque_max_nm > 0.0)
    , lever_max_m_(setup.lever_max_m)
    , turning_damping_max_nm_s_per_rad_(kDampingShare * turning_of(setup.device).damping_n_s_per_m)
{
}

ConditionedWrench WrenchConditioner::condition(const WrenchWish& wish) noexcept
{
    ConditionedWrench output;
    double gain = force_.begin(wish.force);
    if (has_torque_)
    {
        ForceWish turn = wish.torque;
        turn.surface_damping_n_s_per_m =
            std::min(wish.force.surface_damping_n_s_per_m * lever_max_m_ * lever_max_m_,
                     turning_damping_max_nm_s_per_rad_);
        gain = std::min(gain, torque_.begin(turn));
    }
    output.force = force_.finish(gain);
    if (has_torque_)
    {
        output.torque = torque_.finish(gain);
    }
    last_n_ = output.force.force_n;
    last_nm_ = output.torque.force_n;
    return output;
}

void WrenchConditioner::follow(const Vec3& sent_n, const Vec3& sent_nm) noexcept
{
    if (sent_n != last_n_)
    {
        force_.follow(sent_n);
    }
    if (has_torque_ && sent_nm != last_nm_)
    {
        torque_.follow(sent_nm);
    }
}

} // namespace tactus
