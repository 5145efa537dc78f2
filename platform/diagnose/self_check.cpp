// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/self_check.hpp"

#include "platform/controller/controller.hpp"
#include "platform/controller/finished_run.hpp"
#include "platform/controller/session.hpp"
#include "platform/devices/wrapped_device.hpp"
#include "platform/machine/allocation_counter.hpp"
#include "platform/machine/thread_usage.hpp"
#include "platform/options/options.hpp"
#include "platform/program/run_program.hpp"
#include "platform/recording/replay.hpp"
#include "transport/base/number_form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <map>
#include <memory>
#include <set>
#include <sys/mman.h>

namespace tactus::hrtc
{

Result<std::vector<std::uint64_t>, std::string>
frames_over_again(const Recording& recording, std::span<const std::uint64_t> suspects,
                  Duration limit)
{
    std::set<std::uint64_t> over(suspects.begin(), suspects.end());
    Duration before;
    const ReplayWatch watch{
        [&before](std::uint64_t) { before = read_thread_cpu_time(); },
        [&](std::uint64_t frame, const RecordedFrame& /*unused*/, const FrameOutput& /*unused*/)
        {
            if (read_thread_cpu_time() - before <= limit)
            {
                over.erase(frame);
            }
        }};
    for (int i = 0; i < kRepetitions && !over.empty(); ++i)
    {
        const auto replayed = replay(recording, nullptr, watch);
        if (!replayed)
        {
            return replayed.error().text;
        }
        if (replayed.value().difference)
        {
            return replay_line(recording, replayed.value());
        }
        if (suspects.back() >= replayed.value().frames)
        {
            return fmt::format("frame {} is not in the recording of {} frames", suspects.back(),
                               replayed.value().frames);
        }
    }
    return std::vector<std::uint64_t>(over.begin(), over.end());
}

namespace
{

constexpr std::size_t kPageBytes = 4'096;
constexpr long kSleep_ns = 20'000;

void touch_new_page() noexcept
{
    void* page = mmap(nullptr, kPageBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1,
                      0); // With locked memory the page fault is here, else at the first write.
    if (page != MAP_FAILED)
    {
        *static_cast<volatile char*>(page) = 1;
        munmap(page, kPageBytes);
    }
}

/// Sleeps until the processor was really yielded: twice, as one switch may count as the wait of a
/// page fault of the frame. On a waiting virtual machine, a sleep may end before it begins and
/// yield nothing.
void give_way() noexcept
{
    constexpr int kTriesMax = 100;
    const std::int64_t wanted = read_thread_usage().voluntary_switches + 2;
    for (int i = 0; i < kTriesMax && read_thread_usage().voluntary_switches < wanted; ++i)
    {
        const timespec time{0, kSleep_ns};
        nanosleep(&time, nullptr);
    }
}

/// Chain of multiplications that no compiler omits.
void work(std::uint64_t steps) noexcept
{
    volatile std::uint64_t result = 1;
    std::uint64_t value = result;
    for (std::uint64_t i = 0; i < steps; ++i)
    {
        value = value * 6'364'136'223'846'793'005U + i;
    }
    result = value;
}

/// Steps of work() that fill two periods at the best measured pace. They take longer on a machine
/// that is slow at times, and exceed the limit even if the machine becomes almost twice as fast.
std::uint64_t steps_of_overwork(Duration period)
{
    constexpr std::uint64_t kSteps = 20'000;
    constexpr int kTries = 50;
    Duration least = milliseconds(1'000);
    for (int i = 0; i < kTries; ++i)
    {
        const Duration before = read_thread_cpu_time();
        work(kSteps);
        least = std::min(least, read_thread_cpu_time() - before);
    }
    return 2 * kSteps * static_cast<std::uint64_t>(period.ns) /
           static_cast<std::uint64_t>(std::max<std::int64_t>(least.ns, 1));
}

/// Device whose readings inject the faults of the plan; otherwise unchanged.
class SpoilingDevice final : public WrappedDevice
{
public:
    SpoilingDevice(std::unique_ptr<HapticDevice> device, const FaultInjector& injector)
        : WrappedDevice(std::move(device)), injector_(injector)
    {
    }
    [[nodiscard]] DeviceSample read() noexcept override
    {
        if (const auto fault = InjectionPlan::at(frame_++))
        {
            injector_.inject(*fault);
        }
        return WrappedDevice::read();
    }

private:
    FaultInjector injector_;
    std::uint64_t frame_{0};
};

/// Flag that an injected fault must cause.
CycleFlag flag_of(InjectedFault fault) noexcept
{
    switch (fault)
    {
    case InjectedFault::overwork:
        return CycleFlag::over_cpu;
    case InjectedFault::page_fault:
        return CycleFlag::page_fault;
    case InjectedFault::allocation:
        return CycleFlag::allocation;
    case InjectedFault::sleep:
        return CycleFlag::gave_way;
    }
    return CycleFlag::none;
}

/// True if the plan's fault in this frame takes more than `limit` each time.
bool is_over_again(std::uint64_t frame, Duration limit, const FaultInjector& injector)
{
    const auto fault = InjectionPlan::at(frame);
    for (int i = 0; fault && i < kRepetitions; ++i)
    {
        const Duration before = read_thread_cpu_time();
        injector.inject(*fault);
        if (read_thread_cpu_time() - before <= limit)
        {
            return false;
        }
    }
    return fault.has_value();
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

FaultInjector::FaultInjector(Duration period) : overwork_steps_(steps_of_overwork(period)) {}

void FaultInjector::inject(InjectedFault fault) const noexcept
{
    switch (fault)
    {
    case InjectedFault::overwork:
        work(overwork_steps_);
        return;
    case InjectedFault::page_fault:
        touch_new_page();
        return;
    case InjectedFault::allocation:
    {
        void* volatile memory = std::malloc(1); // Volatile, else the compiler omits the unused
                                                // block.
        std::free(memory);
        return;
    }
    case InjectedFault::sleep:
        give_way();
        return;
    }
}

SelfCheck judge_injections(DeadlineAccount& deadlines, const FaultInjector& injector)
{
    const Duration limit = deadlines.repetition_limit();
    std::vector<std::uint64_t> over = deadlines.suspects();
    std::erase_if(over,
                  [&](std::uint64_t frame) { return !is_over_again(frame, limit, injector); });
    deadlines.settle(over);
    std::map<std::uint64_t, CycleFlag> noted;
    for (const NotedCycle& cycle : deadlines.noted())
    {
        noted[cycle.frame] = cycle.flags;
    }
    SelfCheck check;
    check.allocations_counted = allocation_counter::available();
    for (const auto& [frame, flags] : noted)
    {
        check.false_flags += !InjectionPlan::at(frame) && has_any(flags, kOverruns) ? 1U : 0U;
    }
    for (std::uint64_t frame = 0; frame < InjectionPlan::kFrames; ++frame)
    {
        if (const auto fault = InjectionPlan::at(frame))
        {
            const bool is_flagged = has_any(noted[frame], flag_of(*fault));
            check.injected += 1;
            check.flagged += is_flagged ? 1U : 0U;
            check.unseen = is_flagged || check.unseen ? check.unseen : std::optional(frame);
        }
    }
    return check;
}

Result<SelfCheck, Refusal> run_self_check(Options options)
{
    for (ToolOptions& tool : options.tools)
    {
        tool.device = {}; // Simulated device.
    }
    options.report_paths.clear();
    options.duration_s = static_cast<double>(InjectionPlan::kFrames + InjectionPlan::kSpacing) /
                         static_cast<double>(options.rate_hz);
    auto session = Session::open(options, program_hooks());
    if (!session)
    {
        return session.error();
    }
    const FaultInjector injector(options.period());
    std::unique_ptr<HapticDevice>& device = session.value()->controller().tools().front().device;
    device = std::make_unique<SpoilingDevice>(std::move(device), injector);
    auto run = session.value()->run("self-check");
    if (!run)
    {
        return run.error();
    }
    if (is_stop_requested())
    {
        return interruption();
    }
    return judge_injections(run.value().statistics.deadlines, injector);
}

std::string self_check_line(const SelfCheck& check)
{
    const auto fault = check.unseen ? InjectionPlan::at(*check.unseen) : std::nullopt;
    return fmt::format("{} of {} injected faults flagged correctly, {}{}{}", check.flagged,
                       check.injected, counted(check.false_flags, "false flag"),
                       fault ? fmt::format("; missed in frame {}: {}", *check.unseen,
                                           kInjectedFaultNames[static_cast<std::size_t>(*fault)])
                             : "",
                       check.allocations_counted ? "" : "; this build doesn't count allocations");
}

} // namespace tactus::hrtc
