// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/deadline_account.hpp"

#include <algorithm>
#include <bit>

namespace tactus::hrtc
{

namespace
{

Duration share_of(Duration duration, double share) noexcept
{
    return {static_cast<std::int64_t>(static_cast<double>(duration.ns) * share)};
}

CycleFlag when(bool is_so, CycleFlag flag) noexcept
{
    return is_so ? flag : CycleFlag::none;
}

} // namespace

DeadlineAccount::DeadlineAccount(Duration period)
    : period_(period)
    , cpu_limit_(share_of(period, kCpuShare))
    , machine_limit_(std::min(kMachineTime, share_of(period, kMachineShare)))
{
    noted_.reserve(kNotedMax);
}

void DeadlineAccount::add(std::uint64_t frame, const CycleMeasures& measures,
                          bool over_work) noexcept
{
    const Duration lost = period_ * (std::int64_t{measures.cycle.periods} - 1);
    (lost.ns > 0 ? after_loss_ : in_turn_).record(measures.lateness_of_end + lost);
    const CycleFlag flags = flags_of(measures, over_work);
    allocations += measures.allocations;
    page_faults +=
        static_cast<std::uint64_t>(measures.usage.minor_faults + measures.usage.major_faults);
    calls = measures.calls;
    ended_late_ = measures.lateness_of_end > period_;
    count(flags);
    if (has_any(flags, kOwnFaults | CycleFlag::over_cpu | CycleFlag::missed))
    {
        note({frame, flags, measures.cycle.wake_lateness, measures.frame, measures.cpu,
              measures.lateness_of_end});
    }
}

CycleFlag DeadlineAccount::flags_of(const CycleMeasures& measures, bool over_work) const noexcept
{
    const ThreadUsage& usage = measures.usage;
    const Cycle& cycle = measures.cycle;
    return when(usage.minor_faults + usage.major_faults > 0, CycleFlag::page_fault) |
           when(measures.allocations > 0, CycleFlag::allocation) |
           when(usage.voluntary_switches > cycle.sleeps, CycleFlag::gave_way) |
           when(measures.calls.in_frame > calls.in_frame, CycleFlag::system_call) |
           when(over_work, CycleFlag::over_work) |
           when(measures.cpu > cpu_limit_, CycleFlag::over_cpu) |
           when(cycle.wake_lateness > machine_limit_, CycleFlag::woken_late) |
           when(std::max(measures.frame - measures.cpu, measures.beside - measures.beside_cpu) >
                    machine_limit_,
                CycleFlag::held_up) |
           when(measures.lateness_of_end > period_ || (cycle.periods > 1 && !ended_late_),
                CycleFlag::missed);
}

void DeadlineAccount::count(CycleFlag flags) noexcept
{
    for (std::size_t bit = 0; bit < kCycleFlags; ++bit)
    {
        flagged[bit] += has_any(flags, static_cast<CycleFlag>(1U << bit)) ? 1U : 0U;
    }
    const bool own = has_any(flags, kOwnFaults);
    const bool is_missed = has_any(flags, CycleFlag::missed);
    const bool machines = has_any(flags, kMachinesDoing);
    own_faults += own ? 1U : 0U;
    missed += is_missed ? 1U : 0U;
    machine_late += is_missed && !own && machines ? 1U : 0U;
    unexplained += is_missed && !own && !machines ? 1U : 0U;
    suspected += !own && has_any(flags, CycleFlag::over_cpu) ? 1U : 0U;
}

void DeadlineAccount::note(const NotedCycle& cycle) noexcept
{
    if (noted_.size() == kNotedMax)
    {
        ++not_kept;
        return;
    }
    noted_.push_back(cycle); // Within what is reserved.
}

std::vector<std::uint64_t> DeadlineAccount::suspects() const
{
    std::vector<std::uint64_t> frames;
    for (const NotedCycle& cycle : noted_)
    {
        if (has_any(cycle.flags, CycleFlag::over_cpu) && !has_any(cycle.flags, kOwnFaults))
        {
            frames.push_back(cycle.frame);
        }
    }
    return frames;
}

void DeadlineAccount::blame(std::uint64_t frame) noexcept
{
    const auto cycle = std::ranges::lower_bound(noted_, frame, {}, &NotedCycle::frame);
    if (cycle == noted_.end() || cycle->frame != frame || has_any(cycle->flags, kOwnFaults))
    {
        return;
    }
    cycle->flags = cycle->flags | CycleFlag::repeated_cpu;
    ++flagged[static_cast<std::size_t>(
        std::countr_zero(static_cast<unsigned>(CycleFlag::repeated_cpu)))];
    ++own_faults;
    machine_late -= has_any(cycle->flags, CycleFlag::missed) ? 1U : 0U; // What over_cpu made it.
}

LatencyHistogram DeadlineAccount::response() const
{
    LatencyHistogram all = after_loss_.corrected(period_);
    all.add(in_turn_);
    return all;
}

} // namespace tactus::hrtc
