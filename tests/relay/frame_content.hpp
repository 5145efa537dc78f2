// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus::relay
{

/// What is said of an Ethernet frame by its headers.
struct FrameContent
{
    bool is_arp{false};
    std::uint32_t udp_datagrams{0};     ///< 1 for a whole datagram and for the first piece of one.
    std::uint32_t udp_payload_bytes{0}; ///< Without the eight bytes of UDP's header.
};

/// Reads Ethernet, IPv4 and UDP headers. A datagram that was cut into IP fragments is counted once,
/// with its first one, and its payload piece by piece. Headers that are cut short or contradict
/// each other count as no UDP.
[[nodiscard]] FrameContent content_of(std::span<const std::byte> frame);

} // namespace tactus::relay
