// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus::relay
{

/// Content of an Ethernet frame by its headers.
struct FrameContent
{
    bool is_arp{false};
    /// Datagrams: 1 for a whole one and for the first fragment of one.
    std::uint32_t udp_datagrams{0};
    std::uint32_t udp_payload_bytes{0}; ///< Bytes without the eight bytes of UDP's header.
};

/// Reads Ethernet, IPv4 and UDP headers. A datagram in IP fragments is counted once, with its first
/// one, and its payload in each. Truncated or contradictory headers count as no UDP.
[[nodiscard]] FrameContent content_of(std::span<const std::byte> frame);

} // namespace tactus::relay
