// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/gravity_compensation.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/force/force_limiter.hpp"
#include "rt_core/limits.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// Causes in the scene or in timing, not in the device: they leave the compensation unchanged.
constexpr ForceOff kOfTheScene = ForceOff::server | ForceOff::stall | ForceOff::jump |
                                 ForceOff::halted | ForceOff::over_constrained | ForceOff::clutch |
                                 ForceOff::starved | ForceOff::growth;

/// Largest share of `wall`, 0 .. 1, for which `load` + share x `wall` is no longer than `most`.
double share_beside(const Vec3& wall, const Vec3& load, double most) noexcept
{
    if ((wall + load).norm() <= most)
    {
        return 1.0;
    }
    const double a = wall.squaredNorm();
    const double b = wall.dot(load);
    const double c = std::max(0.0, most * most - load.squaredNorm());
    return a > 0.0 ? std::clamp((std::sqrt(b * b + a * c) - b) / a, 0.0, 1.0) : 0.0;
}

} // namespace

GravityCompensation::GravityCompensation(const ToolLoad& load, const WrenchLimits& limits) noexcept
    : load_(load), limits_(limits)
{
    TACTUS_ASSERT(load.mass_kg >= 0.0);
    TACTUS_ASSERT(load.weight_n() <= limits.force_max_n);
    TACTUS_ASSERT(limits.torque_max_nm <= 0.0 || load.torque_max_nm() <= limits.torque_max_nm);
}

void GravityCompensation::carry(ToolForce& force, const ToolPeriod& period) noexcept
{
    if (!(load_.mass_kg > 0.0))
    {
        return;
    }
    const bool has_sample = force.state != SafetyState::reset;
    const bool is_trusted = has_sample && (force.causes | kOfTheScene) == kOfTheScene;
    if (is_trusted)
    {
        turn_lever(period.device_rotation, period.elapsed_s);
    }
    const double left = period.force_left < 1.0 ? gain_ * period.force_left : 1.0;
    gain_ = is_trusted ? std::min(gain_ + period.elapsed_s / kRiseTime_s, 1.0)
                       : std::max(gain_ - period.elapsed_s / kFadeTime_s, 0.0);
    gain_ = has_sample ? std::min(gain_, left) : 0.0;
    force.load_n = -gain_ * load_.weight_n() * load_.down_world;
    if (limits_.torque_max_nm > 0.0)
    {
        force.load_nm = lever_m_.cross(force.load_n);
    }
    make_room(force);
}

void GravityCompensation::make_room(ToolForce& force) const noexcept
{
    double share = 1.0;
    if (load_.mass_kg > 0.0)
    {
        share = share_beside(force.push.force_n, force.load_n, limits_.force_max_n);
    }
    if (load_.mass_kg > 0.0 && limits_.torque_max_nm > 0.0)
    {
        share = std::min(share,
                         share_beside(force.torque.force_n, force.load_nm, limits_.torque_max_nm));
    }
    force.push.force_n *= share;
    force.torque.force_n *= share;
}

/// Rotates the lever to the tool's rotation, at a limited rate while the payload is compensated.
void GravityCompensation::turn_lever(const Mat3& rotation, double elapsed_s) noexcept
{
    const Vec3 way = rotation * load_.centre_m - lever_m_;
    const double most_m = kRotationMax_rad_per_s * load_.centre_m.norm() * elapsed_s;
    lever_m_ += gain_ > 0.0 ? clamp_norm(way, most_m) : way;
}

} // namespace tactus
