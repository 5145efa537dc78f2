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

/// What makes a force change, and how much of it counts.
struct ChangeRule
{
    /// Of the device's largest force or torque, in a millisecond, beside what hand and objects
    /// make: kSlewShareMin_per_ms .. 1.
    double slew_share_per_ms{kSlewShare_per_ms};
    double hand_speed_max_m_per_s{1.0};   ///< More of a hand's way doesn't count. >= 0.
    double object_speed_max_m_per_s{0.5}; ///< More of an object's way doesn't count. >= 0.
    /// Of the tool: the square root of its angular stiffness over its stiffness. 0: a sphere.
    double arm_m{0.0};
};

/// The last stage before the device: bounds by how much a force changes from one period to the
/// next, for all forces of the stages before it.
///
///     |F' - F| <= K (hand + arm x turned + objects) + slew x T
///     |M' - M| <= A turned + K x arm x (hand + objects) + slew of the torque x T
///
/// K and A are the stiffnesses in use, `hand` and `turned` what the device has measured in this
/// period and `objects` what the frame believes of those in reach: how far they went, and arm x
/// their turn. A hand that goes along with what carries its tool is counted
/// by what it goes beside that, so that nothing is counted twice. A surface that stays as it is
/// changes the force by no more, since a proxy among planes goes no farther than its hand, in the
/// metric of the spring's energy. The slew is for all else: another normal, a material, damping, a
/// program's force, and a touch that begins with a spring that is already long, which so rises from
/// zero. It counts one period, however long a stall.
///
/// Downward all is let through where the tool touches nothing any more, to what the program itself
/// wanted, and where a cause fades it, to zero. What is let through is bounded in its direction,
/// too: a force that turns round goes through what it was or through zero.
///
/// Where it acts it says ForceAction::change_limited, and for longer than kChangeTold_s
/// ForceOff::growth. Haptic thread, some 50 ns.
class ChangeLimit
{
public:
    /// - `rule` within its ranges, `period_s` > 0 (asserted).
    ChangeLimit(const ChangeRule& rule, const DeviceLimits& device, double period_s) noexcept;

    /// Returns whether it acted.
    [[nodiscard]] bool hold(ToolForce& force, const ToolPeriod& period) noexcept TACTUS_NONBLOCKING;

    /// This went out, and of it so much was the program's own.
    void follow(const ToolForce& sent, const Vec3& own_n, const Vec3& own_nm) noexcept
    {
        last_n_ = sent.push.force_n;
        last_nm_ = sent.turn.force_n;
        own_n_ = own_n;
        own_nm_ = own_nm;
    }

private:
    /// What the two springs may change by in this period.
    struct Steps
    {
        double push_n;
        double turn_nm;
    };
    [[nodiscard]] Steps steps(const ToolForce& force, const ToolPeriod& period) noexcept;

    ChangeRule rule_;
    double period_s_;
    Steps slew_; ///< In one period.
    Steps most_; ///< The device's largest in one period.
    Vec3 hand_m_{0.0, 0.0, 0.0};
    Vec3 turned_rad_{0.0, 0.0, 0.0};
    Vec3 last_n_{0.0, 0.0, 0.0};
    Vec3 last_nm_{0.0, 0.0, 0.0};
    Vec3 own_n_{0.0, 0.0, 0.0};
    Vec3 own_nm_{0.0, 0.0, 0.0};
    double acting_s_{0.0};
};

} // namespace tactus
