// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/safety_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

namespace tactus::hrtc
{

namespace
{

SafetyEvent event(std::int64_t ns, std::uint32_t tool, ForceOff causes)
{
    return {MonotonicTime{ns}, 0, tool, SafetyState::brake, causes, false};
}

TEST(SafetyLog, hands_over_in_order_and_counts_what_finds_no_room)
{
    SafetyLog sut;
    std::vector<SafetyEvent> taken;
    sut.take_into(taken);
    EXPECT_TRUE(taken.empty());
    for (std::size_t i = 0; i < SafetyLog::kEvents + 3; ++i)
    {
        sut.note(event(static_cast<std::int64_t>(i), 0, ForceOff::stall));
    }
    EXPECT_EQ(sut.lost(), 3U);
    sut.take_into(taken);
    ASSERT_EQ(taken.size(), SafetyLog::kEvents);
    for (std::size_t i = 0; i < taken.size(); ++i)
    {
        EXPECT_EQ(taken[i].time.ns, static_cast<std::int64_t>(i));
    }
    sut.note(event(7, 0, ForceOff::stall));
    sut.take_into(taken);
    EXPECT_EQ(taken.back().time.ns, 7);
    EXPECT_EQ(sut.lost(), 3U);
}

TEST(SafetyRecord, counts_a_cause_when_it_begins_to_hold_for_a_tool)
{
    SafetyRecord sut(2);
    sut.add(event(1, 0, ForceOff::stall));
    sut.add(event(2, 0, ForceOff::stall | ForceOff::server)); // The stall continues.
    sut.add(event(3, 1, ForceOff::server));
    sut.add(event(4, 0, ForceOff::none));
    sut.add(event(5, 0, ForceOff::stall));
    SafetyEvent by_supervisor = event(6, 0, ForceOff::watchdog);
    by_supervisor.by_supervisor = true;
    sut.add(by_supervisor);
    sut.finish(1, 0);
    const auto begun = [&](ForceOff cause)
    {
        return sut
            .begun()[static_cast<std::size_t>(std::countr_zero(static_cast<std::uint32_t>(cause)))];
    };
    EXPECT_EQ(begun(ForceOff::stall), 2U);
    EXPECT_EQ(begun(ForceOff::server), 2U);
    EXPECT_EQ(begun(ForceOff::watchdog), 0U);
    EXPECT_EQ(sut.brakes(), 1U);
    EXPECT_EQ(sut.events().size(), 6U);
    EXPECT_EQ(sut.left_out(), 0U);
}

TEST(SafetyRecord, puts_events_in_the_order_of_time_and_counts_those_it_does_not_keep)
{
    SafetyRecord sut(1);
    for (std::size_t i = 0; i < SafetyRecord::kEventsKept + 5; ++i)
    {
        sut.add(event(1'000'000 - static_cast<std::int64_t>(i), 0,
                      i % 2 == 0 ? ForceOff::stall : ForceOff::none));
    }
    sut.finish(0, 4);
    ASSERT_EQ(sut.events().size(), SafetyRecord::kEventsKept);
    EXPECT_TRUE(std::ranges::is_sorted(sut.events(), {}, &SafetyEvent::time));
    EXPECT_EQ(sut.left_out(), 9U);
    EXPECT_EQ(sut.begun()[7], (SafetyRecord::kEventsKept + 6) / 2);
}

} // namespace

} // namespace tactus::hrtc
