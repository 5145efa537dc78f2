// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/simulated/replay_device.hpp"

#include "platform/device_force.hpp"
#include "rt_core/math/value_range.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus
{

namespace
{

bool is_place(const RecordedReading& reading) noexcept
{
    return reading.valid && std::isfinite(reading.position_world_m.squaredNorm());
}

/// Null when all options are good.
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
    Vec3 low = std::ranges::find_if(options.readings, is_place)->position_world_m;
    Vec3 high = low;
    for (const RecordedReading& reading : options.readings)
    {
        if (is_place(reading))
        {
            low = low.cwiseMin(reading.position_world_m);
            high = high.cwiseMax(reading.position_world_m);
        }
    }
    const double reach_m = std::max(0.5 * (high - low).norm(), ReplayDevice::kReachMin_m);
    return {"replay",
            options.limits,
            to_array(0.5 * (low + high)),
            reach_m,
            options.speed_max_m_per_s,
            options.rate_hz,
            options.rate_hz};
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
    DeviceSample sample;
    sample.frame = status_.frames++;
    const RecordedReading& reading =
        readings_[std::min<std::uint64_t>(sample.frame, readings_.size() - 1)];
    sample.position_world_m = to_array(reading.position_world_m);
    sample.time = reading.time;
    sample.connected = !has_ended();
    sample.valid = sample.connected && reading.valid;
    return sample;
}

void ReplayDevice::write(const std::array<double, 3>& force_world_n) noexcept
{
    if (!braked_.load())
    {
        static_cast<void>(take_force(force_world_n, info_.limits.force_max_n, status_));
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
