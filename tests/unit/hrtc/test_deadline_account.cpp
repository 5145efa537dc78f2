// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/deadline_account.hpp"
#include "tests/unit/hrtc/period.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace tactus::hrtc::test
{

namespace
{

/// A cycle in which nothing went wrong: one period, one sleep, 20 us of work.
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
        sut.add(frame, clean_cycle(), false);
    }
    EXPECT_EQ(sut.missed + sut.own_faults + sut.machine_late + sut.unexplained + sut.suspected, 0U);
    EXPECT_TRUE(sut.noted().empty());
    EXPECT_EQ(sut.response().count(), 100U);
    EXPECT_EQ(sut.response().max(), microseconds(25));
}

/// Each of what the loop must not do, in time and late: our own fault, and not the machine's.
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
            measures.cycle.wake_lateness = milliseconds(5); // Whatever the machine did besides.
            DeadlineAccount sut(kPeriod);
            sut.add(7, measures, false);
            EXPECT_EQ(sut.own_faults, 1U);
            EXPECT_EQ(sut.machine_late + sut.unexplained, 0U);
            EXPECT_EQ(sut.cycles_with(flag), 1U);
            ASSERT_EQ(sut.noted().size(), 1U);
            EXPECT_EQ(sut.noted().front().frame, 7U);
            EXPECT_TRUE(has_any(sut.noted().front().flags, flag));
        }
    }
    DeadlineAccount sut(kPeriod);
    sut.add(0, clean_cycle(), true);
    EXPECT_EQ(sut.own_faults, 1U);
    EXPECT_EQ(sut.cycles_with(CycleFlag::over_work), 1U);
}

TEST(DeadlineAccount, counts_a_system_call_in_the_cycle_that_made_it)
{
    DeadlineAccount sut(kPeriod);
    CycleMeasures measures = clean_cycle();
    measures.calls.in_frame = 3; // Counted since the loop began.
    sut.add(0, measures, false);
    sut.add(1, measures, false);
    EXPECT_EQ(sut.own_faults, 1U);
}

TEST(DeadlineAccount, a_miss_is_the_machines_when_it_woke_or_held_up_the_loop)
{
    DeadlineAccount sut(kPeriod);
    CycleMeasures measures = missed_cycle();
    measures.cycle.wake_lateness = microseconds(301);
    sut.add(0, measures, false);
    EXPECT_EQ(sut.machine_late, 1U);
    measures = missed_cycle();
    measures.frame = measures.cpu + microseconds(301);
    sut.add(2, measures, false);
    EXPECT_EQ(sut.machine_late, 2U);
    measures = missed_cycle();
    measures.beside_cpu = microseconds(10);
    measures.beside = measures.beside_cpu + microseconds(301);
    sut.add(4, measures, false);
    EXPECT_EQ(sut.machine_late, 3U);
    EXPECT_EQ(sut.missed, 3U);
    EXPECT_EQ(sut.unexplained, 0U);
}

TEST(DeadlineAccount, a_miss_for_no_known_reason_is_unexplained)
{
    DeadlineAccount sut(kPeriod);
    CycleMeasures measures = missed_cycle();
    measures.cycle.wake_lateness = microseconds(300);
    sut.add(0, measures, false);
    EXPECT_EQ(sut.unexplained, 1U);
    EXPECT_EQ(sut.own_faults + sut.machine_late, 0U);
}

/// At 4 kHz 300 us are more than a period.
TEST(DeadlineAccount, judges_a_machine_by_less_at_a_short_period)
{
    DeadlineAccount sut(microseconds(250));
    CycleMeasures measures = clean_cycle();
    measures.lateness_of_end = microseconds(251);
    measures.cycle.wake_lateness = microseconds(76);
    sut.add(0, measures, false);
    EXPECT_EQ(sut.machine_late, 1U);
}

