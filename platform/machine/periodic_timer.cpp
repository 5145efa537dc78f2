// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/periodic_timer.hpp"

#include <algorithm>
#include <limits>

namespace tactus
{

Result<Done, Refusal> PeriodicTimer::start(Duration period, Duration margin)
{
    if (period < kPeriodMin || period > kPeriodMax)
    {
        return Refusal{"timer period " + std::to_string(period.ns) +
                       " ns is out of range 50000..1000000000 ns (1 Hz to 20 kHz)"};
    }
    if (margin < Duration{} || margin >= period)
    {
        return Refusal{"timer margin " + std::to_string(margin.ns) + " ns is out of range 0.." +
                       std::to_string(period.ns - 1) + " ns (below the period)"};
    }
    period_ = period;
    margin_ = margin;
    deadline_ = now() + period;
    wake_lateness_ = {};
    periods_ = 1;
    in_episode_ = false;
    counts_ = {};
    return Done{};
}

void PeriodicTimer::sleep_until_margin() noexcept
{
    TACTUS_ASSERT(period_ > Duration{});
    const MonotonicTime before = now();
    skip_lost_periods(before);
    const MonotonicTime wake = deadline_ - margin_;
    if (before >= wake)
    {
        return;
    }
    sleep_until(wake);
    wake_lateness_ = std::max(wake_lateness_, now() - wake);
}

Cycle PeriodicTimer::spin_until_deadline() noexcept
{
    TACTUS_ASSERT(period_ > Duration{});
    MonotonicTime time = wait_out();
    while (time - deadline_ >= period_)
    {
        sleep_until_margin();
        time = wait_out();
    }
    const Cycle cycle{deadline_, wake_lateness_, time - deadline_, periods_};
    count_cycle();
    return cycle;
}

/// Waits until the deadline. A preemption during the wait counts as wake-up latency, too.
MonotonicTime PeriodicTimer::wait_out() noexcept
{
    const bool began_in_time = now() < deadline_;
    const MonotonicTime time = spin_until(deadline_);
    if (began_in_time)
    {
        wake_lateness_ = std::max(wake_lateness_, time - deadline_);
    }
    return time;
}

/// Moves the deadline to the first grid point after `time` if whole periods were lost.
void PeriodicTimer::skip_lost_periods(MonotonicTime time) noexcept
{
    const Duration late = time - deadline_;
    if (late < period_)
    {
        return;
    }
    const std::int64_t lost = late / period_ + 1;
    deadline_ = deadline_ + period_ * lost;
    const std::int64_t room = std::numeric_limits<std::uint32_t>::max() - std::int64_t{periods_};
    periods_ += static_cast<std::uint32_t>(std::min(lost, room));
}

void PeriodicTimer::count_cycle() noexcept
{
    const std::uint32_t missed = periods_ - 1;
    counts_.cycles += 1;
    counts_.missed_periods += missed;
    counts_.episodes += (missed > 0 && !in_episode_) ? 1 : 0;
    in_episode_ = missed > 0;
    deadline_ = deadline_ + period_;
    wake_lateness_ = {};
    periods_ = 1;
}

} // namespace tactus
