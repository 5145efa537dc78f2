// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/remote/remote_values.hpp"

#include "rt_core/force/stiffness_rule.hpp"
#include "transport/base/printable.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

constexpr double kForceMax_n = 1'000.0;
constexpr double kTorqueMax_nm = 100.0;
constexpr double kDelayMax_s = 0.1;
constexpr double kPlaceMax_m = 1e4;
constexpr double kSpeedMax_m_per_s = 1e3;
constexpr std::int64_t kRateMax_hz = 100'000;

bool is_good_name(const std::string& name) noexcept
{
    return !name.empty() && name.size() <= kDeviceNameMax &&
           std::ranges::all_of(name, is_printable);
}

bool is_within(double value, double most) noexcept
{
    return value > 0.0 && value <= most;
}

} // namespace

const char* find_fault(const DeviceInfo& info) noexcept
{
    if (!is_good_name(info.name))
    {
        return "device: the name must have 1..31 printable ASCII characters";
    }
    if (const char* fault = find_fault(info.limits); fault != nullptr)
    {
        return fault;
    }
    if (info.limits.force_max_n > kForceMax_n)
    {
        return "device: force_max_n must be at most 1000";
    }
    if (info.limits.rotation.torque_max_nm > kTorqueMax_nm)
    {
        return "device: torque_max_nm must be at most 100";
    }
    if (!(info.gripper_force_max_n >= 0.0 && info.gripper_force_max_n <= kForceMax_n))
    {
        return "device: gripper_force_max_n must be in range 0..1000";
    }
    if (info.limits.delay_s > kDelayMax_s)
    {
        return "device: delay_s must be at most 0.1";
    }
    const auto is_near = [](double m) { return std::abs(m) <= kPlaceMax_m; };
    if (!std::ranges::all_of(info.workspace_centre_world_m, is_near))
    {
        return "device: the workspace centre must be within 10000 m on each axis";
    }
    if (!is_within(info.workspace_radius_m, kPlaceMax_m))
    {
        return "device: workspace_radius_m must be above 0 and at most 10000";
    }
    if (!is_within(info.speed_max_m_per_s, kSpeedMax_m_per_s))
    {
        return "device: speed_max_m_per_s must be above 0 and at most 1000";
    }
    if (info.rate_min_hz < 1 || info.rate_max_hz < info.rate_min_hz ||
        info.rate_max_hz > kRateMax_hz)
    {
        return "device: rates must be in range 1..100000 Hz, the minimum not above the maximum";
    }
    return nullptr;
}

} // namespace tactus
