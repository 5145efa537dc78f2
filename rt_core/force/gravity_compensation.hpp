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

/// Largest force and torque of a device; a torque of 0: the device has none.
struct WrenchLimits
{
    double force_max_n{0.0};
    double torque_max_nm{0.0};
};

/// Compensates the weight of a device's payload, so that the user does not feel it. The
/// compensation bypasses ForceConditioner, which is for walls, and ForceFader, which would drop the
/// payload if data is late.
///
///     load = gain x weight, upwards;  its torque = lever x load
///
/// The gain falls in kFadeTime_s and rises in kRiseTime_s. It falls for every cause in the device:
/// gone, let go, cut off, garbage, stale, too fast, end of the run. Causes in the scene (halted,
/// over-constrained, jump, server, stall, clutch, starved, growth) don't change it. The lever
/// follows the tool's rotation while no cause is in the device, and no faster than
/// kRotationMax_rad_per_s. So no sample makes the payload's force or torque jump.
///
/// The payload's force is sent whole. If the total exceeds the device's largest force or torque,
/// the other force and torque are shortened by one gain.
///
/// Haptic thread, once a frame, after the ForceFader. About 50 ns.
class GravityCompensation
{
public:
    /// - The mass is not negative; weight and torque are at most the limits (asserted). With a
    /// torque limit of 0 the payload's torque is not compensated.
    GravityCompensation(const ToolLoad& load, const WrenchLimits& limits) noexcept;

    /// Sets the payload's part of `force`, a result of ForceFader, and shortens the rest to the
    /// device's limits. Uses the device's rotation in `period` while the sample is trusted.
    void carry(ToolForce& force, const ToolPeriod& period) noexcept TACTUS_NONBLOCKING;

    /// Shortens push and torque again to what the payload's part leaves of the device's limits.
    void make_room(ToolForce& force) const noexcept TACTUS_NONBLOCKING;

    /// Share of the payload that is compensated, 0 .. 1.
    [[nodiscard]] double gain() const noexcept { return gain_; }

private:
    void turn_lever(const Mat3& rotation, double elapsed_s) noexcept;

    ToolLoad load_;
    WrenchLimits limits_;
    double gain_{0.0};
    /// Vector from the device's position to the centre of mass, in the world.
    Vec3 lever_m_{0.0, 0.0, 0.0};
};

} // namespace tactus
