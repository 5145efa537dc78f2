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

/// What a device can make; 0: no torque.
struct WrenchLimits
{
    double force_max_n{0.0};
    double torque_max_nm{0.0};
};

/// Carries the weight of what hangs on a device, so that the hand feels none. It is the device's
/// load and not the model's force: it goes round the conditioner, whose wall it isn't, and round
/// the SafeState, whose fading would let it drop whenever data is late.
///
///     load = gain x weight, upwards;  its torque = lever x load
///
/// The gain has a ramp of its own, down in kFadeTime_s and up in kRiseTime_s. It falls on every
/// cause that says something of the device: gone, let go, cut off, garbage, stale, too fast, the
/// run's end. What says something of the scene alone (frozen, squeezed, jump, host, stall, clutch,
/// starved, growth) leaves it. The lever follows the tool's rotation only while no such cause is
/// there, and no faster than a hand may turn (kTurningMax_rad_per_s). So no sample makes a force of
/// another length or direction, nor a torque above weight x lever, nor one that jumps.
///
/// The load goes out whole; where both are more than the device's largest force or torque, the
/// other one is shortened, force and torque by one gain.
///
/// Haptic thread, once a frame, after the SafeState. Some 50 ns.
class GravityCompensation
{
public:
    /// - Mass not negative; weight and torque no more than the limits, but for a torque limit of 0:
    ///   such a device gets the force alone.
    GravityCompensation(const ToolLoad& load, const WrenchLimits& limits) noexcept;

    /// The load's part of `force`, which the SafeState has let out, and what is left of the rest
    /// beside it. Of `period`: the device's rotation, used only while it is believed.
    void carry(ToolForce& force, const ToolPeriod& period) noexcept TACTUS_NONBLOCKING;

    /// Only what is left of the rest, once more.
    void make_room(ToolForce& force) const noexcept TACTUS_NONBLOCKING;

    /// Share of the load that is carried, 0 .. 1.
    [[nodiscard]] double gain() const noexcept { return gain_; }

private:
    void turn_lever(const Mat3& rotation, double elapsed_s) noexcept;

    ToolLoad load_;
    WrenchLimits limits_;
    double gain_{0.0};
    Vec3 lever_m_{0.0, 0.0, 0.0}; ///< From the device's position to the centre, in the world.
};

} // namespace tactus
