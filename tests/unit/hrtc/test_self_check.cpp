// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/load.hpp"
#include "platform/diagnose/self_check.hpp"
#include "platform/machine/allocation_counter.hpp"
#include "platform/machine/thread_usage.hpp"
#include "tests/unit/hrtc/period.hpp"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <string>
#include <thread>

namespace tactus::hrtc::test
{
namespace
{

/// Measurements of the loop in a frame with this fault, on an idle machine.
CycleMeasures measures_of(std::optional<InjectedFault> fault)
{
    CycleMeasures measures{};
    measures.cycle.periods = 1;
    if (!fault)
    {
        return measures;
    }
    switch (*fault)
    {
    case InjectedFault::overwork:
        measures.cpu = kPeriod * 2;
        break;
    case InjectedFault::page_fault:
        measures.usage.minor_faults = 1;
        break;
    case InjectedFault::allocation:
        measures.allocations = 1;
        break;
    case InjectedFault::sleep:
        ++measures.usage.voluntary_switches;
        break;
    }
    return measures;
}

/// Result of a correct run in which `change` modifies one frame.
template <typename Change>
SelfCheck check_with(std::uint64_t changed, Change change)
{
    DeadlineAccount account(kPeriod);
    for (std::uint64_t frame = 0; frame < InjectionPlan::kFrames; ++frame)
    {
        CycleMeasures measures = measures_of(InjectionPlan::at(frame));
        if (frame == changed)
        {
            change(measures);
        }
        account.add(frame, measures, 0, false);
    }
    return judge_injections(account, FaultInjector(kPeriod));
}

void hide(CycleMeasures& measures)
{
    measures = measures_of(std::nullopt);
}

TEST(InjectionPlan, has_as_many_of_each_kind_as_it_says_with_room_between_them)
{
    std::map<InjectedFault, std::uint64_t> counts;
    std::uint64_t last = 0;
    for (std::uint64_t frame = 0; frame < 2 * InjectionPlan::kFrames; ++frame)
    {
        if (const auto fault = InjectionPlan::at(frame))
        {
            EXPECT_GE(frame - last, InjectionPlan::kSpacing);
            last = frame;
            ++counts[*fault];
        }
    }
    EXPECT_LT(last, InjectionPlan::kFrames);
    const std::size_t kinds = kInjectedFaults - (allocation_counter::available() ? 0U : 1U);
    EXPECT_EQ(counts.size(), kinds);
    for (const auto& [kind, count] : counts)
    {
        EXPECT_EQ(count, InjectionPlan::kOfEachKind);
    }
}

/// Injects each kind on a thread that counts like the loop.
TEST(InjectedFaults, are_seen_by_what_the_loop_counts_with)
{
    std::thread haptic(
        []
        {
            allocation_counter::mark_this_thread(true);
            const FaultInjector injector(kPeriod);
            const auto usage_of = [&injector](InjectedFault fault)
            {
                const ThreadUsage before = read_thread_usage();
                injector.inject(fault);
                return read_thread_usage() - before;
            };
            EXPECT_GT(usage_of(InjectedFault::overwork).cpu_time, kPeriod);
            EXPECT_GE(usage_of(InjectedFault::page_fault).minor_faults, 1);
            EXPECT_GE(usage_of(InjectedFault::sleep).voluntary_switches, 1);
            const std::uint64_t before = allocation_counter::of_this_thread().allocations;
            injector.inject(InjectedFault::allocation);
            EXPECT_EQ(allocation_counter::of_this_thread().allocations - before,
                      allocation_counter::available() ? 1U : 0U);
        });
    haptic.join();
}

TEST(SelfCheck, passes_when_each_injected_fault_was_flagged_and_nothing_else)
{
    const SelfCheck check = check_with(0, [](CycleMeasures&) {});
    EXPECT_TRUE(check.is_passed()) << self_check_line(check);
    EXPECT_EQ(check.flagged, check.injected);
}

TEST(SelfCheck, fails_when_any_injected_fault_went_unseen_or_was_taken_for_another)
{
    for (std::uint64_t frame = 0; frame < InjectionPlan::kFrames; ++frame)
    {
        const auto fault = InjectionPlan::at(frame);
        if (!fault)
        {
            continue;
        }
        const SelfCheck unseen = check_with(frame, hide);
        EXPECT_FALSE(unseen.is_passed());
        EXPECT_EQ(unseen.flagged + 1, unseen.injected);
        EXPECT_EQ(unseen.unseen, frame);
        EXPECT_NE(self_check_line(unseen).find("missed in frame " + std::to_string(frame) + ": "),
                  std::string::npos);
        const InjectedFault other =
            *fault == InjectedFault::sleep ? InjectedFault::page_fault : InjectedFault::sleep;
        EXPECT_FALSE(
            check_with(frame, [&](CycleMeasures& m) { m = measures_of(other); }).is_passed());
    }
}

TEST(SelfCheck, fails_when_nothing_was_noted)
{
    DeadlineAccount nothing(kPeriod);
    const SelfCheck check = judge_injections(nothing, FaultInjector(kPeriod));
    EXPECT_FALSE(check.is_passed());
    EXPECT_EQ(check.flagged, 0U);
}

TEST(SelfCheck, fails_when_a_clean_frame_was_flagged)
{
    const SelfCheck check =
        check_with(7, [](CycleMeasures& m) { m = measures_of(InjectedFault::page_fault); });
    EXPECT_FALSE(check.is_passed());
    EXPECT_EQ(check.false_flags, 1U);
}

/// Processor time that the machine adds to a frame is missing in its repetition.
TEST(SelfCheck, does_not_mind_a_frame_that_was_long_once)
{
    const SelfCheck check =
        check_with(7, [](CycleMeasures& m) { m = measures_of(InjectedFault::overwork); });
    EXPECT_TRUE(check.is_passed()) << self_check_line(check);
}

int turns_left = 0;

bool has_turns_left()
{
    return turns_left-- > 0;
}

TEST(Load, knows_its_kinds_by_name)
{
    for (std::size_t i = 0; i < kLoadNames.size(); ++i)
    {
        EXPECT_EQ(parse_load(kLoadNames[i]), static_cast<LoadKind>(i));
    }
    for (const char* other : {"", "none", "CPU", "cpu "})
    {
        EXPECT_FALSE(parse_load(other)) << other;
    }
}

TEST(Load, works_as_long_as_it_is_asked_to_and_no_longer)
{
    for (const LoadKind kind : {LoadKind::cpu, LoadKind::memory, LoadKind::disk})
    {
        turns_left = 2;
        const Duration before = read_thread_cpu_time();
        const auto fault = work(kind, has_turns_left);
        EXPECT_FALSE(fault) << *fault;
        EXPECT_EQ(turns_left, -1);
        EXPECT_GT(read_thread_cpu_time() - before, microseconds(100)); // The load was active.
    }
}

TEST(Load, tells_of_a_worker_that_has_ended)
{
    auto load = Load::start(std::vector{LoadKind::disk}, "/bin/true");
    ASSERT_TRUE(load);
    std::optional<LoadKind> ended;
    while (!ended)
    {
        ended = load.value().ended();
    }
    EXPECT_EQ(ended, LoadKind::disk);
    EXPECT_FALSE(load.value().ended()); // There was only one.
}

TEST(Load, tells_of_a_program_that_is_not_there)
{
    const auto load = Load::start(std::vector{LoadKind::cpu}, "/nowhere/hrtc");
    ASSERT_FALSE(load);
    EXPECT_EQ(load.error(), "the load 'cpu' can't be started: No such file or directory");
}

} // namespace
} // namespace tactus::hrtc::test
