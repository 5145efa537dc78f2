// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/messages.hpp"
#include "platform/choices/run_options.hpp"
#include "platform/loop/deadline_account.hpp"
#include "platform/machine/time.hpp"
#include "platform/recording/recording.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// Fault that the loop must not have, injected on purpose.
enum class InjectedFault : std::uint8_t
{
    overwork,   ///< More arithmetic than fits into a period.
    page_fault, ///< Access to a page that isn't mapped yet.
    allocation, ///< Allocation on the heap.
    sleep,      ///< Sleep, which yields the processor.
};
inline constexpr std::size_t kInjectedFaults = 4;
/// Names in the order of InjectedFault.
inline constexpr std::array<const char*, kInjectedFaults> kInjectedFaultNames{
    "overwork", "page fault", "allocation", "sleep"};

/// Plan of the frames of a self-check into which faults are injected.
struct InjectionPlan
{
    static constexpr std::uint64_t kFirst = 100;
    static constexpr std::uint64_t kSpacing = 23; ///< Frames between two faults, enough for the
                                                  ///< effects of one to end.
    static constexpr std::uint64_t kOfEachKind = 5;
    static constexpr std::uint64_t kFrames = kFirst + kInjectedFaults * kOfEachKind * kSpacing;

    [[nodiscard]] static std::optional<InjectedFault> at(std::uint64_t frame) noexcept;
};

/// Injects faults on the calling thread. The amount of overwork is measured in the constructor and
/// is the same each time.
class FaultInjector
{
public:
    explicit FaultInjector(Duration period);
    void inject(InjectedFault fault) const noexcept;

private:
    std::uint64_t overwork_steps_;
};

/// Result of a self-check.
struct SelfCheck
{
    std::uint64_t injected{0};
    std::uint64_t flagged{0};              ///< Faults flagged as their own kind.
    std::uint64_t false_flags{0};          ///< Overruns in frames without a fault.
    bool allocations_counted{true};        ///< False if this build can't count them, so that none
                                           ///< was injected.
    std::optional<std::uint64_t> unseen{}; ///< First frame whose fault was not flagged as its kind.

    [[nodiscard]] bool is_passed() const noexcept
    {
        return injected > 0 && flagged == injected && false_flags == 0;
    }
};

/// Compares the flags of a run with injected faults to the plan. Before that, each suspected frame
/// is judged: its planned fault is injected again.
[[nodiscard]] SelfCheck judge_injections(DeadlineAccount& deadlines, const FaultInjector& injector);

/// Proves that the account of deadlines detects faults. A short run with the options and simulated
/// devices injects each fault InjectionPlan::kOfEachKind times.
[[nodiscard]] Result<SelfCheck, Refusal> run_self_check(Options options);

[[nodiscard]] std::string self_check_line(const SelfCheck& check);

/// Most repetitions of a suspected frame. Work that takes too long does so each time. A delay by
/// the machine does not occur each time, and never shortens the work.
inline constexpr int kRepetitions = 5;

/// Replays a run. Returns those of the frames `suspects` (ascending) that took more than `limit` of
/// processor time in each of kRepetitions. Refused if the recording can't be replayed, if a replay
/// differs, or if a suspect is missing in the recording.
[[nodiscard]] Result<std::vector<std::uint64_t>, std::string>
frames_over_again(const Recording& recording, std::span<const std::uint64_t> suspects,
                  Duration limit);

} // namespace tactus::hrtc
