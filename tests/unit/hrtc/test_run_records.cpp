// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/trace_file.hpp"
#include "platform/loop/safety_log.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <fstream>
#include <vector>

namespace tactus::hrtc::test
{
namespace
{

using TraceJson = nlohmann::json;

TracedFrame frame(std::uint64_t number, std::int64_t start_us)
{
    TracedFrame traced;
    traced.frame = number;
    traced.deadline = {start_us * 1'000 - 500};
    traced.start = {start_us * 1'000};
    traced.end = {start_us * 1'000 + 150'250};
    for (std::size_t i = 0; i < kStages; ++i)
    {
        traced.stage[i] = {std::int64_t{10'000} * static_cast<std::int64_t>(i + 1)};
    }
    return traced;
}

/// Events of the file, without those that name its rows.
std::vector<TraceJson> events_of(const std::filesystem::path& path, TraceJson& file)
{
    file = TraceJson::parse(std::ifstream(path));
    std::vector<TraceJson> events;
    for (const TraceJson& event : file.at("traceEvents"))
    {
        if (event.at("ph") != "M")
        {
            events.push_back(event);
        }
    }
    return events;
}

struct Traced : ::testing::Test
{
    [[nodiscard]] AtomicFile file() const { return AtomicFile::create(path_.string()).value(); }

    tactus::test::TemporaryFolder folder_{"trace"};
    std::filesystem::path path_{folder_.path() / "trace.json"};
    TraceJson json_;
};

TEST_F(Traced, a_file_without_frames_is_one)
{
    TraceFile sut(file(), milliseconds(1));
    EXPECT_FALSE(std::filesystem::exists(path_));
    const auto result = sut.finish();
    ASSERT_TRUE(result) << result.error().text;
    EXPECT_EQ(result.value().frames, 0U);
    EXPECT_EQ(result.value().bytes, std::filesystem::file_size(path_));
    EXPECT_TRUE(events_of(path_, json_).empty());
}

TEST_F(Traced, a_frame_holds_its_stages_one_after_the_other)
{
    TraceFile sut(file(), milliseconds(1));
    sut.tap().add(frame(0, 5'000));
    TracedFrame second = frame(1, 6'000);
    second.arrivals = 2;
    second.link_updates = 1;
    second.requests = 7;
    second.faults = FrameFault::chunk_late | FrameFault::tool_stuck;
    sut.tap().add(second);
    ASSERT_TRUE(sut.finish());

    const std::vector<TraceJson> events = events_of(path_, json_);
    ASSERT_EQ(events.size(), 2U * (1 + kStages + 1) + 2);
    EXPECT_EQ(events[0].at("name"), "frame");
    EXPECT_EQ(events[0].at("ts"), 0.0);
    EXPECT_EQ(events[0].at("dur"), 150.25);
    EXPECT_EQ(events[0].at("args").at("after_deadline_us"), 150.75);
    double at = 0.0;
    for (std::size_t i = 0; i < kStages; ++i)
    {
        EXPECT_EQ(events[1 + i].at("name"), kStageNames[i]);
        EXPECT_DOUBLE_EQ(events[1 + i].at("ts").get<double>(), at);
        EXPECT_EQ(events[1 + i].at("dur"), 10.0 * static_cast<double>(i + 1));
        at += 10.0 * static_cast<double>(i + 1);
    }
    EXPECT_EQ(events[6].at("name"), "write");
    EXPECT_DOUBLE_EQ(events[6].at("ts").get<double>() + events[6].at("dur").get<double>(), 150.25);
    EXPECT_EQ(events[7].at("ts"), 1'000.0);
    EXPECT_EQ(events[7].at("args").at("faults"), TraceJson({"chunk_late", "tool_stuck"}));
    EXPECT_EQ(events[14].at("name"), "taken");
    EXPECT_EQ(events[14].at("args"), TraceJson({{"arrivals", 2}, {"link_updates", 1}}));
    EXPECT_EQ(events[15].at("name"), "requests");
    EXPECT_EQ(events[15].at("ts"), 1'010.0);
}

TEST_F(Traced, a_missed_deadline_is_marked)
{
    TraceFile sut(file(), microseconds(151));
    sut.tap().add(frame(0, 5'000)); // The frame ends 150.75 us after its deadline.
    TracedFrame later = frame(1, 6'000);
    later.periods = 2;
    sut.tap().add(later);
    later = frame(2, 7'000);
    later.deadline = {later.deadline.ns - 251};
    sut.tap().add(later);
    ASSERT_TRUE(sut.finish());
    std::vector<double> missed_us;
    for (const TraceJson& event : events_of(path_, json_))
    {
        if (event.at("name") == "deadline missed")
        {
            missed_us.push_back(event.at("ts"));
        }
    }
    EXPECT_EQ(missed_us, (std::vector<double>{1'150.25, 2'150.25}));
}

TEST_F(Traced, what_the_chunk_loader_began_before_has_a_negative_time)
{
    TraceFile sut(file(), milliseconds(1));
    sut.tap().add(frame(0, 5'000));
    sut.tap().add(TracedRound{{4'999'999}, {5'000'999}, 3, 2, 600, 2, 1});
    const auto result = sut.finish();
    ASSERT_TRUE(result);
    EXPECT_EQ(result.value().rounds, 1U);
    const std::vector<TraceJson> events = events_of(path_, json_);
    const TraceJson* round = nullptr;
    const TraceJson* first = nullptr;
    for (const TraceJson& event : events)
    {
        round = event.at("name") == "round" ? &event : round;
        first = event.at("name") == "frame" ? &event : first;
    }
    ASSERT_NE(round, nullptr);
    ASSERT_NE(first, nullptr);
    // The first measurement is the zero.
    EXPECT_DOUBLE_EQ(round->at("ts").get<double>() - first->at("ts").get<double>(), -0.001);
    EXPECT_EQ(round->at("dur"), 1.0);
    EXPECT_EQ(
        round->at("args"),
        TraceJson(
            {{"requests", 3}, {"pieces", 2}, {"bytes", 600}, {"handed_over", 2}, {"refused", 1}}));
}

TEST(TraceTap, counts_what_finds_no_room)
{
    TraceTap sut;
    for (std::size_t i = 0; i < TraceTap::kFrames + 3; ++i)
    {
        sut.add(TracedFrame{.frame = i});
    }
    for (std::size_t i = 0; i < TraceTap::kRounds + 2; ++i)
    {
        sut.add(TracedRound{});
    }
    EXPECT_EQ(sut.lost(), 5U);
    TracedFrame taken;
    std::uint64_t count = 0;
    while (sut.try_take(taken))
    {
        EXPECT_EQ(taken.frame, count++);
    }
    EXPECT_EQ(count, TraceTap::kFrames);
    sut.add(TracedFrame{});
    EXPECT_TRUE(sut.try_take(taken));
}

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
} // namespace tactus::hrtc::test