TEST(DeadlineAccount, a_late_end_takes_the_deadlines_that_it_cost_on_itself_and_no_others)
{
    CycleMeasures own = clean_cycle();
    own.lateness_of_end = microseconds(2'500);
    own.usage.minor_faults = 1;
    for (const std::uint32_t periods : {1U, 2U, 3U, 4U, 50U})
    {
        DeadlineAccount sut(kPeriod);
        sut.add(0, own, false);
        CycleMeasures next = clean_cycle();
        next.cycle.periods = periods;
        sut.add(1, next, false);
        EXPECT_EQ(sut.missed, periods <= 3 ? 1U : 2U) << periods; // Two of them were its own.
        EXPECT_EQ(sut.own_faults, 1U);
        EXPECT_EQ(sut.unexplained, periods <= 3 ? 0U : 1U);
        next.cycle.periods = 3;
        sut.add(2, next, false); // But not those of a later one.
        EXPECT_EQ(sut.missed, periods <= 3 ? 2U : 3U);
    }
}

/// Two that took too long, one of them late; one that is just within, one guilty without.
DeadlineAccount account_with_suspects()
{
    DeadlineAccount account(kPeriod);
    CycleMeasures measures = clean_cycle();
    measures.cpu = measures.frame = microseconds(800);
    account.add(3, measures, false);
    measures.cpu = measures.frame = microseconds(801);
    account.add(4, measures, false);
    measures.lateness_of_end = microseconds(1'100);
    account.add(5, measures, false);
    measures.allocations = 1;
    account.add(6, measures, false);
    return account;
}

TEST(DeadlineAccount, leaves_it_open_who_took_the_processor_time_until_frames_were_repeated)
{
    const DeadlineAccount sut = account_with_suspects();
    EXPECT_EQ(sut.suspects(), (std::vector<std::uint64_t>{4, 5}));
    EXPECT_EQ(sut.suspected, 2U);
    EXPECT_EQ(sut.own_faults, 1U);
    EXPECT_EQ(sut.missed, 2U);
    EXPECT_EQ(sut.machine_late, 0U);
    EXPECT_EQ(sut.unexplained, 1U);
}

TEST(DeadlineAccount, blames_suspects_that_take_as_long_again_and_the_machine_for_the_others)
{
    const std::vector<std::vector<std::uint64_t>> kOver{{}, {4}, {5}, {4, 5}};
    for (const std::vector<std::uint64_t>& over : kOver)
    {
        DeadlineAccount sut = account_with_suspects();
        sut.settle(over);
        const bool is_late_one_over = !over.empty() && over.back() == 5;
        EXPECT_EQ(sut.own_faults, 1 + over.size());
        EXPECT_EQ(sut.machine_late, is_late_one_over ? 0U : 1U);
        EXPECT_EQ(sut.unexplained, 0U);
        EXPECT_EQ(sut.missed, 2U);
        EXPECT_EQ(sut.cycles_with(CycleFlag::over_cpu), 3U);
        EXPECT_EQ(sut.cycles_with(CycleFlag::repeated_cpu), over.size());
        EXPECT_EQ(sut.cycles_with(CycleFlag::acquitted_cpu), 2 - over.size());
        EXPECT_TRUE(sut.suspects().empty());
        ASSERT_EQ(sut.noted().size(), 3U);
        EXPECT_EQ(has_any(sut.noted()[1].flags, CycleFlag::repeated_cpu), is_late_one_over);
    }
}

TEST(DeadlineAccount, says_how_many_suspects_there_were_when_it_has_no_room_for_more)
{
    DeadlineAccount sut(kPeriod);
    CycleMeasures measures = clean_cycle();
    measures.cpu = measures.frame = microseconds(900);
    for (std::uint64_t frame = 0; frame < DeadlineAccount::kSuspectsMax + 3; ++frame)
    {
        sut.add(frame, measures, false);
    }
    EXPECT_EQ(sut.suspects().size(), DeadlineAccount::kSuspectsMax);
    EXPECT_EQ(sut.suspected, DeadlineAccount::kSuspectsMax + 3);
}

TEST(DeadlineAccount, answers_deadlines_that_went_by_with_the_next_force)
{
    DeadlineAccount sut(kPeriod);
    sut.add(0, clean_cycle(), false);
    CycleMeasures measures = clean_cycle();
    measures.cycle.periods = 4;
    sut.add(1, measures, false);
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
        sut.add(frame, missed_cycle(), false);
    }
    EXPECT_EQ(sut.noted().size(), DeadlineAccount::kNotedMax);
    EXPECT_EQ(sut.not_kept, 2U);
    EXPECT_EQ(sut.missed, DeadlineAccount::kNotedMax + 2);
}

} // namespace

} // namespace tactus::hrtc::test
