// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/deadline_account.hpp"
#include "tests/unit/hrtc/period.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace tactus::hrtc::test
{

namespace
{

constexpr std::uint64_t kWork = 1'000;

/// Cycle without faults: one period, one sleep, 20 us of work.
CycleMeasures clean_cycle()
{
    CycleMeasures measures{};
    measures.cycle.periods = 1;
    measures.cycle.wake_lateness = microseconds(5);
    measures.frame = microseconds(20);
    measures.cpu = microseconds(19);
    measures.lateness_of_end = microseconds(25);
    return measures;
}

CycleMeasures missed_cycle()
{
    CycleMeasures measures = clean_cycle();
    measures.lateness_of_end = kPeriod + nanoseconds(1);
    return measures;
}

TEST(DeadlineAccount, has_nothing_to_tell_of_clean_cycles)
{
    DeadlineAccount sut(kPeriod);
    for (std::uint64_t frame = 0; frame < 100; ++frame)
    {
        sut.add(frame, clean_cycle(), kWork, false);
    }
    EXPECT_EQ(sut.missed + sut.overruns + sut.latency_misses + sut.stopped, 0U);
    EXPECT_TRUE(sut.noted().empty());
    EXPECT_EQ(sut.response().count(), 100U);
    EXPECT_EQ(sut.response().max(), microseconds(25));
}

/// Each forbidden action of the loop, in time and late, is an overrun and not the machine's delay.
TEST(DeadlineAccount, blames_the_loop_for_each_thing_that_it_must_not_do)
{
    const std::vector<std::pair<CycleFlag, void (*)(CycleMeasures&)>> kCauses{
        {CycleFlag::page_fault, [](CycleMeasures& m) { m.usage.minor_faults = 1; }},
        {CycleFlag::page_fault, [](CycleMeasures& m) { m.usage.major_faults = 1; }},
        {CycleFlag::allocation, [](CycleMeasures& m) { m.allocations = 1; }},
        {CycleFlag::gave_way, [](CycleMeasures& m) { m.usage.voluntary_switches = 1; }},
        {CycleFlag::system_call, [](CycleMeasures& m) { m.calls.in_frame = 1; }},
    };
    for (const auto& [flag, cause] : kCauses)
    {
        for (CycleMeasures measures : {clean_cycle(), missed_cycle()})
        {
            cause(measures);
            measures.cycle.wake_lateness = milliseconds(5); // Any delay of the machine.
            DeadlineAccount sut(kPeriod);
            sut.add(7, measures, kWork, false);
            EXPECT_EQ(sut.overruns, 1U);
            EXPECT_EQ(sut.latency_misses + sut.stopped, 0U);
            EXPECT_EQ(sut.cycles_with(flag), 1U);
            ASSERT_EQ(sut.noted().size(), 1U);
            EXPECT_EQ(sut.noted().front().frame, 7U);
            EXPECT_TRUE(has_any(sut.noted().front().flags, flag));
        }
    }
    DeadlineAccount sut(kPeriod);
    sut.add(0, clean_cycle(), kWork, true);
    EXPECT_EQ(sut.overruns, 1U);
    EXPECT_EQ(sut.cycles_with(CycleFlag::over_work), 1U);
}

/// A page fault may wait for a page that the kernel moves, once: the fault is the event, not the
/// wait.
TEST(DeadlineAccount, the_wait_of_a_page_fault_is_no_event_of_its_own)
{
    CycleMeasures measures = clean_cycle();
    measures.usage.minor_faults = 1;
    measures.usage.major_faults = 1;
    for (const std::int64_t switches : {0, 1, 2, 3})
    {
        measures.usage.voluntary_switches = switches;
        DeadlineAccount sut(kPeriod);
        sut.add(0, measures, kWork, false);
        EXPECT_EQ(sut.overruns, 1U);
        EXPECT_EQ(sut.cycles_with(CycleFlag::page_fault), 1U);
        EXPECT_EQ(sut.cycles_with(CycleFlag::gave_way), switches > 2 ? 1U : 0U) << switches;
    }
}

TEST(DeadlineAccount, counts_a_system_call_in_the_cycle_that_made_it)
{
    DeadlineAccount sut(kPeriod);
    CycleMeasures measures = clean_cycle();
    measures.calls.in_frame = 3; // Calls since the loop began.
    sut.add(0, measures, kWork, false);
    sut.add(1, measures, kWork, false);
    EXPECT_EQ(sut.overruns, 1U);
}

TEST(DeadlineAccount, a_miss_without_an_own_fault_is_the_machines)
{
    DeadlineAccount sut(kPeriod);
    sut.add(0, missed_cycle(), kWork, false);
    CycleMeasures measures = clean_cycle();
    measures.cycle.periods = 3;
    sut.add(1, measures, kWork, false);
    EXPECT_EQ(sut.missed, 2U);
    EXPECT_EQ(sut.latency_misses, 2U);
    EXPECT_EQ(sut.overruns + sut.stopped, 0U);
}

/// The limits are 300 us, and 0.3 of a period below a millisecond.
TEST(DeadlineAccount, tells_how_the_machine_was_late)
{
    for (const auto& [period, limit] :
         {std::pair{kPeriod, microseconds(300)}, std::pair{microseconds(250), microseconds(75)}})
    {
        DeadlineAccount sut(period);
        CycleMeasures measures = clean_cycle();
        measures.cycle.wake_lateness = limit;
        measures.frame = measures.cpu + limit;
        sut.add(0, measures, kWork, false);
        EXPECT_EQ(sut.cycles_with(CycleFlag::woken_late) + sut.cycles_with(CycleFlag::held_up), 0U);
        measures.cycle.wake_lateness = limit + nanoseconds(1);
        sut.add(1, measures, kWork, false);
        EXPECT_EQ(sut.cycles_with(CycleFlag::woken_late), 1U);
        measures.frame += nanoseconds(1);
        sut.add(2, measures, kWork, false);
        measures.frame = measures.cpu;
        measures.beside = measures.beside_cpu + limit + nanoseconds(1);
        sut.add(3, measures, kWork, false);
        EXPECT_EQ(sut.cycles_with(CycleFlag::held_up), 2U);
    }
}

/// The thread was then off its processor, as in a sleep of its own, and late.
TEST(DeadlineAccount, a_process_that_was_stopped_is_no_fault_of_the_loop_or_the_machine)
{
    for (CycleMeasures measures : {clean_cycle(), missed_cycle()})
    {
        measures.usage.voluntary_switches = 1;
        measures.was_stopped = true;
        DeadlineAccount sut(kPeriod);
        sut.add(0, measures, kWork, false);
        EXPECT_EQ(sut.overruns + sut.latency_misses, 0U);
        EXPECT_EQ(sut.stopped, sut.missed);
        EXPECT_EQ(sut.cycles_with(CycleFlag::stopped), 1U);
        measures.allocations = 1; // Other faults still count as its own.
        sut.add(1, measures, kWork, false);
        EXPECT_EQ(sut.overruns, 1U);
    }
}

TEST(DeadlineAccount, a_late_end_takes_the_deadlines_that_it_cost_on_itself_and_no_others)
{
    CycleMeasures own = clean_cycle();
    own.lateness_of_end = microseconds(2'500);
    own.usage.minor_faults = 1;
    for (const std::uint32_t periods : {1U, 2U, 3U, 4U, 50U})
    {
        DeadlineAccount sut(kPeriod);
        sut.add(0, own, kWork, false);
        CycleMeasures next = clean_cycle();
        next.cycle.periods = periods;
        sut.add(1, next, kWork, false);
        EXPECT_EQ(sut.missed, periods <= 3 ? 1U : 2U) << periods; // Two of them were its own.
        EXPECT_EQ(sut.overruns, 1U);
        EXPECT_EQ(sut.latency_misses, periods <= 3 ? 0U : 1U);
        next.cycle.periods = 3;
        sut.add(2, next, kWork, false); // Faults of a later cycle do not count.
        EXPECT_EQ(sut.missed, periods <= 3 ? 2U : 3U);
    }
}

CycleMeasures long_cycle()
{
    CycleMeasures measures = clean_cycle();
    measures.cpu = measures.frame = microseconds(801);
    return measures;
}

TEST(DeadlineAccount, blames_the_loop_for_more_processor_time_than_its_share)
{
    DeadlineAccount sut(kPeriod);
    CycleMeasures measures = long_cycle();
    measures.cpu = microseconds(800);
    sut.add(0, measures, kWork, false);
    EXPECT_EQ(sut.overruns, 0U);
    sut.add(1, long_cycle(), kWork, false);
    EXPECT_EQ(sut.overruns, 1U);
    sut.compare_work();
    EXPECT_EQ(sut.overruns, 1U);
    EXPECT_EQ(sut.cycles_with(CycleFlag::over_cpu), 1U);
}

/// Work beside the frame makes the cycle late, or none is visible.
TEST(DeadlineAccount, counts_the_work_beside_the_frame_where_the_deadline_was_missed)
{
    for (const CycleMeasures& cycle : {clean_cycle(), missed_cycle()})
    {
        CycleMeasures measures = cycle;
        measures.beside_cpu = microseconds(800);
        DeadlineAccount sut(kPeriod);
        sut.add(0, measures, kWork, false);
        EXPECT_EQ(sut.overruns, sut.missed);
        EXPECT_EQ(sut.latency_misses, 0U);
    }
}

/// Evidence before and after: as much work at half of the limit, or a fraction of the work in as
/// small a fraction of the time, down to a quarter. Less work is no evidence.
TEST(DeadlineAccount, blames_the_machine_where_the_run_shows_the_same_work_to_need_half_at_most)
{
    const auto taking = [](std::int64_t time_us)
    {
        CycleMeasures measures = clean_cycle();
        measures.cpu = microseconds(time_us);
        return measures;
    };
    static_assert(kWork % 4 == 0);
    for (const auto& [other, work, is_shown] :
         {std::tuple{taking(400), kWork, true}, std::tuple{taking(400), kWork + 1, true},
          std::tuple{taking(400), kWork - 1, false}, std::tuple{taking(401), kWork, false},
          std::tuple{taking(200), kWork / 2, true}, std::tuple{taking(201), kWork / 2, false},
          std::tuple{taking(100), kWork / 4, true}, std::tuple{taking(101), kWork / 4, false},
          std::tuple{taking(1), kWork / 4, true}, std::tuple{taking(1), kWork / 4 - 1, false}})
    {
        for (const bool is_before : {true, false})
        {
            DeadlineAccount sut(kPeriod);
            sut.add(0, is_before ? other : long_cycle(), is_before ? work : kWork, false);
            sut.add(1, is_before ? long_cycle() : other, is_before ? kWork : work, false);
            EXPECT_EQ(sut.overruns, is_shown && is_before ? 0U : 1U);
            sut.compare_work();
            EXPECT_EQ(sut.overruns, is_shown ? 0U : 1U);
            EXPECT_EQ(sut.cycles_with(CycleFlag::slowed), is_shown ? 1U : 0U);
            EXPECT_EQ(sut.cycles_with(CycleFlag::over_cpu), is_shown ? 0U : 1U);
        }
    }
}

/// Two cycles that took too long, one of them late, and one that is guilty otherwise.
DeadlineAccount account_with_suspects()
{
    DeadlineAccount account(kPeriod);
    account.add(3, clean_cycle(), kWork, false);
    account.add(4, long_cycle(), kWork, false);
    CycleMeasures measures = long_cycle();
    measures.lateness_of_end = microseconds(1'100);
    account.add(5, measures, 5 * kWork, false);
    measures.allocations = 1;
    account.add(6, measures, kWork, false);
    account.compare_work();
    return account;
}

TEST(DeadlineAccount, blames_the_repeated_that_were_over_each_time_and_no_others)
{
    const std::vector<std::vector<std::uint64_t>> kOver{{}, {4}, {5}, {4, 5}};
    for (const std::vector<std::uint64_t>& over : kOver)
    {
        DeadlineAccount sut = account_with_suspects();
        ASSERT_EQ(sut.suspects(), (std::vector<std::uint64_t>{4, 5}));
        EXPECT_EQ(sut.overruns, 2U); // The run contains the work of the first.
        sut.settle(over);
        const bool is_late_one_over = !over.empty() && over.back() == 5;
        EXPECT_EQ(sut.overruns, 1 + over.size());
        EXPECT_EQ(sut.latency_misses, is_late_one_over ? 0U : 1U);
        EXPECT_EQ(sut.missed, 2U);
        EXPECT_EQ(sut.cycles_with(CycleFlag::over_cpu), 1 + over.size());
        EXPECT_EQ(sut.cycles_with(CycleFlag::slowed), 2 - over.size());
        ASSERT_EQ(sut.noted().size(), 3U);
        EXPECT_EQ(has_any(sut.noted()[1].flags, CycleFlag::over_cpu), is_late_one_over);
    }
}

TEST(DeadlineAccount, leaves_the_frame_what_devices_do_not_take)
{
    DeadlineAccount sut(kPeriod);
    EXPECT_EQ(sut.repetition_limit(), microseconds(800));
    for (std::uint64_t frame = 0; frame < 3; ++frame)
    {
        CycleMeasures measures = clean_cycle();
        measures.outside = microseconds(frame == 1 ? 5'000 : 1'000); // One stall is not a habit.
        sut.add(frame, measures, kWork, false);
    }
    EXPECT_LE(sut.repetition_limit(), microseconds(-200));
    EXPECT_GE(sut.repetition_limit(), microseconds(-202)); // Three digits.
}

TEST(DeadlineAccount, holds_suspects_for_guilty_that_it_has_no_room_to_keep)
{
    DeadlineAccount sut(kPeriod);
    for (std::uint64_t frame = 0; frame < DeadlineAccount::kSuspectsMax + 3; ++frame)
    {
        sut.add(frame, long_cycle(), kWork, false);
    }
    EXPECT_EQ(sut.suspects().size(), DeadlineAccount::kSuspectsMax);
    sut.settle({});
    EXPECT_EQ(sut.overruns, 3U);
}

/// Random cycle, mostly near one of the limits.
struct RandomCycle
{
    CycleMeasures measures{};
    std::uint64_t work{0};
    bool over_work{false};
};

RandomCycle draw(std::mt19937_64& random)
{
    const auto below = [&random](std::uint32_t n)
    { return static_cast<std::uint32_t>(random() % n); };
    const auto one_in = [&below](std::uint32_t n) { return below(n) == 0; };
    const auto us_below = [&below](std::uint32_t n) { return microseconds(below(n)); };
    RandomCycle cycle;
    cycle.work = below(50);
    cycle.over_work = one_in(50);
    CycleMeasures& measures = cycle.measures;
    measures.cpu = us_below(one_in(3) ? 1'200U : 500U);
    measures.frame = measures.cpu + us_below(one_in(4) ? 600U : 3U);
    measures.beside_cpu = us_below(one_in(4) ? 900U : 20U);
    measures.beside = measures.beside_cpu + us_below(one_in(4) ? 600U : 3U);
    measures.cycle.wake_lateness = us_below(one_in(4) ? 600U : 50U);
    measures.cycle.periods = one_in(5) ? 1 + below(4) : 1;
    measures.lateness_of_end = us_below(one_in(4) ? 3'500U : 1'000U);
    measures.usage.minor_faults = one_in(50) ? 1 : 0;
    measures.usage.voluntary_switches = one_in(20) ? 1 : 0;
    measures.allocations = one_in(50) ? 1 : 0;
    measures.was_stopped = one_in(10);
    return cycle;
}

struct Blame
{
    std::uint64_t own{0};
    std::uint64_t machine{0};
    std::uint64_t stopped{0};
    bool operator==(const Blame&) const = default;
};

/// True for a cycle, or up to four like it, that did as much work within 400 us.
bool shows(const RandomCycle& cycle, std::uint64_t work)
{
    const Duration time = cycle.measures.cpu + cycle.measures.beside_cpu;
    return std::ranges::any_of(
        std::array{1U, 2U, 3U, 4U}, [&](unsigned times)
        { return cycle.work * times >= work && time.ns * times <= microseconds(400).ns; });
}

/// Rules of docs/deadline-test.md for a whole run. `over`: repeated cycles that exceeded again;
/// empty: the run itself decides.
Blame blame_of(const std::vector<RandomCycle>& run,
               const std::optional<std::set<std::uint64_t>>& over)
{
    Blame blame;
    for (std::size_t i = 0; i < run.size(); ++i)
    {
        const CycleMeasures& m = run[i].measures;
        const std::int64_t lost = m.cycle.periods - 1;
        const std::int64_t of_the_last =
            i == 0 ? 0 : run[i - 1].measures.lateness_of_end.ns / kPeriod.ns;
        const bool missed = m.lateness_of_end > kPeriod || lost > of_the_last;
        const bool forbidden = m.usage.minor_faults > 0 || m.allocations > 0 ||
                               (m.usage.voluntary_switches > 0 && !m.was_stopped) ||
                               run[i].over_work;
        const Duration took = missed ? m.cpu + m.beside_cpu : m.cpu;
        const bool shown = over ? !over->contains(i)
                                : std::ranges::any_of(run, [&](const RandomCycle& other)
                                                      { return shows(other, run[i].work); });
        const bool own = forbidden || (took > microseconds(800) && !shown);
        blame.own += own ? 1U : 0U;
        blame.machine += missed && !own && !m.was_stopped ? 1U : 0U;
        blame.stopped += missed && !own && m.was_stopped ? 1U : 0U;
    }
    return blame;
}

TEST(DeadlineAccount, blames_as_the_rules_say_in_any_run)
{
    for (std::uint64_t seed = 1; seed <= 300; ++seed)
    {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 random(seed);
        std::vector<RandomCycle> run(random() % 60);
        std::ranges::generate(run, [&random] { return draw(random); });
        DeadlineAccount sut(kPeriod);
        for (std::size_t i = 0; i < run.size(); ++i)
        {
            sut.add(i, run[i].measures, run[i].work, run[i].over_work);
        }
        sut.compare_work();
        const auto blamed = [&sut] { return Blame{sut.overruns, sut.latency_misses, sut.stopped}; };
        ASSERT_EQ(blamed(), blame_of(run, std::nullopt));
        std::vector<std::uint64_t> over = sut.suspects();
        std::erase_if(over, [&random](std::uint64_t) { return random() % 2 == 0; });
        sut.settle(over);
        ASSERT_EQ(blamed(), blame_of(run, std::set<std::uint64_t>(over.begin(), over.end())));
        sut.compare_work();
        ASSERT_EQ(blamed(), blame_of(run, std::nullopt));
    }
}

TEST(DeadlineAccount, answers_deadlines_that_went_by_with_the_next_force)
{
    DeadlineAccount sut(kPeriod);
    sut.add(0, clean_cycle(), kWork, false);
    CycleMeasures measures = clean_cycle();
    measures.cycle.periods = 4;
    sut.add(1, measures, kWork, false);
    const LatencyHistogram response = sut.response();
    EXPECT_EQ(response.count(), 5U);
    EXPECT_EQ(response.max(), microseconds(3'025));
    EXPECT_EQ(response.count_to(microseconds(30)), 2U);
    EXPECT_EQ(response.count_to(microseconds(1'030)), 3U);
    EXPECT_EQ(response.count_to(microseconds(2'030)), 4U);
}

TEST(DeadlineAccount, counts_what_it_has_no_room_to_keep)
{
    DeadlineAccount sut(kPeriod);
    for (std::uint64_t frame = 0; frame < DeadlineAccount::kNotedMax + 2; ++frame)
    {
        sut.add(frame, missed_cycle(), kWork, false);
    }
    EXPECT_EQ(sut.noted().size(), DeadlineAccount::kNotedMax);
    EXPECT_EQ(sut.not_kept, 2U);
    EXPECT_EQ(sut.missed, DeadlineAccount::kNotedMax + 2);
}

} // namespace

} // namespace tactus::hrtc::test
