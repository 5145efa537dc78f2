// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/relay/frame_content.hpp"

namespace tactus::relay
{

namespace
{

constexpr std::size_t kEthernetBytes = 14;
constexpr std::size_t kIpBytesMin = 20;
constexpr std::size_t kUdpBytes = 8;
constexpr std::uint32_t kArp = 0x0806;
constexpr std::uint32_t kIpv4 = 0x0800;
constexpr std::uint32_t kUdp = 17;
constexpr std::uint32_t kFragmentOffset = 0x1FFF;

std::uint32_t byte_at(std::span<const std::byte> bytes, std::size_t at)
{
    return std::to_integer<std::uint32_t>(bytes[at]);
}

/// Big-endian number of the wire.
std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t at)
{
    return byte_at(bytes, at) << 8U | byte_at(bytes, at + 1);
}

FrameContent content_of_ip(std::span<const std::byte> packet)
{
    if (packet.size() < kIpBytesMin || byte_at(packet, 0) >> 4U != 4 || byte_at(packet, 9) != kUdp)
    {
        return {};
    }
    const std::size_t header = (byte_at(packet, 0) & 0xFU) * std::size_t{4};
    const std::size_t total = word_at(packet, 2); // A short frame is padded behind it.
    if (header < kIpBytesMin || total < header || total > packet.size())
    {
        return {};
    }
    const auto content = static_cast<std::uint32_t>(total - header);
    if ((word_at(packet, 6) & kFragmentOffset) != 0)
    {
        return {.udp_payload_bytes = content};
    }
    if (content < kUdpBytes)
    {
        return {};
    }
    return {.udp_datagrams = 1,
            .udp_payload_bytes = content - static_cast<std::uint32_t>(kUdpBytes)};
}

} // namespace

FrameContent content_of(std::span<const std::byte> frame)
{
    if (frame.size() < kEthernetBytes)
    {
        return {};
    }
    const std::uint32_t type = word_at(frame, kEthernetBytes - 2);
    if (type == kArp)
    {
        return {.is_arp = true};
    }
    return type == kIpv4 ? content_of_ip(frame.subspan(kEthernetBytes)) : FrameContent{};
}

} // namespace tactus::relay
