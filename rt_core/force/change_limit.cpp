// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/change_limit.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/force/force_limiter.hpp"
#include "rt_core/math/rounding.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// Limits the change of one spring's force to `step`; true if the limit acted. `is_free`: all
/// forces between `last` and `rest` are allowed.
bool hold_spring(SpringForce& spring, const Vec3& last, const Vec3& rest, bool is_free,
                 double step) noexcept
{
    const Vec3 from = is_free ? nearest_between(last, rest, spring.force_n) : last;
    const Vec3 held = limit_change(from, spring.force_n, step * kRoundedUp);
    const bool has_acted = held != spring.force_n;
    spring.force_n = held;
    spring.actions |= has_acted ? ForceAction::change_limited : ForceAction::none;
    return has_acted;
}

/// Displacement of the device that counts as its own: relative to the object that carries the tool,
/// if that is less. Limited to `most`; 0 if unknown.
double own_way(const Vec3& way, const Vec3& carried, double most) noexcept
{
    const double norm = std::min(way.norm(), (way - carried).norm());
    return std::isfinite(norm) ? std::min(norm, most) : 0.0;
}

} // namespace

ChangeLimit::ChangeLimit(const ChangeRule& rule, const DeviceLimits& device,
                         double period_s) noexcept
    : rule_(rule)
    , period_s_(period_s)
    , slew_{rule.slew_share_per_ms * device.force_max_n * 1e3 * period_s,
            rule.slew_share_per_ms * device.rotation.torque_max_nm * 1e3 * period_s}
    , most_{device.slew_max_n_per_s * period_s, device.rotation.slew_max_nm_per_s * period_s}
{
    TACTUS_ASSERT(rule.slew_share_per_ms >= kSlewShareMin_per_ms && rule.slew_share_per_ms <= 1.0);
    TACTUS_ASSERT(rule.device_speed_max_m_per_s >= 0.0 && rule.object_speed_max_m_per_s >= 0.0);
    TACTUS_ASSERT(rule.arm_m >= 0.0);
    TACTUS_ASSERT(period_s > 0.0);
}

bool ChangeLimit::hold(ToolForce& force, const ToolPeriod& period) noexcept
{
    const Steps step = steps(force, period);
    const bool fades = force.causes != ForceOff::none;
    const bool is_free = fades || !period.is_touching;
    const Vec3 zero(0.0, 0.0, 0.0);
    const bool holds_push =
        hold_spring(force.push, last_n_, fades ? zero : own_n_, is_free, step.push_n);
    const bool holds_turn =
        hold_spring(force.torque, last_nm_, fades ? zero : own_nm_, is_free, step.torque_nm);
    const bool has_acted = holds_push || holds_turn;
    acting_s_ = has_acted ? acting_s_ + period.elapsed_s : 0.0;
    // Elapsed periods are whole, up to rounding.
    const bool lasts = acting_s_ > kChangeTold_s + 0.5 * period_s_;
    force.causes |= lasts ? ForceOff::growth : ForceOff::none;
    return has_acted;
}

ChangeLimit::Steps ChangeLimit::steps(const ToolForce& force, const ToolPeriod& period) noexcept
{
    const double arm = rule_.arm_m;
    const double device = own_way(period.device_m - device_m_, period.carried_m,
                                  rule_.device_speed_max_m_per_s * period_s_);
    const double turned = own_way(period.turned_rad - turned_rad_, period.carried_rad,
                                  kRotationMax_rad_per_s * period_s_);
    const double objects = std::min(rule_.object_speed_max_m_per_s * period_s_,
                                    period.object_way_m + arm * period.object_rotation_rad);
    device_m_ = period.device_m;
    turned_rad_ = period.turned_rad;
    const double stiffness = force.push.stiffness_n_per_m;
    return {std::min(stiffness * (device + arm * turned + objects) + slew_.push_n, most_.push_n),
            std::min(force.torque.stiffness_n_per_m * turned +
                         stiffness * arm * (device + objects) + slew_.torque_nm,
                     most_.torque_nm)};
}

} // namespace tactus
