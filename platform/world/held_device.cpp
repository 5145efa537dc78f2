// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/world/held_device.hpp"

#include "platform/devices/device_force.hpp"
#include "platform/devices/simulated/simulated_device.hpp"
#include "rt_core/limits.hpp"

namespace tactus::hrtc
{

HeldDevice::HeldDevice(const DeviceLimits& limits)
{
    info_.name = "program";
    info_.limits = limits;
    info_.workspace_radius_m = kGoalRange_m; // The program may move the hand anywhere.
    info_.speed_max_m_per_s = SimulatedDeviceOptions{}.speed_max_m_per_s;
    info_.rate_min_hz = SimulatedDeviceOptions::kRateMinHz;
    info_.rate_max_hz = SimulatedDeviceOptions::kRateMaxHz;
}

void HeldDevice::hold(const std::array<double, 3>& position_m,
                      const std::array<double, 4>& rotation, MonotonicTime time)
{
    const std::lock_guard lock(writers_);
    held_ = {position_m, rotation, time.ns};
    is_held_ = true;
    mailbox_.write(held_);
}

void HeldDevice::keep_until(MonotonicTime time)
{
    const std::lock_guard lock(writers_);
    if (is_held_)
    {
        held_.time_ns = time.ns;
        mailbox_.write(held_);
    }
}

DeviceSample HeldDevice::read() noexcept
{
    Held held;
    if (mailbox_.try_read(held)) // Otherwise the last sample again.
    {
        sample_.position_world_m = held.position_m;
        sample_.rotation_world = held.rotation;
        sample_.time = MonotonicTime{held.time_ns};
        sample_.valid = true;
    }
    sample_.frame = status_.frames++;
    return sample_;
}

void HeldDevice::write(const Wrench& wrench) noexcept
{
    if (!is_braked_.load())
    {
        static_cast<void>(take_wrench(wrench, info_, status_)); // It counts.
        status_.state = DeviceState::force;
    }
}

DeviceStatus HeldDevice::status() const noexcept
{
    DeviceStatus status = status_;
    status.state = is_braked_.load() ? DeviceState::brake : status.state;
    return status;
}

} // namespace tactus::hrtc
