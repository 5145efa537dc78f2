// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::relay
{

using Bytes = std::vector<std::byte>;

/// An Ethernet frame of this type with this content.
inline Bytes ethernet_frame(std::uint16_t type, const Bytes& content)
{
    Bytes frame(12, std::byte{0x02});
    frame.push_back(static_cast<std::byte>(type >> 8U));
    frame.push_back(static_cast<std::byte>(type & 0xFFU));
    frame.insert(frame.end(), content.begin(), content.end());
    return frame;
}

struct PacketFields
{
    std::uint8_t protocol{17};
    std::uint8_t option_words{0};  ///< Of 4 bytes, behind the IP header.
    std::uint16_t offset_bytes{0}; ///< Of a fragment; a multiple of 8.
    bool has_more{false};          ///< Fragments behind this one.
};

/// An IPv4 packet in a frame. `content` is what follows the IP header, UDP's header included.
inline Bytes ip_frame(const PacketFields& fields, std::size_t content)
{
    const std::size_t header = 20 + 4 * std::size_t{fields.option_words};
    Bytes packet(header + content, std::byte{0});
    packet[0] = static_cast<std::byte>(0x45U + fields.option_words);
    packet[2] = static_cast<std::byte>(packet.size() >> 8U);
    packet[3] = static_cast<std::byte>(packet.size() & 0xFFU);
    const unsigned place = fields.offset_bytes / 8U + (fields.has_more ? 0x2000U : 0U);
    packet[6] = static_cast<std::byte>(place >> 8U);
    packet[7] = static_cast<std::byte>(place & 0xFFU);
    packet[9] = static_cast<std::byte>(fields.protocol);
    return ethernet_frame(0x0800, packet);
}

/// A UDP datagram with this payload, all in one frame.
inline Bytes udp_frame(std::size_t payload)
{
    return ip_frame({}, payload + 8);
}

inline Bytes arp_frame()
{
    return ethernet_frame(0x0806, Bytes(28, std::byte{1}));
}

} // namespace tactus::relay
