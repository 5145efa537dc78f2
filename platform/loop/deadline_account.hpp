// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/latency_histogram.hpp"
#include "platform/machine/periodic_timer.hpp"
#include "platform/machine/system_call_trap.hpp"
#include "platform/machine/thread_usage.hpp"
#include "rt_core/records/frame_input.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus::hrtc
{

/// Measures of one cycle of the loop besides the frame's own output.
struct CycleMeasures
{
    Cycle cycle;
    Budgets budgets;
    bool is_work_at_floor{false}; ///< True if the work budget can't be lower.
    std::array<Duration, kStages> stage;
    Duration frame;      ///< Time from the start of the frame to the force written.
    Duration cpu;        ///< Processor time of the thread in `frame`.
    Duration outside;    ///< Part of `frame` outside Frame::run(): devices and safety.
    Duration beside;     ///< Time for bookkeeping and cache warming between frames.
    Duration beside_cpu; ///< Processor time in `beside`.
    /// Time from the frame's deadline to its end; missed above one period.
    Duration lateness_of_end;
    ThreadUsage usage; ///< Usage since the last cycle, without switches of the timer's sleeps.
    bool was_stopped{false}; ///< True if the process was stopped from outside since the last cycle.
    std::uint64_t allocations{0};         ///< Allocations since the last cycle.
    system_call_trap::TrappedCalls calls; ///< Trapped system calls since the loop began.
};

/// Events of a cycle of the loop, one bit each.
enum class CycleFlag : std::uint16_t
{
    none = 0,
    page_fault = 1U << 0U, ///< The loop touched memory that was not resident.
    allocation = 1U << 1U, ///< The loop called the heap.
    /// The loop slept or waited outside the timer's sleeps. A page fault may wait for a page that
    /// the kernel moves, which Linux counts as a voluntary switch: one a fault is not counted.
    gave_way = 1U << 2U,
    system_call = 1U << 3U, ///< The frame made a system call; set only with --trap-system-calls.
    over_work = 1U << 4U,   ///< The frame did more than its budgets allow.
    over_cpu = 1U << 5U,    ///< The frame took more than kCpuShare of the period in processor time.
    slowed = 1U << 6U,      ///< The frame exceeded kCpuShare, but its work was shown to fit.
    stopped = 1U << 7U,     ///< The process was stopped from outside, and continued.
    woken_late = 1U << 8U,  ///< The loop woke later than kMachineTime or kMachineShare allows.
    held_up = 1U << 9U,     ///< The loop had no processor for longer than those allow.
    /// The cycle ended after the next deadline, or deadlines were lost before it beyond those that
    /// the last cycle's late end explains.
    missed = 1U << 10U,
};
inline constexpr std::size_t kCycleFlags = 11;
/// Names of the flags, in the order of CycleFlag's bits.
inline constexpr std::array<const char*, kCycleFlags> kCycleFlagNames{
    "page_fault", "allocation", "gave_way",   "system_call", "over_work", "over_cpu",
    "slowed",     "stopped",    "woken_late", "held_up",     "missed"};

[[nodiscard]] constexpr CycleFlag operator|(CycleFlag a, CycleFlag b) noexcept
{
    return static_cast<CycleFlag>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}

[[nodiscard]] constexpr CycleFlag without(CycleFlag flags, CycleFlag removed) noexcept
{
    return static_cast<CycleFlag>(static_cast<unsigned>(flags) & ~static_cast<unsigned>(removed));
}

[[nodiscard]] constexpr bool has_any(CycleFlag of, CycleFlag wanted) noexcept
{
    return (static_cast<unsigned>(of) & static_cast<unsigned>(wanted)) != 0;
}

/// Events that are overruns of the loop itself, even if the deadline was met.
inline constexpr CycleFlag kOverruns = CycleFlag::page_fault | CycleFlag::allocation |
                                       CycleFlag::gave_way | CycleFlag::system_call |
                                       CycleFlag::over_work | CycleFlag::over_cpu;

/// Cycle noted for the report: it missed its deadline, overran or was slowed.
struct NotedCycle
{
    std::uint64_t frame{0};
    CycleFlag flags{CycleFlag::none};
    Duration wake_lateness;
    Duration frame_time;
    Duration cpu;
    Duration lateness_of_end;
};

/// Attributes each failed cycle to its cause. A cycle with a flag of kOverruns is an overrun, even
/// if the deadline was met. Any other missed deadline is attributed to the stop if the process was
/// stopped from outside, otherwise to the machine.
///
/// Too much processor time is an overrun unless the same work is shown to need less. The clock of a
/// thread also runs for interrupts, and on a shared machine for the time taken by other guests. A
/// frame with at least as much counted work in at most kShownShare of the limit shows that the work
/// fits. A faster frame shows this for a multiple of its work (kShownTimes). A repetition of the
/// frame shows it, too; the caller reports the result by settle().
///
/// The haptic thread fills the account without allocating. Other threads read and settle it once
/// the loop has ended.
class DeadlineAccount
{
public:
    /// Share of the period that a frame's processor time may take. If the deadline was missed, the
    /// loop's work beside the frame counts as well.
    static constexpr double kCpuShare = 0.8;
    /// Share of kCpuShare's limit. A frame whose processor time, with the loop's work beside it, is
    /// at most this shows that its amount of work fits: nothing speeds up the same work.
    static constexpr double kShownShare = 0.5;
    /// Largest n for which a frame within 1/n of kShownShare's time shows n times its work to fit.
    /// Counted work takes time in proportion, and the frame's other costs are then counted n times.
    static constexpr std::int64_t kShownTimes = 4;
    /// A delay above the smaller of kMachineTime and kMachineShare of the period is attributed to
    /// the machine.
    static constexpr Duration kMachineTime = microseconds(300);
    static constexpr double kMachineShare = 0.3;
    /// Capacities for noted cycles and for suspects. Later cycles are counted but not listed; later
    /// suspects keep the verdict of add().
    static constexpr std::size_t kNotedMax = 4'096;
    static constexpr std::size_t kSuspectsMax = 16'384;

    explicit DeadlineAccount(Duration period);

    /// Adds the cycle of a frame. `work`: the frame's counted work, in one unit for all frames.
    /// `over_work`: true if a counter exceeds its budget.
    void add(std::uint64_t frame, const CycleMeasures& measures, std::uint64_t work,
             bool over_work) noexcept;

    /// Judges the suspects again by all frames, since frames after a suspect may show its work to
    /// fit, too. Call it once the loop has ended.
    void compare_work() noexcept;
    /// Suspects: numbers of the frames that took too much processor time and have no other overrun,
    /// ascending.
    [[nodiscard]] std::vector<std::uint64_t> suspects() const;
    /// Judges the suspects by a repetition of their frames. Frames in `over` (numbers, ascending)
    /// are overruns; those of the other suspects are attributed to the machine.
    void settle(std::span<const std::uint64_t> over) noexcept;

    /// Times from each deadline to the force written. A deadline whose frame never ran is answered
    /// by the next frame's force (LatencyHistogram::corrected()).
    [[nodiscard]] LatencyHistogram response() const;

    [[nodiscard]] std::uint64_t cycles_with(CycleFlag flag) const noexcept
    {
        return flagged[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(flag)))];
    }
    /// Largest processor time for a repeated Frame::run(): the limit of a cycle minus the median
    /// time of devices and safety.
    [[nodiscard]] Duration repetition_limit() const { return cpu_limit_ - outside_.quantile(0.5); }
    [[nodiscard]] std::span<const NotedCycle> noted() const noexcept { return noted_; }

    std::uint64_t missed{0};
    std::uint64_t overruns{0};       ///< Cycles with an overrun, missed or not.
    std::uint64_t latency_misses{0}; ///< Missed deadlines without an overrun or a stop.
    /// Missed deadlines without an overrun while the process was stopped.
    std::uint64_t stopped{0};
    std::uint64_t not_kept{0}; ///< Cycles to be listed for which noted() had no room.
    std::array<std::uint64_t, kCycleFlags> flagged{}; ///< Cycles with each flag.
    std::uint64_t allocations{0};
    std::uint64_t page_faults{0};
    system_call_trap::TrappedCalls calls;

