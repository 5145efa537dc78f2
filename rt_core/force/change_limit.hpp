// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/device_limits.hpp"
#include "rt_core/records/tool_force.hpp"
#include "rt_core/records/tool_period.hpp"

namespace tactus
{

/// Causes of a force's change, and their limits.
struct ChangeRule
{
    /// Share of the device's largest force or torque by which it may change per millisecond, beyond
    /// the motion of device and objects: kSlewShareMin_per_ms .. 1.
    double slew_share_per_ms{kSlewShare_per_ms};
    double hand_speed_max_m_per_s{1.0};   ///< Limit of the counted device speed; >= 0.
    double object_speed_max_m_per_s{0.5}; ///< Limit of the counted object speed; >= 0.
    /// Arm of the tool: the square root of its angular stiffness over its stiffness. 0: a sphere.
    double arm_m{0.0};
};

/// The last stage before the device: bounds the change of the force from one period to the next,
/// for the result of all stages before it.
///
///     |F' - F| <= K (hand + arm x turned + objects) + slew x T
///     |M' - M| <= A turned + K x arm x (hand + objects) + slew of the torque x T
///
/// K and A are the stiffnesses in use, `hand` and `turned` the device's measured motion in this
/// period. `objects` is the frame's limited displacement of those in reach, plus arm x their
/// rotation. A device that moves along with an object that carries its tool is counted by its
/// motion relative to that, so that nothing is counted twice. An unchanged surface changes the
/// force by no more: a proxy among planes moves no farther than its device, in the metric of the
/// spring's energy. The slew is for all other changes: another normal, a material, damping, a
/// program's force, and a contact that begins with a spring that is already stretched, which so
/// rises from zero. It counts one period, even after a longer stall.
///
/// Decreases are unlimited if the tool does not touch, down to the program's external force, and if
/// a cause fades the force, down to zero. The result is bounded in its direction, too: a force that
/// reverses passes through its old value or zero.
///
/// An active limit is reported as ForceAction::change_limited, and for longer than kChangeTold_s as
/// ForceOff::growth. Haptic thread, about 50 ns.
class ChangeLimit
{
public:
    /// - `rule` within its ranges, `period_s` > 0 (asserted).
    ChangeLimit(const ChangeRule& rule, const DeviceLimits& device, double period_s) noexcept;

    /// Limits the change; true if it acted.
    [[nodiscard]] bool hold(ToolForce& force, const ToolPeriod& period) noexcept TACTUS_NONBLOCKING;

    /// Continues from `sent`, which replaced the last result, with the program's own part of it.
    void follow(const ToolForce& sent, const Vec3& own_n, const Vec3& own_nm) noexcept
    {
        last_n_ = sent.push.force_n;
        last_nm_ = sent.turn.force_n;
        own_n_ = own_n;
        own_nm_ = own_nm;
    }

private:
    /// Largest changes of the two springs in this period.
    struct Steps
    {
        double push_n;
        double turn_nm;
    };
    [[nodiscard]] Steps steps(const ToolForce& force, const ToolPeriod& period) noexcept;

    ChangeRule rule_;
    double period_s_;
    Steps slew_; ///< Slew per period.
    Steps most_; ///< The device's largest change per period.
    Vec3 hand_m_{0.0, 0.0, 0.0};
    Vec3 turned_rad_{0.0, 0.0, 0.0};
    Vec3 last_n_{0.0, 0.0, 0.0};
    Vec3 last_nm_{0.0, 0.0, 0.0};
    Vec3 own_n_{0.0, 0.0, 0.0};
    Vec3 own_nm_{0.0, 0.0, 0.0};
    double acting_s_{0.0};
};

} // namespace tactus
