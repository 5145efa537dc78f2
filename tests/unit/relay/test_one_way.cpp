// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/relay/one_way.hpp"
#include "tests/shared/random.hpp"
#include "tests/unit/relay/made_frames.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <vector>

namespace tactus::relay
{

namespace
{

constexpr MonotonicTime kEnd{std::numeric_limits<std::int64_t>::max()};

MonotonicTime at_us(std::int64_t time)
{
    return MonotonicTime{} + microseconds(time);
}

/// A datagram that carries its number.
Bytes numbered(std::uint32_t number)
{
    Bytes frame = udp_frame(100);
    std::memcpy(frame.data() + 60, &number, sizeof(number));
    return frame;
}

std::uint32_t number_of(const Bytes& frame)
{
    std::uint32_t number = 0;
    std::memcpy(&number, frame.data() + 60, sizeof(number));
    return number;
}

struct Arrival
{
    std::uint32_t number;
    MonotonicTime due;
};

/// All that is due until then, with the time for which each was meant.
std::vector<Arrival> arrivals(OneWay& sut, MonotonicTime until)
{
    std::vector<Arrival> list;
    for (auto due = sut.next_due(); due && *due <= until; due = sut.next_due())
    {
        const auto frame = sut.take_due(*due);
        if (!frame)
        {
            ADD_FAILURE() << "a frame that is due is held back";
            break;
        }
        list.push_back({number_of(*frame), *due});
    }
    return list;
}

TEST(OneWay, nothing_comes_out_of_an_empty_one)
{
    OneWay sut(1);
    EXPECT_FALSE(sut.next_due());
    EXPECT_FALSE(sut.take_due(kEnd));
}

TEST(OneWay, a_frame_comes_out_as_it_went_in_and_not_before_its_time)
{
    OneWay sut(1);
    const Bytes frame = numbered(7);
    sut.take(frame, {.delay_ms = 10.0}, at_us(500));
    EXPECT_EQ(sut.next_due(), at_us(10'500));
    EXPECT_FALSE(sut.take_due(at_us(10'499)));
    EXPECT_EQ(sut.take_due(at_us(10'500)), frame);
    EXPECT_FALSE(sut.take_due(kEnd));
}

TEST(OneWay, without_jitter_frames_keep_their_order_and_come_once)
{
    OneWay sut(test::Random(1).bits());
    for (std::uint32_t i = 0; i < 10'000; ++i)
    {
        sut.take(numbered(i), {.delay_ms = 10.0, .loss = 0.1}, at_us(i / 7)); // Several at once.
    }
    const auto list = arrivals(sut, kEnd);
    EXPECT_EQ(list.size() + sut.counts().lost, 10'000U);
    EXPECT_TRUE(std::ranges::is_sorted(list, std::ranges::less_equal{}, &Arrival::number));
    EXPECT_EQ(std::ranges::adjacent_find(list, {}, &Arrival::number), list.end());
    for (const Arrival& arrival : list)
    {
        ASSERT_EQ(arrival.due, at_us(arrival.number / 7) + milliseconds(10));
    }
}

TEST(OneWay, jitter_reorders_within_its_range_and_loses_nothing)
{
    OneWay sut(test::Random(2).bits());
    constexpr std::uint32_t kFrames = 10'000;
    for (std::uint32_t i = 0; i < kFrames; ++i)
    {
        sut.take(numbered(i), {.delay_ms = 3.0, .jitter_ms = 2.0}, at_us(100 * i));
    }
    const auto list = arrivals(sut, kEnd);
    ASSERT_EQ(list.size(), kFrames);
    EXPECT_TRUE(std::ranges::is_sorted(list, {}, &Arrival::due));
    std::vector<bool> has_come(kFrames);
    std::size_t overtaken = 0;
    for (std::size_t i = 0; i < list.size(); ++i)
    {
        ASSERT_FALSE(has_come[list[i].number]) << "frame " << list[i].number << " came twice";
        has_come[list[i].number] = true;
        const Duration delay = list[i].due - at_us(100 * std::int64_t{list[i].number});
        ASSERT_GE(delay, milliseconds(3));
        ASSERT_LE(delay, milliseconds(5));
        overtaken += i > 0 && list[i].number < list[i - 1].number ? 1U : 0U;
    }
    EXPECT_GT(overtaken, kFrames / 4);
}

TEST(OneWay, what_is_duplicated_comes_twice_and_nothing_else_does)
{
    OneWay sut(test::Random(3).bits());
    for (std::uint32_t i = 0; i < 5'000; ++i)
    {
        sut.take(numbered(i), {.jitter_ms = 1.0, .duplicates = 0.2}, at_us(i));
    }
    std::map<std::uint32_t, std::size_t> times;
    for (const Arrival& arrival : arrivals(sut, kEnd))
    {
        ++times[arrival.number];
    }
    EXPECT_EQ(times.size(), 5'000U);
    EXPECT_EQ(static_cast<std::uint64_t>(std::ranges::count_if(times, [](const auto& entry)
                                                               { return entry.second == 2; })),
              sut.counts().duplicated);
    EXPECT_GT(sut.counts().duplicated, 0U);
    EXPECT_EQ(sut.counts().delivered, 5'000U + sut.counts().duplicated);
}

TEST(OneWay, counts_add_up_whatever_happens)
{
    test::Random random(4);
    OneWay sut(random.bits(), 50'000);
    std::uint64_t came_out = 0;
    std::uint64_t bytes = 0;
    for (std::uint32_t i = 0; i < 20'000; ++i)
    {
        const Bytes frame = udp_frame(random.below(1'472U));
        bytes += frame.size();
        sut.take(frame, {.delay_ms = 2.0, .jitter_ms = 2.0, .loss = 0.1, .duplicates = 0.1},
                 at_us(50 * i));
        if (random.one_in(500))
        {
            random.one_in(2) ? sut.cut() : sut.mend();
        }
        while (sut.take_due(at_us(50 * i)))
        {
            ++came_out;
        }
    }
    while (sut.take_due(kEnd))
    {
        ++came_out;
    }
    const OneWayCounts& counts = sut.counts();
    EXPECT_EQ(counts.frames, 20'000U);
    EXPECT_EQ(counts.udp_datagrams, 20'000U);
    EXPECT_EQ(counts.bytes, bytes);
    EXPECT_EQ(counts.udp_payload_bytes, bytes - 20'000U * (14 + 20 + 8));
    EXPECT_EQ(counts.delivered, came_out);
    EXPECT_EQ(counts.frames + counts.duplicated,
              counts.delivered + counts.lost + counts.cut + counts.dropped_full);
    for (const std::uint64_t each :
         {counts.delivered, counts.lost, counts.duplicated, counts.cut, counts.dropped_full})
    {
        EXPECT_GT(each, 100U);
    }
}

TEST(OneWay, a_full_one_refuses_and_takes_again_when_there_is_room)
{
    OneWay sut(1, 1'000);
    const LinkCondition condition{.delay_ms = 1.0};
    std::uint32_t taken = 0;
    while (sut.counts().dropped_full == 0)
    {
        sut.take(numbered(taken++), condition, at_us(0));
        ASSERT_LT(taken, 10U); // 142 bytes each.
    }
    ASSERT_GT(taken, 3U);
    sut.take(numbered(taken), condition, at_us(0));
    EXPECT_EQ(sut.counts().dropped_full, 2U);
    ASSERT_TRUE(sut.take_due(kEnd));
    sut.take(numbered(99), condition, at_us(1));
    EXPECT_EQ(sut.counts().dropped_full, 2U);
    const auto list = arrivals(sut, kEnd);
    ASSERT_EQ(list.size(), taken - 1U); // One came out, two found no room, and there is 99.
    EXPECT_EQ(list.front().number, 1U);
    EXPECT_EQ(list.back().number, 99U);
}

TEST(OneWay, a_cut_takes_what_is_under_way_and_what_comes_until_it_is_mended)
{
    OneWay sut(1);
    const LinkCondition condition{.delay_ms = 1.0};
    sut.take(numbered(1), condition, at_us(0));
    sut.cut();
    EXPECT_FALSE(sut.next_due());
    sut.take(numbered(2), condition, at_us(1));
    sut.take(arp_frame(), condition, at_us(2));
    EXPECT_FALSE(sut.take_due(kEnd));
    EXPECT_EQ(sut.counts().cut, 3U);
    sut.mend();
    sut.take(numbered(3), condition, at_us(3));
    const auto list = arrivals(sut, kEnd);
    ASSERT_EQ(list.size(), 1U);
    EXPECT_EQ(list[0].number, 3U);
    EXPECT_EQ(sut.counts().cut, 3U);
    EXPECT_EQ(sut.counts().frames, 4U);
}

TEST(OneWay, a_cut_leaves_all_of_the_room)
{
    OneWay sut(1, 1'000);
    const auto fill = [&sut]
    {
        const std::uint64_t refused = sut.counts().dropped_full;
        std::uint32_t taken = 0;
        while (sut.counts().dropped_full == refused)
        {
            sut.take(numbered(taken++), {.delay_ms = 1.0}, at_us(0));
        }
        return taken;
    };
    const std::uint32_t taken = fill();
    sut.cut();
    sut.mend();
    EXPECT_EQ(fill(), taken);
}

TEST(OneWay, an_arp_frame_is_never_lost_nor_duplicated)
{
    OneWay sut(1);
    for (int i = 0; i < 100; ++i)
    {
        sut.take(arp_frame(), {.loss = 1.0}, at_us(0));
        sut.take(arp_frame(), {.duplicates = 1.0}, at_us(0));
        sut.take(udp_frame(1), {.loss = 1.0}, at_us(0));
    }
    EXPECT_EQ(sut.counts().lost, 100U);
    EXPECT_EQ(sut.counts().duplicated, 0U);
    EXPECT_EQ(sut.counts().udp_datagrams, 100U);
    std::size_t arrived = 0;
    while (sut.take_due(kEnd))
    {
        ++arrived;
    }
    EXPECT_EQ(arrived, 200U);
}

TEST(OneWay, a_shorter_delay_lets_later_frames_overtake)
{
    OneWay sut(1);
    sut.take(numbered(1), {.delay_ms = 5.0}, at_us(0));
    sut.take(numbered(2), {.delay_ms = 1.0}, at_us(10));
    const auto list = arrivals(sut, kEnd);
    ASSERT_EQ(list.size(), 2U);
    EXPECT_EQ(list[0].number, 2U);
    EXPECT_EQ(list[0].due, at_us(1'010));
    EXPECT_EQ(list[1].due, at_us(5'000));
}

} // namespace

} // namespace tactus::relay
