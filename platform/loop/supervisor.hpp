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

/// What the supervisor looks at; all of it outlives the supervisor.
struct SupervisorParts
{
    std::span<const ToolSetup> tools; ///< Whose devices it brakes.
    const Heartbeat* heartbeat{nullptr};
    const Clock* clock{nullptr};     ///< The one that the heartbeat's times are of.
    PeriodicTimer* timer{nullptr};   ///< Its own; used as an alarm.
    Duration period;                 ///< Of the watched loop.
    std::uint32_t silent_periods{3}; ///< Without a beat; then it brakes. At least 1.
};

/// Brakes all devices when the haptic loop has given no sign of life for so many periods (here 3),
/// whatever it hangs in: the device's own read, an endless loop, a processor that somebody else
/// has taken.
///
///     beat    beat    beat                              beat
///      |-------|-------|-------.-------.-------|  . . .  |
///                                   brake_softly()        the loop releases it and goes on from
///                                                         what is left of the force, or from zero
///
/// When the fade should be over it calls brake(), in case that a device's own thread hangs, too.
/// It sleeps until the silence would be long enough and looks then, so it costs one wake-up in
/// that time. It does not release: the loop does, when it is back.
class Supervisor
{
public:
    explicit Supervisor(const SupervisorParts& parts) noexcept : parts_(parts) {}

    /// Looks and sleeps by turns until stop(). Allocates nothing.
    void run() noexcept;

    /// One look: brakes when the silence is long enough and it has not been noticed yet. Returns
    /// when to look again.
    [[nodiscard]] MonotonicTime look() noexcept;

    /// Any thread: ends run() within the silence that it allows.
    void stop() noexcept { stopped_.store(true, std::memory_order_relaxed); }

    /// Any thread: how many silences it has ended with the brake.
    [[nodiscard]] std::uint64_t brakes() const noexcept
    {
        return brakes_.load(std::memory_order_relaxed);
    }
    /// One event a device and brake.
    [[nodiscard]] SafetyLog& log() noexcept { return log_; }

    /// The thread that it should have beside a loop with these options: one priority above, on a
    /// processor other than the loop's where there is one, and without real-time rights where the
    /// loop has none.
    [[nodiscard]] static RtThreadOptions thread_beside(const RtThreadOptions& loop);

private:
    void brake() noexcept;
    void brake_softly(MonotonicTime now) noexcept;

    SupervisorParts parts_;
    std::optional<MonotonicTime> noticed_; ///< The last beat before a silence that was ended,
    MonotonicTime noticed_at_;             ///< and when that was.
    SafetyLog log_;
    std::atomic<bool> stopped_{false};     ///< Relaxed: it orders nothing else.
    std::atomic<std::uint64_t> brakes_{0}; ///< Relaxed: shown, nothing more.
};

} // namespace tactus::hrtc
