// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/self_check.hpp"

#include "platform/allocation_counter.hpp"
#include "platform/hrtc/frame_repeater.hpp"
#include "platform/hrtc/session.hpp"
#include "platform/hrtc/signals.hpp"
#include "platform/posix/posix_clock.hpp"
#include "platform/thread_usage.hpp"
#include "platform/wrapped_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <map>
#include <memory>
#include <sys/mman.h>

namespace tactus::hrtc
{

namespace
{

constexpr std::size_t kPageBytes = 4'096;
constexpr long kSleep_ns = 20'000;

void touch_new_page() noexcept
{
    void* page = mmap(nullptr, kPageBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1,
                      0); // Where memory is locked the fault is here, else in the next line.
    if (page != MAP_FAILED)
    {
        *static_cast<volatile char*>(page) = 1;
        munmap(page, kPageBytes);
    }
}

/// The device as it is, but its readings spoil the frames of the plan; notes when they were.
class SpoilingDevice final : public WrappedDevice
{
public:
    /// `reads` has room for as many as are noted, and outlives the device.
    SpoilingDevice(std::unique_ptr<HapticDevice> device, Duration period,
                   std::span<MonotonicTime> reads)
        : WrappedDevice(std::move(device)), period_(period), reads_(reads)
    {
    }
    [[nodiscard]] DeviceSample read() noexcept override
    {
        if (frame_ < reads_.size())
        {
            reads_[frame_] = clock_.now();
        }
        if (const auto fault = InjectionPlan::at(frame_++))
        {
            inject(*fault, period_);
        }
        return WrappedDevice::read();
    }

private:
    PosixClock clock_;
    Duration period_;
    std::span<MonotonicTime> reads_;
    std::uint64_t frame_{0};
};

/// What an injected fault has to be flagged as.
CycleFlag flag_of(InjectedFault fault) noexcept
{
    switch (fault)
    {
    case InjectedFault::overrun:
        return CycleFlag::repeated_cpu;
    case InjectedFault::page_fault:
        return CycleFlag::page_fault;
    case InjectedFault::allocation:
        return CycleFlag::allocation;
    case InjectedFault::sleep:
        return CycleFlag::gave_way;
    }
    return CycleFlag::none;
}

/// Whether what the plan does to this frame takes more than `limit` again.
bool is_over_again(std::uint64_t frame, Duration limit, Duration period)
{
    const auto fault = InjectionPlan::at(frame);
    for (int i = 0; fault && i < kRepetitions; ++i)
    {
        const Duration before = read_thread_cpu_time();
        inject(*fault, period);
        if (read_thread_cpu_time() - before > limit)
        {
            return true;
        }
    }
    return false;
}

} // namespace

std::optional<InjectedFault> InjectionPlan::at(std::uint64_t frame) noexcept
{
    const bool is_spoilt = frame >= kFirst && frame < kFrames && (frame - kFirst) % kSpacing == 0;
    const auto fault = static_cast<InjectedFault>((frame - kFirst) / kSpacing % kInjectedFaults);
    if (!is_spoilt || (fault == InjectedFault::allocation && !allocation_counter::available()))
    {
        return std::nullopt;
    }
    return fault;
}

void inject(InjectedFault fault, Duration period) noexcept
{
    switch (fault)
    {
    case InjectedFault::overrun:
        for (const Duration start = read_thread_cpu_time();
             (read_thread_cpu_time() - start) * 10 < period * 11;)
        {
        }
        return;
    case InjectedFault::page_fault:
        touch_new_page();
        return;
    case InjectedFault::allocation:
    {
        void* volatile memory = std::malloc(1); // Or it is left out: nobody uses it.
        std::free(memory);
        return;
    }
    case InjectedFault::sleep:
    {
        const timespec time{0, kSleep_ns};
        nanosleep(&time, nullptr);
        return;
    }
    }
}

bool is_disturbed(std::uint64_t frame, std::span<const MonotonicTime> reads,
                  Duration period) noexcept
{
    if (frame == 0 || frame + 1 >= reads.size())
    {
        return false;
    }
    const auto is_off = [&](std::uint64_t from)
    {
        const Duration off = reads[from + 1] - reads[from] - period;
        return std::abs(off.ns) * 10 > period.ns;
    };
    return is_off(frame - 1) || is_off(frame);
}

InjectionJudge::InjectionJudge()
{
    check_.allocations_counted = allocation_counter::available();
    for (std::uint64_t frame = 0; frame < InjectionPlan::kFrames; ++frame)
    {
        if (InjectionPlan::at(frame))
        {
            open_.push_back(frame);
        }
    }
    check_.injected = open_.size();
}

void InjectionJudge::judge(DeadlineAccount& deadlines, std::span<const MonotonicTime> reads)
{
    std::vector<std::uint64_t> over = deadlines.suspects();
    std::erase_if(over, [&](std::uint64_t frame)
                  { return !is_over_again(frame, deadlines.cpu_limit(), deadlines.period()); });
    deadlines.settle(over);
    std::map<std::uint64_t, CycleFlag> noted;
    for (const NotedCycle& cycle : deadlines.noted())
    {
        noted[cycle.frame] = cycle.flags;
        const bool is_own = has_any(cycle.flags, kOwnFaults);
        check_.false_flags += is_own && !InjectionPlan::at(cycle.frame) ? 1U : 0U;
    }
    std::erase_if(open_,
                  [&](std::uint64_t frame)
                  {
                      const InjectedFault fault = *InjectionPlan::at(frame);
                      const bool is_flagged = has_any(noted[frame], flag_of(fault));
                      check_.flagged += is_flagged ? 1U : 0U;
                      bool& is_seen = seen_[static_cast<std::size_t>(fault)];
                      is_seen = is_seen || is_flagged;
                      return is_flagged || !is_disturbed(frame, reads, deadlines.period());
                  });
}

SelfCheck InjectionJudge::result() const
{
    SelfCheck check = check_;
    check.disturbed = open_.size();
    check.has_each_kind = true;
    for (std::uint64_t frame = 0; frame < InjectionPlan::kFrames; ++frame)
    {
        const auto fault = InjectionPlan::at(frame);
        check.has_each_kind =
            check.has_each_kind && (!fault || seen_[static_cast<std::size_t>(*fault)]);
    }
    return check;
}

namespace
{

/// Empty when all is well; else why there is nothing to judge.
std::optional<Refusal> run_spoilt(const Options& options, InjectionJudge& judge)
{
    auto session = Session::open(options);
    if (!session)
    {
        return session.error();
    }
    std::vector<MonotonicTime> reads(static_cast<std::size_t>(options.frames()));
    std::unique_ptr<HapticDevice>& device = session.value()->controller().tools().front().device;
    device = std::make_unique<SpoilingDevice>(std::move(device), options.period(), reads);
    auto run = session.value()->run("self-check");
    if (!run)
    {
        return run.error();
    }
    if (was_interrupted())
    {
        return interruption();
    }
    reads.resize(std::min<std::size_t>(reads.size(), run.value().statistics.frames));
    judge.judge(run.value().statistics.deadlines, reads);
    return std::nullopt;
}

} // namespace

Result<SelfCheck, Refusal> run_self_check(Options options)
{
    options.devices.clear();
    options.report_paths.clear();
    options.duration_s = static_cast<double>(InjectionPlan::kFrames + InjectionPlan::kSpacing) /
                         static_cast<double>(options.rate_hz);
    InjectionJudge judge;
    for (int run = 0; run < InjectionJudge::kRunsMax && !judge.is_settled(); ++run)
    {
        if (auto error = run_spoilt(options, judge))
        {
            return *error;
        }
    }
    return judge.result();
}

std::string self_check_line(const SelfCheck& check)
{
    return fmt::format("{} of {} injected faults flagged as what they are, {} false flags{}{}",
                       check.flagged, check.injected, check.false_flags,
                       check.disturbed > 0
                           ? fmt::format("; the machine disturbed {} each time", check.disturbed)
                           : "",
                       check.allocations_counted ? "" : "; this build doesn't count allocations");
}

} // namespace tactus::hrtc
