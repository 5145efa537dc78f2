// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/entity.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

namespace tactus::dds
{

/// In the topics' names: who speaks another one is not heard.
inline constexpr std::uint32_t kProtocolVersion = 5;

/// Names of pieces in one request.
inline constexpr std::uint32_t kMaxWishes = 256;
/// Names that a host keeps waiting for one controller.
inline constexpr std::uint32_t kMaxWaiting = 1'024;
/// Objects in one sample of motion.
inline constexpr std::uint32_t kMaxMoved = 64;
/// Pieces that may be under way from one host to one controller: at 0.6 KB a piece and 20 ms from
/// request to arrival 6,400 a second. Readers keep at least as many samples.
inline constexpr std::uint32_t kCreditPieces = 128;
/// Payload of one sample, in bytes: fits the type's bound and leaves a UDP datagram room.
inline constexpr std::size_t kPayloadBytes = 60'000;
/// Most bytes of a header and of a base mesh that a controller fetches.
inline constexpr std::size_t kMaxHeaderBytes = std::size_t{8} << 20U;
inline constexpr std::size_t kMaxBaseBytes = std::size_t{1} << 20U;

enum class Topic : std::uint8_t
{
    catalogue,
    objects,
    motion,
    wanted,
    chunks,
    telemetry,
    front
};

/// Creates a writer or reader with the topic's quality of service (docs/protocol.md). No call on it
/// blocks for more than 5 ms. The domain must outlive it.
[[nodiscard]] Result<Endpoint, Refusal> make_writer(const Domain& domain, Topic topic,
                                                    const std::string& partition);
/// Samples that name another host or controller than their writer's participant never get into the
/// reader, nor those of objects and models with numbers that can't be.
[[nodiscard]] Result<Endpoint, Refusal> make_reader(const Domain& domain, Topic topic,
                                                    const std::string& partition);

/// Of all controllers, for readers.
inline constexpr const char* kAnyPartition = "*";
/// Where a host tells of its objects.
[[nodiscard]] std::string host_partition(std::uint64_t host_epoch);
/// Where one controller gets its pieces.
[[nodiscard]] std::string controller_partition(const std::string& name, const ControllerId& id);

/// How many a writer has on the other side.
[[nodiscard]] std::uint32_t readers_of(const Endpoint& writer);
/// Whether a reader or writer has anybody there.
[[nodiscard]] bool is_matched(const Endpoint& writer);
[[nodiscard]] bool has_publisher(const Endpoint& reader);

} // namespace tactus::dds
