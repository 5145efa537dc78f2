// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/deadline_account.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <utility>
#include <vector>

namespace tactus::hrtc::test
{

namespace
{

constexpr Duration kPeriod = milliseconds(1);

/// A cycle in which nothing went wrong: one period, one sleep, 20 us of work.
CycleMeasures clean_cycle()
{
    CycleMeasures measures{};
    measures.cycle.periods = 1;
    measures.cycle.sleeps = 1;
    measures.cycle.wake_lateness = microseconds(5);
    measures.frame = microseconds(20);
    measures.cpu = microseconds(19);
    measures.lateness_of_end = microseconds(25);
    measures.usage.voluntary_switches = 1;
    return measures;
}

CycleMeasures missed_cycle()
{
    CycleMeasures measures = clean_cycle();
    measures.lateness_of_end = kPeriod + nanoseconds(1);
    return measures;
}

std::uint64_t flagged(const DeadlineAccount& account, CycleFlag flag)
{
    return account.flagged[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(flag)))];
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
        {CycleFlag::gave_way, [](CycleMeasures& m) { m.usage.voluntary_switches = 2; }},
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
            EXPECT_EQ(flagged(sut, flag), 1U);
            ASSERT_EQ(sut.noted().size(), 1U);
            EXPECT_EQ(sut.noted().front().frame, 7U);
            EXPECT_TRUE(has_any(sut.noted().front().flags, flag));
        }
    }
    DeadlineAccount sut(kPeriod);
    sut.add(0, clean_cycle(), true);
    EXPECT_EQ(sut.own_faults, 1U);
    EXPECT_EQ(flagged(sut, CycleFlag::over_work), 1U);
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

TEST(DeadlineAccount, a_late_end_takes_the_deadlines_that_it_cost_on_itself)
{
    DeadlineAccount sut(kPeriod);
    CycleMeasures own = clean_cycle();
    own.lateness_of_end = microseconds(2'500);
    own.usage.minor_faults = 1;
    sut.add(0, own, false);
    CycleMeasures next = clean_cycle();
    next.cycle.periods = 3;
    next.cycle.sleeps = 1;
    sut.add(1, next, false);
    EXPECT_EQ(sut.missed, 1U);
    EXPECT_EQ(sut.own_faults, 1U);
    EXPECT_EQ(sut.machine_late + sut.unexplained, 0U);
    sut.add(2, next, false); // But not those of a later one.
    EXPECT_EQ(sut.missed, 2U);
}

TEST(DeadlineAccount, suspects_a_frame_for_its_processor_time_until_a_repetition_settles_it)
{
    DeadlineAccount sut(kPeriod);
    CycleMeasures measures = clean_cycle();
    measures.cpu = microseconds(800);
    measures.frame = microseconds(800);
    sut.add(3, measures, false);
    EXPECT_TRUE(sut.suspects().empty()); // Just within.
    measures.cpu = measures.frame = microseconds(801);
    sut.add(4, measures, false); // In time all the same.
    measures.lateness_of_end = microseconds(1'100);
    sut.add(5, measures, false);
    measures.allocations = 1;
    sut.add(6, measures, false); // Guilty without.
    EXPECT_EQ(sut.suspects(), (std::vector<std::uint64_t>{4, 5}));
    EXPECT_EQ(sut.suspected, 2U);
    EXPECT_EQ(sut.own_faults, 1U);
    EXPECT_EQ(sut.machine_late, 1U);
    sut.blame(5);
    sut.blame(5); // Once is enough.
    sut.blame(6);
    sut.blame(3); // Nobody suspected it.
    EXPECT_EQ(sut.own_faults, 2U);
    EXPECT_EQ(sut.machine_late, 0U);
    EXPECT_EQ(flagged(sut, CycleFlag::repeated_cpu), 1U);
    sut.blame(4);
    EXPECT_EQ(sut.own_faults, 3U);
    EXPECT_TRUE(sut.suspects().empty());
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
