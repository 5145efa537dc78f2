// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/supervisor.hpp"

#include "platform/machine/posix/linux_extras.hpp"

#include <algorithm>

namespace tactus::hrtc
{

void Supervisor::run() noexcept
{
    while (!stopped_.load(std::memory_order_relaxed))
    {
        const Duration until = check() - parts_.clock->now();
        const Duration sleep =
            std::clamp(until, PeriodicTimer::kPeriodMin, PeriodicTimer::kPeriodMax);
        // start() refuses only periods out of range.
        static_cast<void>(parts_.timer->start(sleep, Duration{}));
        parts_.timer->sleep_until_margin();
    }
}

MonotonicTime Supervisor::check() noexcept
{
    const Duration patience = parts_.period * parts_.silent_periods;
    const std::optional<MonotonicTime> last = parts_.heartbeat->last();
    // The clock is read after the beat, so `now` is no earlier than the beat.
    const MonotonicTime now = parts_.clock->now();
    if (!last)
    {
        return now + patience;
    }
    if (now - *last < patience)
    {
        return *last + patience;
    }
    if (noticed_ != last)
    {
        noticed_ = last;
        noticed_at_ = now;
        brake_softly(now);
    }
    else if (now - noticed_at_ >= kBrakeFade)
    {
        brake(); // This also stops a device whose own thread did not run the fade.
    }
    return now + parts_.period;
}

void Supervisor::brake() noexcept
{
    for (const ToolSetup& tool : parts_.tools)
    {
        tool.device->brake();
    }
}

void Supervisor::brake_softly(MonotonicTime now) noexcept
{
    for (const ToolSetup& tool : parts_.tools)
    {
        tool.device->brake_softly();
    }
    brakes_.fetch_add(1, std::memory_order_relaxed);
    for (std::uint32_t tool = 0; tool < parts_.tools.size(); ++tool)
    {
        log_.note({now, 0, tool, SafetyState::brake, ForceOff::watchdog, true});
    }
}

RtThreadOptions Supervisor::thread_beside(const RtThreadOptions& loop)
{
    RtThreadOptions options = loop;
    options.priority = loop.priority + 1;
    options.is_supervisor = true;
    options.lock_memory = false;      // The loop's thread locks the memory of the process.
    options.processors_awake = false; // The loop's thread keeps the processors awake.
    options.cpu = loop.cpu ? linux_extras::another_cpu(*loop.cpu) : std::nullopt;
    return options;
}

} // namespace tactus::hrtc
