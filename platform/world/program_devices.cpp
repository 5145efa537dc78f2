// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/world/program_devices.hpp"

#include "platform/machine/posix/posix_clock.hpp"

namespace tactus::hrtc
{

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
