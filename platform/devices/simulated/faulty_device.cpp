// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/faulty_device.hpp"

#include "platform/devices/simulated/motion_maths.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace tactus
{

namespace
{

void set_velocities(DeviceSample& sample, double value) noexcept
{
    for (auto* velocity :
         {&sample.velocity_world_m_per_s, &sample.angular_velocity_world_rad_per_s})
    {
        if (*velocity)
        {
            (*velocity)->fill(value);
        }
    }
}

/// Restores the last pose in an untrustworthy reading.
void keep_place(DeviceSample& sample, const DeviceSample& last) noexcept
{
    sample.position_world_m = last.position_world_m;
    sample.rotation_world = last.rotation_world;
}

} // namespace

FaultyDevice::FaultyDevice(std::unique_ptr<HapticDevice> device, std::vector<DeviceFault> faults,
                           std::uint64_t seed)
    : WrappedDevice(std::move(device)), faults_(std::move(faults)), seed_(seed)
{
}

DeviceSample FaultyDevice::read() noexcept
{
    DeviceSample sample = WrappedDevice::read();
    last_ = sample.frame == 0 ? sample : last_;
    const bool was_away = std::exchange(is_away_, false);
    const bool was_stuck = std::exchange(is_stuck_, false);
    for (const DeviceFault& fault : faults_)
    {
        if (fault.holds_at(sample.frame))
        {
            spoil(fault.kind, sample);
        }
    }
    if (is_away_ && !was_away)
    {
        drop_force();
    }
    if (was_stuck && !is_stuck_)
    {
        leap(sample);
    }
    if (sample.valid && std::isfinite(sample.position_world_m[0]))
    {
        last_ = sample;
    }
    return sample;
}

/// Sets the velocity as if the whole missed displacement had happened in one period.
void FaultyDevice::leap(DeviceSample& sample) const noexcept
{
    const double time_s = to_seconds(sample.time - last_.time);
    for (std::size_t i = 0; sample.velocity_world_m_per_s && time_s > 0.0 && i < 3; ++i)
    {
        (*sample.velocity_world_m_per_s)[i] =
            (sample.position_world_m[i] - last_.position_world_m[i]) / time_s;
    }
}

/// Ends the force unless the device is braked, which makes no force and must stay so.
void FaultyDevice::drop_force() noexcept
{
    if (status().state != DeviceState::brake)
    {
        release_brake();
    }
}

void FaultyDevice::write(const Wrench& wrench) noexcept
{
    if (!is_away_)
    {
        WrappedDevice::write(wrench);
    }
}

void FaultyDevice::spoil(DeviceFaultKind kind, DeviceSample& sample) noexcept
{
    switch (kind)
    {
    case DeviceFaultKind::jitter:
        shake(sample);
        return;
    case DeviceFaultKind::disconnect:
        is_away_ = true;
        sample.connected = false;
        [[fallthrough]];
    case DeviceFaultKind::dropout:
        keep_place(sample, last_);
        sample.velocity_world_m_per_s = last_.velocity_world_m_per_s;
        sample.angular_velocity_world_rad_per_s = last_.angular_velocity_world_rad_per_s;
        sample.time = last_.time;
        sample.valid = false;
        return;
    case DeviceFaultKind::stuck:
        is_stuck_ = true;
        keep_place(sample, last_);
        set_velocities(sample, 0.0);
        return;
    case DeviceFaultKind::nan:
        sample.position_world_m.fill(std::numeric_limits<double>::quiet_NaN());
        set_velocities(sample, std::numeric_limits<double>::quiet_NaN());
        if (sample.rotation_world)
        {
            sample.rotation_world->fill(std::numeric_limits<double>::quiet_NaN());
        }
        if (sample.gripper_m)
        {
            sample.gripper_m = std::numeric_limits<double>::quiet_NaN();
        }
        return;
    case DeviceFaultKind::time_jump:
        sample.time = sample.time + kTimeJump;
        return;
    }
}

void FaultyDevice::shake(DeviceSample& sample) const noexcept
{
    const Vec3 error_m = kJitter_m * noise_vector_at(seed_, sample.frame);
    sample.position_world_m[0] += error_m.x();
    sample.position_world_m[1] += error_m.y();
    sample.position_world_m[2] += error_m.z();
}

} // namespace tactus
