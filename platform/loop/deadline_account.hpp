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

/// What a cycle did or met.
enum class CycleFlag : std::uint16_t
{
    none = 0,
    page_fault = 1U << 0U,  ///< The loop touched memory that wasn't there.
    allocation = 1U << 1U,  ///< It called on the heap.
    gave_way = 1U << 2U,    ///< It slept or waited, besides the timer's own sleeps.
    system_call = 1U << 3U, ///< The frame called the system; seen while calls are trapped.
    over_work = 1U << 4U,   ///< The frame did more than its budgets allow.
    over_cpu = 1U << 5U,    ///< It took more than kCpuShare of the period in processor time.
    slowed = 1U << 6U,      ///< It took as much, and its work was shown to need less.
    stopped = 1U << 7U,     ///< The process was stopped from outside, and continued.
    woken_late = 1U << 8U,  ///< By more than kMachineShare.
    held_up = 1U << 9U,     ///< It had no processor for more than kMachineShare.
    missed = 1U << 10U,     ///< It ended after the next deadline, or deadlines had gone by before
                            ///< it, other than by the end of the cycle before.
};
inline constexpr std::size_t kCycleFlags = 11;
/// In the order of the bits.
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

/// What the loop must not do, each by itself our own fault, deadline or not.
inline constexpr CycleFlag kOwnFaults = CycleFlag::page_fault | CycleFlag::allocation |
                                        CycleFlag::gave_way | CycleFlag::system_call |
                                        CycleFlag::over_work | CycleFlag::over_cpu;

/// One cycle worth telling of.
struct NotedCycle
{
    std::uint64_t frame{0};
    CycleFlag flags{CycleFlag::none};
    Duration wake_lateness;
    Duration frame_time;
    Duration cpu;
    Duration lateness_of_end;
};

/// Whose fault it was when a cycle went wrong. It is our own when the loop did what it must not do,
/// whether or not the deadline was met. Any other missed deadline has the stop as its cause when
/// the process was stopped from outside, and else the machine.
///
/// Too much processor time is our own fault unless the same work is shown to need less: the clock
/// of a thread also runs for interrupts, and on a shared machine for what other guests take. The
/// run itself shows it, where a frame with as much counted work took at most kShownShare of the
/// limit, or one with a part of it as small a part of that; or a repetition of the very frame does,
/// which the caller reports by settle().
///
/// Filled by the haptic thread without allocating; read by others, and settled, once the loop has
/// ended.
class DeadlineAccount
{
public:
    /// The part of the period that a frame's processor time may take. Where the deadline was
    /// missed, the loop's work beside the frame counts as well.
    static constexpr double kCpuShare = 0.8;
    /// A frame whose time, with the work beside it, is at most this part of the limit shows that
    /// its amount of work fits. One is enough, since nothing makes the same work faster than it is.
    static constexpr double kShownShare = 0.5;
    /// A frame that took half or a quarter of that shows twice or this many times its work to fit:
    /// counted work takes time in proportion, and what a frame takes besides is in it once more.
    static constexpr std::int64_t kShownTimes = 4;
    /// Longer than this, or than that share of a short period, and the machine was at it.
    static constexpr Duration kMachineTime = microseconds(300);
    static constexpr double kMachineShare = 0.3;
    /// Cycles kept to be told of, and suspects; later ones are counted only, and later suspects
    /// judged by what the run had shown before them.
    static constexpr std::size_t kNotedMax = 4'096;
    static constexpr std::size_t kSuspectsMax = 16'384;

    explicit DeadlineAccount(Duration period);

    /// `work`: what the frame's counters come to, in one unit for all frames.
    /// `over_work`: the counters exceed their caps.
    void add(std::uint64_t frame, const CycleMeasures& measures, std::uint64_t work,
             bool over_work) noexcept;

    /// The loop has ended: frames after a suspect may show its work to fit, too.
    void compare_work() noexcept;
    /// Frames that took too much processor time and have no other own fault, ascending.
    [[nodiscard]] std::vector<std::uint64_t> suspects() const;
    /// The suspects have been repeated. Those in `over` (ascending) are our own fault, and the
    /// others the machine's.
    void settle(std::span<const std::uint64_t> over) noexcept;

    /// From the deadline to the force written; deadlines whose frame never ran got the force of the
    /// next that did (LatencyHistogram::corrected()).
    [[nodiscard]] LatencyHistogram response() const;

    [[nodiscard]] std::uint64_t cycles_with(CycleFlag flag) const noexcept
    {
        return flagged[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(flag)))];
    }
    /// What Frame::run() may take, with what the loop and the devices take beside it in the median.
    [[nodiscard]] Duration repetition_limit() const { return cpu_limit_ - outside_.quantile(0.5); }
    [[nodiscard]] std::span<const NotedCycle> noted() const noexcept { return noted_; }

    std::uint64_t missed{0};
    std::uint64_t own_faults{0};   ///< Cycles, missed or not.
    std::uint64_t machine_late{0}; ///< Missed deadlines.
    std::uint64_t stopped{0};      ///< Likewise.
    std::uint64_t not_kept{0};     ///< Cycles worth telling of that are not in noted().
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
    std::int64_t own_losses_{0}; ///< Deadlines that went by before the last cycle's end; its own.
    std::optional<std::uint64_t> shown_work_; ///< The most that was shown to fit.
    std::vector<Suspect> suspects_;
    std::vector<NotedCycle> noted_;
    LatencyHistogram in_turn_;    ///< Responses of frames whose own deadline came next.
    LatencyHistogram after_loss_; ///< To the first of the deadlines that went by before one.
    LatencyHistogram outside_;    ///< CycleMeasures::outside.
};

} // namespace tactus::hrtc
