// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/hrtc/cycle_measures.hpp"
#include "platform/latency_histogram.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::hrtc
{

/// What a cycle did or met.
enum class CycleFlag : std::uint16_t
{
    none = 0,
    page_fault = 1U << 0U,    ///< The loop touched memory that wasn't there.
    allocation = 1U << 1U,    ///< It called on the heap.
    gave_way = 1U << 2U,      ///< It slept or waited, besides the timer's own sleeps.
    system_call = 1U << 3U,   ///< The frame called the system; seen while calls are trapped.
    over_work = 1U << 4U,     ///< The frame did more than its budgets allow.
    over_cpu = 1U << 5U,      ///< It took more than kCpuShare of the period in processor time.
    repeated_cpu = 1U << 6U,  ///< And again when it was repeated.
    acquitted_cpu = 1U << 7U, ///< And never again when it was repeated.
    woken_late = 1U << 8U,    ///< By more than kMachineShare.
    held_up = 1U << 9U,       ///< It had no processor for more than kMachineShare.
    missed = 1U << 10U,       ///< It ended after the next deadline, or deadlines had gone by before
                              ///< it, other than by the end of the cycle before.
};
inline constexpr std::size_t kCycleFlags = 11;
/// In the order of the bits.
inline constexpr std::array<const char*, kCycleFlags> kCycleFlagNames{
    "page_fault",   "allocation",    "gave_way",   "system_call", "over_work", "over_cpu",
    "repeated_cpu", "acquitted_cpu", "woken_late", "held_up",     "missed"};

[[nodiscard]] constexpr CycleFlag operator|(CycleFlag a, CycleFlag b) noexcept
{
    return static_cast<CycleFlag>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}

[[nodiscard]] constexpr bool has_any(CycleFlag of, CycleFlag wanted) noexcept
{
    return (static_cast<unsigned>(of) & static_cast<unsigned>(wanted)) != 0;
}

/// What the loop must not do, each by itself our own fault, deadline or not.
inline constexpr CycleFlag kOwnFaults = CycleFlag::page_fault | CycleFlag::allocation |
                                        CycleFlag::gave_way | CycleFlag::system_call |
                                        CycleFlag::over_work | CycleFlag::repeated_cpu;
/// What the machine takes from a frame. Processor time over the budget that no repetition takes
/// again is the machine's, too: the clock of a thread also runs for interrupts, and on a shared
/// machine for what other guests take.
inline constexpr CycleFlag kMachinesDoing =
    CycleFlag::woken_late | CycleFlag::held_up | CycleFlag::acquitted_cpu;

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

/// Whose fault it was when a cycle went wrong: ours, when the loop did what it must not do, whether
/// or not the deadline was met; the machine's, when a deadline was missed without that and it woke
/// or held up the loop.
///
/// Filled by the haptic thread without allocating; read by others, and settled, once the loop has
/// ended.
class DeadlineAccount
{
public:
    /// Of the period: processor time from which on a frame is under suspicion.
    static constexpr double kCpuShare = 0.8;
    /// Longer than this, or than that share of a short period, and the machine was at it.
    static constexpr Duration kMachineTime = microseconds(300);
    static constexpr double kMachineShare = 0.3;
    /// Cycles kept to be told of, and suspects; later ones are counted only.
    static constexpr std::size_t kNotedMax = 4'096;
    static constexpr std::size_t kSuspectsMax = 16'384;

    explicit DeadlineAccount(Duration period);

    /// `over_work`: the frame's counters exceed their caps.
    void add(std::uint64_t frame, const CycleMeasures& measures, bool over_work) noexcept;

    /// Frames under suspicion for their processor time alone, ascending: to be repeated. Fewer than
    /// `suspected` when there was no room for more.
    [[nodiscard]] std::vector<std::uint64_t> suspects() const;
    /// All suspects have been repeated. Those in `over` (ascending) were over the budget again and
    /// are our own fault after all; the others' processor time was the machine's. Once.
    void settle(std::span<const std::uint64_t> over) noexcept;

    /// From the deadline to the force written; deadlines whose frame never ran got the force of the
    /// next that did (LatencyHistogram::corrected()).
    [[nodiscard]] LatencyHistogram response() const;

    [[nodiscard]] std::uint64_t cycles_with(CycleFlag flag) const noexcept
    {
        return flagged[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(flag)))];
    }
    [[nodiscard]] Duration period() const noexcept { return period_; }
    [[nodiscard]] Duration cpu_limit() const noexcept { return cpu_limit_; }
    [[nodiscard]] std::span<const NotedCycle> noted() const noexcept { return noted_; }

    std::uint64_t missed{0};
    std::uint64_t own_faults{0};   ///< Cycles.
    std::uint64_t machine_late{0}; ///< Missed deadlines.
    std::uint64_t unexplained{0};  ///< Missed deadlines that are neither, or not settled yet.
    std::uint64_t suspected{0};    ///< Cycles that had to be repeated to be judged.
    std::uint64_t not_kept{0};     ///< Cycles worth telling of that are not in noted().
    std::array<std::uint64_t, kCycleFlags> flagged{}; ///< Cycles with each flag.
    std::uint64_t allocations{0};
    std::uint64_t page_faults{0};
    system_call_trap::TrappedCalls calls;

private:
    [[nodiscard]] CycleFlag flags_of(const CycleMeasures& measures, bool over_work) const noexcept;
    void count(CycleFlag flags, std::uint64_t sign) noexcept;
    void note(const NotedCycle& cycle) noexcept;

    Duration period_;
    Duration cpu_limit_;
    Duration machine_limit_;
    std::int64_t own_losses_{0}; ///< Deadlines that went by before the last cycle's end; its own.
    struct Suspect
    {
        std::uint64_t frame{0};
        CycleFlag flags{CycleFlag::none};
    };
    std::vector<Suspect> suspects_;
    std::vector<NotedCycle> noted_;
    LatencyHistogram in_turn_;    ///< Responses of frames whose own deadline came next.
    LatencyHistogram after_loss_; ///< To the first of the deadlines that went by before one.
};

} // namespace tactus::hrtc
