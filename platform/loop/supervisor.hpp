// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/safety_log.hpp"
#include "platform/loop/tool_port.hpp"
#include "platform/machine/clock.hpp"
#include "platform/machine/heartbeat.hpp"
#include "platform/machine/periodic_timer.hpp"
#include "platform/machine/rt_thread.hpp"

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>

namespace tactus::hrtc
{

/// Parts of the supervisor. All outlive it.
struct SupervisorParts
{
    std::span<const ToolSetup> tools; ///< Tools whose devices it brakes.
    const Heartbeat* heartbeat{nullptr};
    const Clock* clock{nullptr};   ///< Clock of the heartbeat's times.
    PeriodicTimer* timer{nullptr}; ///< Timer of its own, used as an alarm.
    Duration period;               ///< Period of the watched loop.
    /// Number of periods without a beat until it brakes, at least 1.
    std::uint32_t silent_periods{3};
};

/// Brakes all devices if the haptic loop has no beat for `silent_periods` (here 3): because of the
/// device's own read, an endless loop, or a processor taken by another thread.
///
///     beat    beat    beat                              beat
///      |-------|-------|-------.-------.-------|  . . .  |
///                                   brake_softly()        the loop releases it and continues from
///                                                         the rest of the force, or from zero
///
/// After the fade it calls brake(), in case that a device's own thread hangs, too. It sleeps until
/// the silence would be long enough, so it costs one wake-up in that time. Only the loop releases
/// the brake, once it runs again.
class Supervisor
{
public:
    explicit Supervisor(const SupervisorParts& parts) noexcept : parts_(parts) {}

    /// Checks and sleeps in turn until stop(). Allocates nothing.
    void run() noexcept;

    /// Checks once: brakes if the silence is long enough and new. Returns the time of the next
    /// check.
    [[nodiscard]] MonotonicTime look() noexcept;

    /// Any thread: ends run() within the permitted silence.
    void stop() noexcept { stopped_.store(true, std::memory_order_relaxed); }

    /// Any thread: number of silences ended with the brake.
    [[nodiscard]] std::uint64_t brakes() const noexcept
    {
        return brakes_.load(std::memory_order_relaxed);
    }
    /// Events, one for each device and brake.
    [[nodiscard]] SafetyLog& log() noexcept { return log_; }

    /// Options of its thread beside a loop with these options: one priority above, on another
    /// processor than the loop's if there is one, and without real-time rights if the loop has
    /// none.
    [[nodiscard]] static RtThreadOptions thread_beside(const RtThreadOptions& loop);

private:
    void brake() noexcept;
    void brake_softly(MonotonicTime now) noexcept;

    SupervisorParts parts_;
    std::optional<MonotonicTime> noticed_; ///< Last beat before a silence that was ended.
    MonotonicTime noticed_at_;             ///< Time when that silence was noticed.
    SafetyLog log_;
    std::atomic<bool> stopped_{false};     ///< Relaxed: it orders nothing else.
    std::atomic<std::uint64_t> brakes_{0}; ///< Relaxed: for display only.
};

} // namespace tactus::hrtc
