// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/cycle_measures.hpp"
#include "platform/machine/latency_histogram.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus::hrtc
{

/// Events of a cycle.
enum class CycleFlag : std::uint16_t
{
    none = 0,
    page_fault = 1U << 0U,  ///< The loop touched memory that was not resident.
    allocation = 1U << 1U,  ///< The loop called the heap.
    gave_way = 1U << 2U,    ///< The loop slept or waited outside the timer's sleeps.
    system_call = 1U << 3U, ///< The frame made a system call; seen while calls are trapped.
    over_work = 1U << 4U,   ///< The frame did more than its budgets allow.
    over_cpu = 1U << 5U,    ///< The frame took more than kCpuShare of the period in processor time.
    slowed = 1U << 6U,      ///< The frame exceeded it, but its work was shown to need less.
    stopped = 1U << 7U,     ///< The process was stopped from outside, and continued.
    woken_late = 1U << 8U,  ///< The loop woke late by more than kMachineShare.
    held_up = 1U << 9U,     ///< The loop had no processor for more than kMachineShare.
    /// The cycle ended after the next deadline, or deadlines had passed before it for another
    /// reason than the end of the cycle before.
    missed = 1U << 10U,
};
inline constexpr std::size_t kCycleFlags = 11;
/// Names in the order of the bits.
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

/// A cycle to be listed.
struct NotedCycle
{
    std::uint64_t frame{0};
    CycleFlag flags{CycleFlag::none};
    Duration wake_lateness;
    Duration frame_time;
    Duration cpu;
    Duration lateness_of_end;
};

/// Attributes each failed cycle to its cause: an overrun if a flag of kOverruns is set, even if
/// the deadline was met. Any other missed deadline is attributed to the stop if the process was
/// stopped from outside, otherwise to the machine.
///
/// Too much processor time is an overrun unless the same work is shown to need less: the clock of a
/// thread also runs for interrupts, and on a shared machine for the time taken by other guests. The
/// run shows it by a frame with as much counted work in at most kShownShare of the limit, or with a
/// fraction of it in the same fraction of that time. A repetition of the frame shows it, too; the
/// caller reports that by settle().
///
/// Filled by the haptic thread without allocating; read by others, and settled, once the loop has
/// ended.
class DeadlineAccount
{
public:
    /// Share of the period that a frame's processor time may take. If the deadline was missed, the
    /// loop's work beside the frame counts as well.
    static constexpr double kCpuShare = 0.8;
    /// A frame whose time, with the work beside it, is at most this part of the limit shows that
    /// its amount of work fits. One such frame suffices, since nothing speeds up the same work.
    static constexpr double kShownShare = 0.5;
    /// A frame that took half or a quarter of that shows twice or this many times its work to fit:
    /// counted work takes time in proportion, and the frame's other costs are then counted twice.
    static constexpr std::int64_t kShownTimes = 4;
    /// Delays above this, or above that share of a short period, are attributed to the machine.
    static constexpr Duration kMachineTime = microseconds(300);
    static constexpr double kMachineShare = 0.3;
    /// Capacity for noted cycles and suspects. Later cycles are only counted, and later suspects
    /// judged by the frames before them.
    static constexpr std::size_t kNotedMax = 4'096;
    static constexpr std::size_t kSuspectsMax = 16'384;

    explicit DeadlineAccount(Duration period);

    /// Adds a cycle. `work`: sum of the frame's counters, in one unit for all frames. `over_work`:
    /// the counters exceed their caps.
    void add(std::uint64_t frame, const CycleMeasures& measures, std::uint64_t work,
             bool over_work) noexcept;

    /// Call once the loop has ended: frames after a suspect may show its work to fit, too.
    void compare_work() noexcept;
    /// Frames that took too much processor time and have no other overrun, ascending.
    [[nodiscard]] std::vector<std::uint64_t> suspects() const;
    /// Records the repetition of the suspects. Those in `over` (ascending) are overruns, the others
    /// the machine's.
    void settle(std::span<const std::uint64_t> over) noexcept;

    /// Times from the deadline to the force written; a deadline whose frame never ran has the force
    /// of the next frame that did (LatencyHistogram::corrected()).
    [[nodiscard]] LatencyHistogram response() const;

    [[nodiscard]] std::uint64_t cycles_with(CycleFlag flag) const noexcept
    {
        return flagged[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(flag)))];
    }
    /// Limit of Frame::run(): the rest after the median time of loop and devices beside it.
    [[nodiscard]] Duration repetition_limit() const { return cpu_limit_ - outside_.quantile(0.5); }
    [[nodiscard]] std::span<const NotedCycle> noted() const noexcept { return noted_; }

    std::uint64_t missed{0};
    std::uint64_t overruns{0};       ///< Cycles with an overrun, missed or not.
    std::uint64_t latency_misses{0}; ///< Missed deadlines without an overrun.
    std::uint64_t stopped{0};        ///< Missed deadlines of a stopped process.
    std::uint64_t not_kept{0};       ///< Cycles to be listed that are not in noted().
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
    /// Deadlines that passed before the last cycle's end, by its overrun.
    std::int64_t own_losses_{0};
    std::optional<std::uint64_t> shown_work_; ///< Most work that was shown to fit.
    std::vector<Suspect> suspects_;
    std::vector<NotedCycle> noted_;
    LatencyHistogram in_turn_; ///< Responses of frames whose own deadline was next.
    /// Responses to the first of the deadlines that passed before a frame.
    LatencyHistogram after_loss_;
    LatencyHistogram outside_; ///< Histogram of CycleMeasures::outside.
};

} // namespace tactus::hrtc
