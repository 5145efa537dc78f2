// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>

namespace tactus
{

/// Timing of the loop at the start of a frame.
struct Cycle
{
    /// Grid point of this frame: start + a whole number of periods.
    MonotonicTime deadline;
    /// Wake-up latency: the worst of this cycle's sleeps and of the wait for the deadline. Zero if
    /// there was no time for either, so a frame that took too long never looks like a late machine.
    Duration wake_lateness;
    /// Time from the deadline to the frame's start; below one period unless the clock itself jumps.
    Duration start_lateness;
    /// Whole periods since the last cycle: 1 normally, more after a stall. The next frame must use
    /// it as the elapsed time.
    std::uint32_t periods{1};
};

/// Sums since start(). One stall of k periods is one episode and k missed periods: count episodes
/// to judge a machine.
struct TimerCounts
{
    std::uint64_t cycles{0};
    std::uint64_t missed_periods{0};
    std::uint64_t episodes{0};
};

/// The timer of the haptic loop, in two steps so that the loop can warm its caches just before the
/// query:
///
///     timer.start(period, margin)
///     for (;;)
///         timer.sleep_until_margin()      wakes at deadline - margin, by absolute time
///         frame.warm_caches()
///         cycle = timer.spin_until_deadline()
///         frame.run(...)
///
/// All deadlines lie on one grid, so lateness never adds up. A frame that starts less than a period
/// late runs at once; after a longer stall the timer moves to the next grid point, reports the
/// elapsed periods, and never runs the lost frames in a burst.
///
/// One thread uses a timer; its calls in the loop allocate nothing. Subclasses implement only
/// now(), sleep_until() and spin_until(), so the rules are the same on all machines.
class PeriodicTimer
{
public:
    static constexpr Duration kPeriodMin = microseconds(50); ///< Period of 20 kHz.
    static constexpr Duration kPeriodMax = milliseconds(1'000);

    virtual ~PeriodicTimer() = default;

    /// Starts a grid whose first deadline is one period from now. A restart resets the counts.
    /// `period` must be in [kPeriodMin, kPeriodMax], `margin` in [0, period); others are refused.
    /// sleep_until_margin() and spin_until_deadline() require a start (asserted).
    Result<Done, Refusal> start(Duration period, Duration margin);

    /// Sleeps until `margin` before the deadline. Returns at once if that has passed.
    void sleep_until_margin() noexcept;

    /// Waits through the margin without yielding the processor. After a stall it first sleeps to
    /// the new grid point.
    [[nodiscard]] Cycle spin_until_deadline() noexcept;

    [[nodiscard]] const TimerCounts& counts() const noexcept { return counts_; }
    [[nodiscard]] Duration period() const noexcept { return period_; }

protected:
    PeriodicTimer() = default;
    PeriodicTimer(const PeriodicTimer&) = default;
    PeriodicTimer& operator=(const PeriodicTimer&) = default;

private:
    [[nodiscard]] virtual MonotonicTime now() noexcept = 0;
    /// Returns at `wake` or later, never earlier.
    virtual void sleep_until(MonotonicTime wake) noexcept = 0;
    /// Like sleep_until(), but keeps the processor; returns the time at its end.
    [[nodiscard]] virtual MonotonicTime spin_until(MonotonicTime deadline) noexcept = 0;

    [[nodiscard]] MonotonicTime wait_out() noexcept;
    void skip_lost_periods(MonotonicTime time) noexcept;
    void count_cycle() noexcept;

    Duration period_{};
    Duration margin_{};
    MonotonicTime deadline_{};
    Duration wake_lateness_{};
    std::uint32_t periods_{1};
    bool in_episode_{false};
    TimerCounts counts_{};
};

} // namespace tactus
