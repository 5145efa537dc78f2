// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/relay/frame_content.hpp"
#include "tests/unit/relay/made_frames.hpp"

#include <gtest/gtest.h>

namespace tactus::relay
{

namespace
{

void expect_udp(const Bytes& frame, std::uint32_t datagrams, std::uint32_t payload_bytes)
{
    const FrameContent sut = content_of(frame);
    EXPECT_FALSE(sut.is_arp);
    EXPECT_EQ(sut.udp_datagrams, datagrams);
    EXPECT_EQ(sut.udp_payload_bytes, payload_bytes);
}

TEST(FrameContent, a_datagram_counts_with_its_payload)
{
    expect_udp(udp_frame(0), 1, 0);
    expect_udp(udp_frame(1), 1, 1);
    expect_udp(udp_frame(1'472), 1, 1'472);
    expect_udp(ip_frame({.option_words = 10}, 108), 1, 100);
}

TEST(FrameContent, a_fragmented_datagram_counts_once_and_with_all_of_its_payload)
{
    // 3,000 bytes in pieces of 1,480 bytes of IP content each.
    expect_udp(ip_frame({.has_more = true}, 1'480), 1, 1'472);
    expect_udp(ip_frame({.offset_bytes = 1'480, .has_more = true}, 1'480), 0, 1'480);
    expect_udp(ip_frame({.offset_bytes = 2'960}, 48), 0, 48);
}

TEST(FrameContent, other_protocols_and_types_are_no_udp)
{
    expect_udp(ip_frame({.protocol = 6}, 100), 0, 0);
    expect_udp(ip_frame({.protocol = 1, .offset_bytes = 1'480}, 100), 0, 0);
    expect_udp(ethernet_frame(0x86DD, Bytes(100, std::byte{0x45})), 0, 0);
    Bytes version_six = udp_frame(100);
    version_six[14] = std::byte{0x65};
    expect_udp(version_six, 0, 0);
}

TEST(FrameContent, arp_is_told)
{
    const FrameContent sut = content_of(arp_frame());
    EXPECT_TRUE(sut.is_arp);
    EXPECT_EQ(sut.udp_datagrams, 0U);
    EXPECT_EQ(sut.udp_payload_bytes, 0U);
}

TEST(FrameContent, padding_behind_a_short_packet_is_not_counted)
{
    Bytes frame = udp_frame(2);
    frame.resize(60);
    expect_udp(frame, 1, 2);
}

TEST(FrameContent, a_frame_cut_anywhere_is_no_udp)
{
    const Bytes frame = udp_frame(10);
    for (std::size_t size = 0; size < frame.size(); ++size)
    {
        SCOPED_TRACE(size);
        // A buffer of its own, so that a sanitizer sees a read behind it.
        expect_udp(Bytes(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size)), 0, 0);
    }
}

TEST(FrameContent, headers_that_contradict_each_other_are_no_udp)
{
    Bytes short_header = udp_frame(10);
    short_header[14] = std::byte{0x44};
    expect_udp(short_header, 0, 0);
    Bytes shorter_than_its_header = udp_frame(10);
    shorter_than_its_header[17] = std::byte{19};
    expect_udp(shorter_than_its_header, 0, 0);
    expect_udp(ip_frame({}, 7), 0, 0); // No room for UDP's header.
}

} // namespace

} // namespace tactus::relay
