// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/deadline_account.hpp"

#include <algorithm>
#include <iterator>

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

/// Flags of a cycle that took too much processor time, with the verdict: `slowed` if it is the
/// machine's fault, `over_cpu` if it is an overrun.
CycleFlag cpu_verdict(CycleFlag flags, bool is_slowed) noexcept
{
    return without(flags, CycleFlag::over_cpu | CycleFlag::slowed) |
           (is_slowed ? CycleFlag::slowed : CycleFlag::over_cpu);
}

} // namespace

DeadlineAccount::DeadlineAccount(Duration period)
    : period_(period)
    , cpu_limit_(share_of(period, kCpuShare))
    , machine_limit_(std::min(kMachineTime, share_of(period, kMachineShare)))
{
    noted_.reserve(kNotedMax);
    suspects_.reserve(kSuspectsMax);
}

void DeadlineAccount::add(std::uint64_t frame, const CycleMeasures& measures, std::uint64_t work,
                          bool over_work) noexcept
{
    outside_.record(measures.outside);
    if (const std::uint64_t times = times_shown(measures.cpu + measures.beside_cpu); times > 0)
    {
        shown_work_ = std::max(shown_work_.value_or(0), times * work);
    }
    const Duration lost = period_ * (std::int64_t{measures.cycle.periods} - 1);
    (lost.ns > 0 ? after_loss_ : in_turn_).record(measures.lateness_of_end + lost);
    CycleFlag flags = flags_of(measures, over_work);
    const bool is_suspect = has_any(flags, CycleFlag::over_cpu) &&
                            !has_any(without(flags, CycleFlag::over_cpu), kOverruns);
    if (is_suspect)
    {
        flags = cpu_verdict(flags, is_shown(work));
    }
    allocations += measures.allocations;
    page_faults +=
        static_cast<std::uint64_t>(measures.usage.minor_faults + measures.usage.major_faults);
    calls = measures.calls;
    own_losses_ = std::max(measures.lateness_of_end, Duration{}) / period_;
    count(flags, 1);
    if (has_any(flags, kOverruns | CycleFlag::slowed | CycleFlag::missed))
    {
        note({frame, flags, measures.cycle.wake_lateness, measures.frame, measures.cpu,
              measures.lateness_of_end});
    }
    if (is_suspect && suspects_.size() < kSuspectsMax)
    {
        suspects_.push_back({frame, work, flags}); // It is within the reserved capacity.
    }
}

/// Number of times that the work of a frame of this `time` is shown to fit: how often `time` goes
/// into kShownShare of the limit, 0 to kShownTimes.
std::uint64_t DeadlineAccount::times_shown(Duration time) const noexcept
{
    const std::int64_t fits =
        share_of(cpu_limit_, kShownShare).ns / std::max<std::int64_t>(time.ns, 1);
    return static_cast<std::uint64_t>(std::clamp<std::int64_t>(fits, 0, kShownTimes));
}

CycleFlag DeadlineAccount::flags_of(const CycleMeasures& measures, bool over_work) const noexcept
{
    const ThreadUsage& usage = measures.usage;
    const Cycle& cycle = measures.cycle;
    const std::int64_t faults = usage.minor_faults + usage.major_faults;
    const bool is_missed =
        measures.lateness_of_end > period_ || std::int64_t{cycle.periods} - 1 > own_losses_;
    const Duration computed = is_missed ? measures.cpu + measures.beside_cpu : measures.cpu;
    return when(faults > 0, CycleFlag::page_fault) |
           when(measures.allocations > 0, CycleFlag::allocation) |
           when(usage.voluntary_switches > faults && !measures.was_stopped, CycleFlag::gave_way) |
           when(measures.calls.in_frame > calls.in_frame, CycleFlag::system_call) |
           when(over_work, CycleFlag::over_work) |
           when(computed > cpu_limit_, CycleFlag::over_cpu) |
           when(measures.was_stopped, CycleFlag::stopped) |
           when(cycle.wake_lateness > machine_limit_, CycleFlag::woken_late) |
           when(std::max(measures.frame - measures.cpu, measures.beside - measures.beside_cpu) >
                    machine_limit_,
                CycleFlag::held_up) |
           when(is_missed, CycleFlag::missed);
}

/// Counts the cycle, or takes it back. `sign`: 1, or 2^64 - 1, which subtracts 1.
void DeadlineAccount::count(CycleFlag flags, std::uint64_t sign) noexcept
{
    for (std::size_t bit = 0; bit < kCycleFlags; ++bit)
    {
        flagged[bit] += has_any(flags, static_cast<CycleFlag>(1U << bit)) ? sign : 0U;
    }
    const bool own = has_any(flags, kOverruns);
    const bool is_missed = has_any(flags, CycleFlag::missed);
    const bool was_stopped = has_any(flags, CycleFlag::stopped);
    overruns += own ? sign : 0U;
    missed += is_missed ? sign : 0U;
    stopped += is_missed && !own && was_stopped ? sign : 0U;
    latency_misses += is_missed && !own && !was_stopped ? sign : 0U;
}

void DeadlineAccount::note(const NotedCycle& cycle) noexcept
{
    if (noted_.size() == kNotedMax)
    {
        ++not_kept;
        return;
    }
    noted_.push_back(cycle); // It is within the reserved capacity.
}

std::vector<std::uint64_t> DeadlineAccount::suspects() const
{
    std::vector<std::uint64_t> frames;
    std::ranges::transform(suspects_, std::back_inserter(frames), &Suspect::frame);
    return frames;
}

void DeadlineAccount::compare_work() noexcept
{
    for (Suspect& suspect : suspects_)
    {
        judge(suspect, is_shown(suspect.work));
    }
}

void DeadlineAccount::settle(std::span<const std::uint64_t> over) noexcept
{
    for (Suspect& suspect : suspects_)
    {
        judge(suspect, !std::ranges::binary_search(over, suspect.frame));
    }
}

/// Takes the suspect's cycle back and counts it again with the new verdict.
void DeadlineAccount::judge(Suspect& suspect, bool is_slowed) noexcept
{
    constexpr std::uint64_t kTakeAway = ~std::uint64_t{0}; // Adding it modulo 2^64 subtracts one.
    count(suspect.flags, kTakeAway);
    suspect.flags = cpu_verdict(suspect.flags, is_slowed);
    count(suspect.flags, 1);
    const auto noted = std::ranges::lower_bound(noted_, suspect.frame, {}, &NotedCycle::frame);
    if (noted != noted_.end() && noted->frame == suspect.frame)
    {
        noted->flags = suspect.flags;
    }
}

LatencyHistogram DeadlineAccount::response() const
{
    LatencyHistogram all = after_loss_.corrected(period_);
    all.add(in_turn_);
    return all;
}

} // namespace tactus::hrtc
