// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/deadline_report.hpp"
#include "platform/diagnose/load.hpp"
#include "platform/diagnose/self_check.hpp"
#include "platform/machine/allocation_counter.hpp"
#include "platform/machine/thread_usage.hpp"
#include "tests/shared/altered_recording.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/unit/hrtc/period.hpp"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace tactus::hrtc::test
{
namespace
{

constexpr std::uint64_t kCycles = 10'000;
constexpr DeadlineSetting kSetting{80, milliseconds(1)};
constexpr SelfCheck kSound{20, 20, 0, true};

/// Run of kCycles with these numbers of missed deadlines.
DeadlinePhase phase_with(std::uint64_t own, std::uint64_t machine, std::uint64_t stopped)
{
    DeadlinePhase phase;
    phase.name = "alone";
    phase.report["frames"] = kCycles;
    phase.report["deadline"] = {{"missed", own + machine + stopped},
                                {"overrun", own},
                                {"latency_misses", machine},
                                {"stopped", stopped}};
    for (std::uint64_t i = 0; i < kCycles; ++i)
    {
        phase.wake.record(microseconds(7));
        phase.cpu.record(microseconds(30));
        phase.response.record(microseconds(40));
    }
    return phase;
}

std::string verdict_on(const SelfCheck& check, const std::vector<DeadlinePhase>& phases)
{
    const std::string text = make_deadline_summary(check, phases, kSetting);
    return text.substr(text.find("verdict"));
}

TEST(DeadlineReport, passes_what_the_machine_or_a_stop_alone_made_late)
{
    const std::vector phases{phase_with(0, 500, 0), phase_with(0, 9'000, 10)};
    EXPECT_TRUE(is_passed(kSound, phases));
    EXPECT_EQ(verdict_on(kSound, phases), "verdict     passed: 0 overruns in 20000 cycles\n");
    EXPECT_TRUE(make_deadline_report(kSound, phases)["passed"].get<bool>());
}

TEST(DeadlineReport, fails_for_one_own_fault_in_any_run)
{
    for (const std::vector<DeadlinePhase>& phases :
         {std::vector{phase_with(1, 0, 0), phase_with(0, 0, 0)},
          std::vector{phase_with(0, 0, 0), phase_with(1, 0, 0)}})
    {
        EXPECT_FALSE(is_passed(kSound, phases));
        EXPECT_EQ(verdict_on(kSound, phases), "verdict     failed: 1 overrun in 20000 cycles\n");
        EXPECT_FALSE(make_deadline_report(kSound, phases)["passed"].get<bool>());
    }
}

TEST(DeadlineReport, believes_nothing_after_a_self_check_that_failed)
{
    for (const SelfCheck& check :
         {SelfCheck{20, 19, 0, true}, SelfCheck{20, 20, 1, true}, SelfCheck{0, 0, 0, true}})
    {
        const std::vector phases{phase_with(0, 0, 0)};
        EXPECT_FALSE(is_passed(check, phases));
        EXPECT_NE(verdict_on(check, phases).find("failed: the self-check"), std::string::npos);
    }
}

TEST(DeadlineReport, has_the_last_run_in_front_and_the_first_one_apart)
{
    std::vector phases{phase_with(0, 1, 0), phase_with(0, 2, 0)};
    phases.back().loads = {"cpu"};
    const auto both = make_deadline_report(kSound, phases);
    EXPECT_EQ(both["deadline"]["latency_misses"], 2);
    EXPECT_EQ(both["load"].size(), 1U);
    EXPECT_EQ(both["alone"]["deadline"]["latency_misses"], 1);
    EXPECT_TRUE(both["alone"]["load"].empty());
    EXPECT_FALSE(make_deadline_report(kSound, std::span(phases).first(1)).contains("alone"));
    for (const char* key : {"wake", "cpu", "response"})
    {
        ASSERT_EQ(both["histograms_us"][key].size(), 1U) << key; // All have the same value.
        EXPECT_EQ(both["histograms_us"][key][0][1], kCycles);
    }
    EXPECT_GE(both["histograms_us"]["cpu"][0][0].get<double>(), 30.0);
    EXPECT_LT(both["histograms_us"]["cpu"][0][0].get<double>(), 32.0);
}

TEST(DeadlineReport, tells_of_the_wake_as_cyclictest_does)
{
    const std::string text =
        make_deadline_summary(kSound, std::vector{phase_with(0, 0, 0)}, kSetting);
    EXPECT_NE(text.find("P:80 I:1000 C:  10000 Min:      7 Avg:    7 Max:       7"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("of the period: 3.0 % alone"), std::string::npos) << text;
}

constexpr std::uint64_t kFrames = 30;

/// Recording of a tool that descends on a small model.
const Recording& recorded_run()
{
    static const Recording kRecording = []
    {
        const tactus::test::TestModel& model = tactus::test::small_model(0);
        tactus::test::RigOptions options = tactus::test::with_room_for_all();
        options.record = true;
        options.tools = {{0.01 * model.diagonal_m, 500.0, 8.0, 1.0}};
        tactus::test::FrameRig rig(model, options);
        const Vec3 place = to_vec3(model.faces.front()[0]);
        for (std::uint64_t frame = 0; frame < kFrames; ++frame)
        {
            rig.step(place * (1.2 - 0.01 * static_cast<double>(frame)));
        }
        return std::move(Recording::parse(rig.finish_recording(), "run.rec")).value();
    }();
    return kRecording;
}

using Frames = std::vector<std::uint64_t>;

TEST(FrameRepeater, names_the_suspects_that_are_over_the_limit_again_and_no_other_frame)
{
    struct Case
    {
        Frames suspects;
        Duration limit;
        Frames over;
    };
    for (const auto& [suspects, limit, over] :
         {Case{{3, 17, kFrames - 1}, nanoseconds(0), {3, 17, kFrames - 1}},
          Case{{3, 17}, milliseconds(100'000), {}}, Case{{}, nanoseconds(0), {}}})
    {
        const auto sut = frames_over_again(recorded_run(), suspects, limit);
        ASSERT_TRUE(sut);
        EXPECT_EQ(sut.value(), over);
    }
}

TEST(FrameRepeater, refuses_a_frame_that_is_not_in_the_recording)
{
    const auto over = frames_over_again(recorded_run(), Frames{3, kFrames}, milliseconds(100'000));
    ASSERT_FALSE(over);
    EXPECT_EQ(over.error(), "frame 30 is not in the recording of 30 frames");
}

/// A replay that differs from the run proves nothing about it.
TEST(FrameRepeater, refuses_a_recording_that_comes_out_otherwise)
{
    const std::vector<std::byte> bytes =
        tactus::test::alter_frame(recorded_run(), 12, tactus::test::change_goal);
    const Recording altered = std::move(Recording::parse(bytes, "altered.rec")).value();
    const auto over = frames_over_again(altered, Frames{3}, milliseconds(100'000));
    ASSERT_FALSE(over);
    EXPECT_NE(over.error().find("frame 12"), std::string::npos) << over.error();
}

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
