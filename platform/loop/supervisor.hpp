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

/// Parts of the supervisor. All must outlive the supervisor.
struct SupervisorParts
{
    std::span<const ToolSetup> tools; ///< Tools whose devices it brakes.
    const Heartbeat* heartbeat{nullptr};
    const Clock* clock{nullptr};   ///< Clock of the heartbeat's times.
    PeriodicTimer* timer{nullptr}; ///< Alarm of the supervisor; no other user.
    Duration period;               ///< Period of the watched loop.
    /// Number of periods without a heartbeat after which the supervisor brakes, at least 1.
    std::uint32_t silent_periods{3};
};

/// Brakes all devices if the haptic loop has no beat for `silent_periods` (3 in the picture).
/// Reasons are a device whose read blocks, an endless loop, or a processor taken by another thread.
///
///     beat    beat    beat                              beat
///      |-------|-------|-------.-------.-------|  . . .  |
///                                   brake_softly()        the loop releases it and continues from
///                                                         the rest of the force, or from zero
///
/// After the fade the supervisor calls brake(), in case that a device's own thread hangs, too.
/// Between checks it sleeps until the silence would be long enough, so it wakes once in that time.
/// Only the loop releases the brake, once it runs again.
class Supervisor
{
public:
    explicit Supervisor(const SupervisorParts& parts) noexcept : parts_(parts) {}

    /// Checks and sleeps in turn until stop(). Allocates nothing.
    void run() noexcept;

    /// Checks once, and brakes softly if the loop is silent for long enough. At a later check in
    /// the same silence, kBrakeFade or more afterwards, it brakes at once. Returns the time of the
    /// next check.
    [[nodiscard]] MonotonicTime check() noexcept;

    /// Any thread: ends run() within `silent_periods` periods.
    void stop() noexcept { stopped_.store(true, std::memory_order_relaxed); }

    /// Any thread: number of silences for which the devices were braked.
    [[nodiscard]] std::uint64_t brakes() const noexcept
    {
        return brakes_.load(std::memory_order_relaxed);
    }
    /// Log with one event for each device and brake.
    [[nodiscard]] SafetyLog& log() noexcept { return log_; }

    /// Options of the supervisor's thread, from those of the loop's: priority one above, and
    /// another processor if the loop has one of its own. It may run without real-time rights if the
    /// loop may.
    [[nodiscard]] static RtThreadOptions thread_beside(const RtThreadOptions& loop);

private:
    void brake() noexcept;
    void brake_softly(MonotonicTime now) noexcept;

    SupervisorParts parts_;
    /// Last beat before the silence that last caused a brake.
    std::optional<MonotonicTime> noticed_;
    MonotonicTime noticed_at_; ///< Time when the devices were braked for that silence.
    SafetyLog log_;
    std::atomic<bool> stopped_{false};     ///< Relaxed: it orders nothing else.
    std::atomic<std::uint64_t> brakes_{0}; ///< Relaxed: for display only.
};

} // namespace tactus::hrtc
