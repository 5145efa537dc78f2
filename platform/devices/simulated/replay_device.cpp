// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/replay_device.hpp"

#include "platform/devices/device_force.hpp"
#include "rt_core/math/value_range.hpp"

#include <algorithm>
#include <utility>

namespace tactus
{

namespace
{

bool is_place(const DeviceSample& reading) noexcept
{
    return reading.valid && to_vec3(reading.position_world_m).allFinite();
}

/// Fault of the options; null if none.
const char* find_bad_option(const ReplayDeviceOptions& options)
{
    if (options.readings.empty())
    {
        return "replay device: there are no readings to replay";
    }
    if (std::ranges::none_of(options.readings, is_place))
    {
        return "replay device: no reading has a valid position";
    }
    if (options.rate_hz <= 0)
    {
        return "replay device: the rate must be above 0 Hz";
    }
    if (!is_positive(options.limits.force_max_n) || !is_positive(options.speed_max_m_per_s))
    {
        return "replay device: the largest force and speed must be finite and above zero";
    }
    return nullptr;
}

DeviceInfo describe(const ReplayDeviceOptions& options)
{
    Vec3 low = to_vec3(std::ranges::find_if(options.readings, is_place)->position_world_m);
    Vec3 high = low;
    for (const DeviceSample& reading : options.readings)
    {
        if (is_place(reading))
        {
            low = low.cwiseMin(to_vec3(reading.position_world_m));
            high = high.cwiseMax(to_vec3(reading.position_world_m));
        }
    }
    const double reach_m = std::max(0.5 * (high - low).norm(), ReplayDevice::kReachMin_m);
    DeviceInfo info;
    info.name = "replay";
    info.limits = options.limits;
    info.workspace_centre_world_m = to_array(0.5 * (low + high));
    info.workspace_radius_m = reach_m;
    info.speed_max_m_per_s = options.speed_max_m_per_s;
    info.rate_min_hz = options.rate_hz;
    info.rate_max_hz = options.rate_hz;
    return info;
}

} // namespace

Result<std::unique_ptr<ReplayDevice>, Refusal> ReplayDevice::create(ReplayDeviceOptions options)
{
    if (const char* wrong = find_bad_option(options))
    {
        return Refusal{wrong};
    }
    return std::unique_ptr<ReplayDevice>(new ReplayDevice(std::move(options)));
}

ReplayDevice::ReplayDevice(ReplayDeviceOptions options) : info_(describe(options))
{
    readings_ = std::move(options.readings);
}

DeviceSample ReplayDevice::read() noexcept
{
    const std::uint64_t frame = status_.frames++;
    DeviceSample sample = readings_[std::min<std::uint64_t>(frame, readings_.size() - 1)];
    sample.frame = frame;
    sample.connected = sample.connected && !has_ended();
    sample.valid = sample.connected && sample.valid;
    return sample;
}

void ReplayDevice::write(const Wrench& wrench) noexcept
{
    if (!braked_.load())
    {
        static_cast<void>(take_wrench(wrench, info_, status_));
        status_.state = DeviceState::force;
    }
}

void ReplayDevice::release_brake() noexcept
{
    status_.state = DeviceState::idle;
    braked_.store(false);
}

DeviceStatus ReplayDevice::status() const noexcept
{
    DeviceStatus status = status_;
    if (braked_.load())
    {
        status.state = DeviceState::brake;
    }
    else if (has_ended())
    {
        status.state = DeviceState::idle;
    }
    return status;
}

} // namespace tactus
