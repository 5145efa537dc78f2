// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/messages.hpp"
#include "platform/choices/run_options.hpp"
#include "platform/loop/deadline_account.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace tactus::hrtc
{

/// What the loop must not do, done to it on purpose.
enum class InjectedFault : std::uint8_t
{
    overwork,   ///< More arithmetic than a period has room for.
    page_fault, ///< A page that isn't there is touched.
    allocation, ///< A call on the heap.
    sleep,      ///< The processor is given away.
};
inline constexpr std::size_t kInjectedFaults = 4;
/// In the order of InjectedFault.
inline constexpr std::array<const char*, kInjectedFaults> kInjectedFaultNames{
    "overwork", "page fault", "allocation", "sleep"};

/// Which frames of a self-check are spoilt, and how.
struct InjectionPlan
{
    static constexpr std::uint64_t kFirst = 100;
    static constexpr std::uint64_t kSpacing = 23; ///< Frames; what one costs is over by the next.
    static constexpr std::uint64_t kOfEachKind = 5;
    static constexpr std::uint64_t kFrames = kFirst + kInjectedFaults * kOfEachKind * kSpacing;

    [[nodiscard]] static std::optional<InjectedFault> at(std::uint64_t frame) noexcept;
};

/// Does it on the calling thread. What is too much work is measured when this is made, and is the
/// same each time.
class FaultInjector
{
public:
    explicit FaultInjector(Duration period);
    void inject(InjectedFault fault) const noexcept;

private:
    std::uint64_t overwork_steps_;
};

/// What a self-check came to.
struct SelfCheck
{
    std::uint64_t injected{0};
    std::uint64_t flagged{0};              ///< Of these, as what they were.
    std::uint64_t false_flags{0};          ///< Overruns in frames that were not spoilt.
    bool allocations_counted{true};        ///< False: this build can't, and none was injected.
    std::optional<std::uint64_t> unseen{}; ///< The first spoilt frame that was not flagged so.

    [[nodiscard]] bool is_passed() const noexcept
    {
        return injected > 0 && flagged == injected && false_flags == 0;
    }
};

/// Compares what the account of a run that was spoilt by the plan has flagged with the plan, after
/// settling its suspects by doing to them again what the plan did.
[[nodiscard]] SelfCheck judge_injections(DeadlineAccount& deadlines, const FaultInjector& injector);

/// Proof that the accounting sees what it has to see: a short run as the options have it, with
/// simulated devices, in which each fault is injected InjectionPlan::kOfEachKind times.
[[nodiscard]] Result<SelfCheck, Refusal> run_self_check(Options options);

[[nodiscard]] std::string self_check_line(const SelfCheck& check);

} // namespace tactus::hrtc
