// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/world/program_devices.hpp"

#include "platform/devices/device_force.hpp"
#include "platform/devices/simulated/simulated_device.hpp"
#include "platform/machine/posix/posix_clock.hpp"
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

namespace
{

thread_local int callbacks = 0; // Nested ones count, too.

} // namespace

bool is_in_callback() noexcept
{
    return callbacks > 0;
}

CallbackScope::CallbackScope() noexcept
{
    ++callbacks;
}

CallbackScope::~CallbackScope()
{
    --callbacks;
}

DeviceSample SharedDevice::read() noexcept
{
    const CallbackScope scope;
    return device_->read();
}

void SharedDevice::write(const Wrench& wrench) noexcept
{
    const CallbackScope scope;
    device_->write(wrench);
}

void SharedDevice::brake() noexcept
{
    const CallbackScope scope;
    device_->brake();
}

void SharedDevice::brake_softly() noexcept
{
    const CallbackScope scope;
    device_->brake_softly();
}

void SharedDevice::release_brake() noexcept
{
    const CallbackScope scope;
    device_->release_brake();
}

DeviceStatus SharedDevice::status() const noexcept
{
    const CallbackScope scope;
    return device_->status();
}

ExternalForce CallbackForce::next(const DeviceSample& /*sample*/, const ToolState& tool,
                                  const ToolOutput& output) noexcept
{
    const CallbackScope scope;
    const PosixClock clock;
    const MonotonicTime start = clock.now();
    ExternalForce force;
    try
    {
        force = force_(tool, output);
    }
    catch (...) // The program's bug must not end the loop and its guards.
    {
        throws_.fetch_add(1, std::memory_order_relaxed);
    }
    overruns_.fetch_add(clock.now() - start > longest_ ? 1U : 0U, std::memory_order_relaxed);
    return force;
}

} // namespace tactus::hrtc
