// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "platform/hrtc/deadline_account.hpp"
#include "platform/hrtc/messages.hpp"
#include "platform/hrtc/options.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// What the loop must not do, done to it on purpose.
enum class InjectedFault : std::uint8_t
{
    overrun,    ///< More processor time than a period.
    page_fault, ///< A page that isn't there is touched.
    allocation, ///< A call on the heap.
    sleep,      ///< The processor is given away.
};
inline constexpr std::size_t kInjectedFaults = 4;

/// Which frames of a self-check are spoilt, and how.
struct InjectionPlan
{
    static constexpr std::uint64_t kFirst = 100;
    static constexpr std::uint64_t kSpacing = 23; ///< Frames; what one costs is over by the next.
    static constexpr std::uint64_t kOfEachKind = 5;
    static constexpr std::uint64_t kFrames = kFirst + kInjectedFaults * kOfEachKind * kSpacing;

    [[nodiscard]] static std::optional<InjectedFault> at(std::uint64_t frame) noexcept;
};

/// Does it on the calling thread. `period`: of the loop.
void inject(InjectedFault fault, Duration period) noexcept;

/// What a self-check came to.
struct SelfCheck
{
    std::uint64_t injected{0};
    std::uint64_t flagged{0};       ///< Of these, as what they were.
    std::uint64_t false_flags{0};   ///< Own faults in frames that were not spoilt.
    bool allocations_counted{true}; ///< False: this build can't, and none was injected.
    std::uint64_t disturbed{0}; ///< Not flagged, in frames that the machine disturbed each time.
    bool has_each_kind{true};   ///< One of each kind was flagged.

    [[nodiscard]] bool is_passed() const noexcept
    {
        return injected > 0 && has_each_kind && flagged + disturbed == injected && false_flags == 0;
    }
};

/// Compares what the accounts of runs that were spoilt by the plan have flagged with the plan. A
/// thread that is held up misses a sleep of its own, which hides one that is injected: what was not
/// flagged in a frame that the machine disturbed is judged by the next run.
class InjectionJudge
{
public:
    static constexpr int kRunsMax = 3;

    InjectionJudge();

    /// Settles the suspects of one run, by doing to them again what the plan did, and judges what
    /// is left to judge. `reads`: when each frame's device was read, as far as that is known.
    void judge(DeadlineAccount& deadlines, std::span<const MonotonicTime> reads);

    [[nodiscard]] bool is_settled() const noexcept { return open_.empty(); }
    [[nodiscard]] SelfCheck result() const;

private:
    SelfCheck check_;
    std::vector<std::uint64_t> open_; ///< Spoilt frames that are not judged yet, ascending.
    std::array<bool, kInjectedFaults> seen_{};
};

/// Whether that frame or its way there was longer or shorter than a period by a tenth.
[[nodiscard]] bool is_disturbed(std::uint64_t frame, std::span<const MonotonicTime> reads,
                                Duration period) noexcept;

/// Proof that the accounting sees what it has to see: a short run as the options have it, with
/// simulated devices, in which each fault is injected InjectionPlan::kOfEachKind times, and again
/// for what the machine disturbed, InjectionJudge::kRunsMax times in all.
[[nodiscard]] Result<SelfCheck, Refusal> run_self_check(Options options);

[[nodiscard]] std::string self_check_line(const SelfCheck& check);

} // namespace tactus::hrtc
