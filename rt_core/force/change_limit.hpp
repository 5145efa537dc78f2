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

/// Limits on the change of a force, by cause.
struct ChangeRule
{
    /// Slew: share of the device's largest force or torque by which the result may change per
    /// millisecond, besides motion of device and objects. kSlewShareMin_per_ms .. 1.
    double slew_share_per_ms{kSlewShare_per_ms};
    double device_speed_max_m_per_s{1.0}; ///< Largest device speed that counts as a cause; >= 0.
    double object_speed_max_m_per_s{0.5}; ///< Largest object speed that counts as a cause; >= 0.
    /// Arm of the tool: square root of its angular stiffness over its stiffness; 0 for a sphere.
    double arm_m{0.0};
};

/// Last stage before the device: bounds the change of the sent force from one period to the next.
///
///     |F' - F| <= K (device + arm x turned + objects) + slew x T
///     |M' - M| <= A turned + K x arm x (device + objects) + slew of the torque x T
///
/// K and A are the stiffnesses in use; F, M the last force and torque, F', M' the next ones.
/// `device` and `turned` are the device's measured displacement and rotation in this period T.
/// `objects` is the limited displacement of objects in reach, plus arm x their rotation. If an
/// object carries the tool, the device's motion counts relative to that object. Such motion at an
/// unchanged surface changes the force by no more: a proxy among planes moves no farther than its
/// device, in the metric of the spring's energy. The slew covers all other changes: another normal,
/// a material, damping, a program's force, and a contact that begins with a stretched spring. It
/// counts one period, even after a longer stall.
///
/// A force may decrease at once down to the program's external force if the tool does not touch,
/// and down to zero if a cause fades it. The direction is bounded, too: a force that reverses
/// passes through its old value or zero.
///
/// An active limit is reported as ForceAction::change_limited, and for longer than kChangeTold_s as
/// ForceOff::growth. Haptic thread, about 50 ns.
class ChangeLimit
{
public:
    /// - `rule` within its ranges, `period_s` > 0 (asserted).
    ChangeLimit(const ChangeRule& rule, const DeviceLimits& device, double period_s) noexcept;

    /// Limits the change of `force` since the last period; true if the limit acted.
    [[nodiscard]] bool hold(ToolForce& force, const ToolPeriod& period) noexcept TACTUS_NONBLOCKING;

    /// Makes `sent` the force from which the next change counts; `own_n` and `own_nm` are the
    /// program's external part of it.
    void follow(const ToolForce& sent, const Vec3& own_n, const Vec3& own_nm) noexcept
    {
        last_n_ = sent.push.force_n;
        last_nm_ = sent.torque.force_n;
        own_n_ = own_n;
        own_nm_ = own_nm;
    }

private:
    /// Largest changes of force and torque in this period.
    struct Steps
    {
        double push_n;
        double torque_nm;
    };
    [[nodiscard]] Steps steps(const ToolForce& force, const ToolPeriod& period) noexcept;

    ChangeRule rule_;
    double period_s_;
    Steps slew_; ///< Change per period that the slew allows.
    Steps most_; ///< Largest changes per period that the device allows.
    Vec3 device_m_{0.0, 0.0, 0.0};
    Vec3 turned_rad_{0.0, 0.0, 0.0};
    Vec3 last_n_{0.0, 0.0, 0.0};
    Vec3 last_nm_{0.0, 0.0, 0.0};
    Vec3 own_n_{0.0, 0.0, 0.0};
    Vec3 own_nm_{0.0, 0.0, 0.0};
    double acting_s_{0.0};
};

} // namespace tactus
