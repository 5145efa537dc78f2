// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/tool_force.hpp"
#include "rt_core/records/tool_load.hpp"
#include "rt_core/records/tool_period.hpp"

namespace tactus
{

/// Limits of a device; 0: no torque.
struct WrenchLimits
{
    double force_max_n{0.0};
    double torque_max_nm{0.0};
};

/// Compensates the weight of a device's payload, so that the user does not feel it. The
/// compensation is no force of the model: it bypasses the conditioner, which is for walls, and the
/// ForceFader, whose fading would drop the payload if data is late.
///
///     load = gain x weight, upwards;  its torque = lever x load
///
/// The gain has its own ramp, down in kFadeTime_s and up in kRiseTime_s. It falls for every cause
/// in the device: gone, let go, cut off, garbage, stale, too fast, end of the run. Causes in the
/// scene alone (halted, over-constrained, jump, host, stall, clutch, starved, growth) don't change
/// it. The lever follows the tool's rotation only without such a cause, and no faster than a user
/// can rotate (kRotationMax_rad_per_s). So no sample changes the force's length or direction,
/// raises the torque above weight x lever, or makes it jump.
///
/// The payload's force is sent whole; if both together exceed the device's largest force or torque,
/// the other one is shortened, force and torque by one gain.
///
/// Haptic thread, once a frame, after the ForceFader. About 50 ns.
class GravityCompensation
{
public:
    /// - Mass not negative; weight and torque at most the limits, except with a torque limit of 0:
    /// such a device gets the force alone.
    GravityCompensation(const ToolLoad& load, const WrenchLimits& limits) noexcept;

    /// Sets the payload's part of `force`, which the ForceFader has passed, and shortens the rest
    /// accordingly. Uses the device's rotation in `period`, only while it is trusted.
    void carry(ToolForce& force, const ToolPeriod& period) noexcept TACTUS_NONBLOCKING;

    /// Shortens the rest again, without changing the payload's part.
    void make_room(ToolForce& force) const noexcept TACTUS_NONBLOCKING;

    /// Share of the payload that is compensated, 0 .. 1.
    [[nodiscard]] double gain() const noexcept { return gain_; }

private:
    void turn_lever(const Mat3& rotation, double elapsed_s) noexcept;

    ToolLoad load_;
    WrenchLimits limits_;
    double gain_{0.0};
    Vec3 lever_m_{0.0, 0.0, 0.0}; ///< Device's position to the centre, in the world.
};

} // namespace tactus
