// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Basis of the network tests: delay, order, losses and counts are the requested ones.

#include "tests/relay/one_way.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <vector>

namespace tactus::relay
{
namespace
{

using Bytes = std::vector<std::byte>;

constexpr MonotonicTime kEnd{std::numeric_limits<std::int64_t>::max()};
constexpr std::uint32_t kFrames = 20'000;
constexpr std::uint16_t kArp = 0x0806;

MonotonicTime at_us(std::int64_t time)
{
    return MonotonicTime{} + microseconds(time);
}

/// Ethernet frame of a protocol unknown to the relay, or of ARP.
Bytes numbered(std::uint32_t number, std::uint16_t type = 0x88B5)
{
    Bytes frame(60, std::byte{0});
    frame[12] = static_cast<std::byte>(type >> 8U);
    frame[13] = static_cast<std::byte>(type & 0xFFU);
    std::memcpy(frame.data() + 20, &number, sizeof(number));
    return frame;
}

struct Arrival
{
    std::uint32_t number;
    MonotonicTime due;
};

std::vector<Arrival> arrivals(OneWay& sut)
{
    std::vector<Arrival> list;
    for (auto due = sut.next_due(); due; due = sut.next_due())
    {
        EXPECT_FALSE(sut.take_due(*due + nanoseconds(-1)));
        const auto frame = sut.take_due(*due);
        if (!frame)
        {
            ADD_FAILURE() << "a frame that is due is held back";
            break;
        }
        Arrival& arrival = list.emplace_back(Arrival{0, *due});
        std::memcpy(&arrival.number, frame->data() + 20, sizeof(arrival.number));
    }
    return list;
}

std::vector<Arrival> sent_over(OneWay& sut, const LinkCondition& condition)
{
    for (std::uint32_t i = 0; i < kFrames; ++i)
    {
        sut.take(numbered(i), condition, at_us(100 * std::int64_t{i}));
    }
    return arrivals(sut);
}

/// Expects a count within five standard deviations of the share.
void expect_share(std::uint64_t found, double share, double frames)
{
    EXPECT_NEAR(static_cast<double>(found), share * frames,
                5.0 * std::sqrt(share * frames * (1.0 - share)));
}

TEST(OneWay, delays_each_frame_as_asked_and_keeps_the_order)
{
    OneWay sut(1);
    const auto list = sent_over(sut, {.delay_ms = 10.0});
    ASSERT_EQ(list.size(), kFrames);
    for (std::uint32_t i = 0; i < kFrames; ++i)
    {
        ASSERT_EQ(list[i].number, i);
        ASSERT_EQ(list[i].due, at_us(100 * std::int64_t{i}) + milliseconds(10));
    }
}

TEST(OneWay, jitter_fills_its_range_and_lets_frames_overtake)
{
    OneWay sut(2);
    const auto list = sent_over(sut, {.delay_ms = 3.0, .jitter_ms = 2.0});
    ASSERT_EQ(list.size(), kFrames);
    std::vector<Duration> delays;
    std::size_t overtaken = 0;
    for (std::size_t i = 0; i < list.size(); ++i)
    {
        delays.push_back(list[i].due - at_us(100 * std::int64_t{list[i].number}));
        overtaken += i > 0 && list[i].number < list[i - 1].number ? 1U : 0U;
    }
    const auto [least, most] = std::ranges::minmax(delays);
    EXPECT_GE(least, milliseconds(3));
    EXPECT_LT(least, microseconds(3'010));
    EXPECT_LE(most, milliseconds(5));
    EXPECT_GT(most, microseconds(4'990));
    EXPECT_GT(overtaken, kFrames / 4);
}

TEST(OneWay, loses_and_doubles_the_shares_asked_for_by_its_seed)
{
    const LinkCondition condition{.jitter_ms = 1.0, .loss = 0.1, .duplicates = 0.2};
    OneWay sut(3);
    OneWay same(3);
    OneWay other(4);
    auto list = sent_over(sut, condition);
    const OneWayCounts& counts = sut.counts();
    expect_share(counts.lost, 0.1, kFrames);
    expect_share(counts.duplicated, 0.2, static_cast<double>(kFrames - counts.lost));
    EXPECT_EQ(counts.delivered, list.size());
    EXPECT_EQ(counts.frames + counts.duplicated, counts.delivered + counts.lost);
    EXPECT_TRUE(
        std::ranges::equal(list, sent_over(same, condition), {}, &Arrival::due, &Arrival::due));
    EXPECT_NE(sent_over(other, condition).size(), list.size());
    std::ranges::sort(list, {}, &Arrival::number);
    const auto again =
        std::unique(list.begin(), list.end(),
                    [](const Arrival& a, const Arrival& b) { return a.number == b.number; });
    EXPECT_EQ(list.end() - again, static_cast<std::ptrdiff_t>(counts.duplicated));
}

TEST(OneWay, never_loses_or_doubles_arp)
{
    OneWay sut(1);
    for (std::uint32_t i = 0; i < 100; ++i)
    {
        sut.take(numbered(i, kArp), {.loss = 1.0}, at_us(0));
        sut.take(numbered(i, kArp), {.duplicates = 1.0}, at_us(0));
    }
    EXPECT_EQ(arrivals(sut).size(), 200U);
}

TEST(OneWay, a_cut_takes_what_is_under_way_and_what_comes_until_it_is_mended)
{
    OneWay sut(1);
    const LinkCondition condition{.delay_ms = 1.0};
    sut.take(numbered(1), condition, at_us(0));
    sut.cut();
    sut.take(numbered(2), condition, at_us(1));
    EXPECT_FALSE(sut.take_due(kEnd));
    EXPECT_EQ(sut.counts().cut, 2U);
    sut.restore();
    sut.take(numbered(3), condition, at_us(3));
    const auto list = arrivals(sut);
    ASSERT_EQ(list.size(), 1U);
    EXPECT_EQ(list[0].number, 3U);
}

TEST(FrameContent, tells_payloads_of_udp_from_headers_also_in_fragments)
{
    const auto content = [](unsigned fragment_offset)
    {
        Bytes frame = numbered(0, 0x0800);
        frame.resize(14 + 20 + 8 + 100);
        const unsigned total = 20 + 8 + 100;
        frame[14] = std::byte{0x45};
        frame[17] = static_cast<std::byte>(total);
        frame[21] = static_cast<std::byte>(fragment_offset);
        frame[23] = std::byte{17};
        return content_of(frame);
    };
    EXPECT_EQ(content(0).udp_datagrams, 1U);
    EXPECT_EQ(content(0).udp_payload_bytes, 100U);
    EXPECT_EQ(content(8).udp_datagrams, 0U);
    EXPECT_EQ(content(8).udp_payload_bytes, 108U);
}

} // namespace
} // namespace tactus::relay