private:
    struct Suspect
    {
        std::uint64_t frame{0};
        std::uint64_t work{0};
        CycleFlag flags{CycleFlag::none};
    };

    [[nodiscard]] CycleFlag flags_of(const CycleMeasures& measures, bool over_work) const noexcept;
    [[nodiscard]] std::uint64_t times_shown(Duration time) const noexcept;
    [[nodiscard]] bool is_shown(std::uint64_t work) const noexcept
    {
        return shown_work_ && work <= *shown_work_;
    }
    void judge(Suspect& suspect, bool is_slowed) noexcept;
    void count(CycleFlag flags, std::uint64_t sign) noexcept;
    void note(const NotedCycle& cycle) noexcept;

    Duration period_;
    Duration cpu_limit_;
    Duration machine_limit_;
    /// Number of deadlines that passed because the last cycle ended late.
    std::int64_t own_losses_{0};
    /// Most work shown to fit; none: no frame has shown any.
    std::optional<std::uint64_t> shown_work_;
    std::vector<Suspect> suspects_;
    std::vector<NotedCycle> noted_;
    LatencyHistogram in_turn_; ///< Responses of frames without a lost deadline before.
    /// Responses of frames after lost deadlines, measured from the first lost deadline.
    LatencyHistogram after_loss_;
    LatencyHistogram outside_; ///< Histogram of CycleMeasures::outside.
};

} // namespace tactus::hrtc
