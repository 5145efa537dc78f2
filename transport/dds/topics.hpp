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

/// Version in the topics' names; programs with another version are not heard.
inline constexpr std::uint32_t kProtocolVersion = 5;

/// Maximum number of pieces in one request.
inline constexpr std::uint32_t kMaxRequests = 256;
/// Maximum number of pieces that a server keeps waiting for one controller.
inline constexpr std::uint32_t kMaxWaiting = 1'024;
/// Maximum number of objects in one sample of motion.
inline constexpr std::uint32_t kMaxMoved = 64;
/// Maximum number of pieces in transit from one server to one controller: at 0.6 KB a piece and 20
/// ms from request to arrival, 6,400 a second. Readers keep at least as many samples.
inline constexpr std::uint32_t kCreditPieces = 128;
/// Payload of one sample, in bytes: within the type's bound and below a UDP datagram.
inline constexpr std::size_t kPayloadBytes = 60'000;
/// Maximum bytes of a header and of a base mesh that a controller fetches.
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

/// Creates a writer with the topic's quality of service (docs/protocol.md). No call on it blocks
/// for more than 5 ms. The domain must outlive it.
[[nodiscard]] Result<Endpoint, Refusal> make_writer(const Domain& domain, Topic topic,
                                                    const std::string& partition);
/// Creates a reader likewise. It drops samples that name another server or controller than their
/// writer's participant, and those with impossible numbers of objects or models.
[[nodiscard]] Result<Endpoint, Refusal> make_reader(const Domain& domain, Topic topic,
                                                    const std::string& partition);

/// Partition of all controllers, for readers.
inline constexpr const char* kAnyPartition = "*";
/// Partition in which a server publishes its objects.
[[nodiscard]] std::string host_partition(std::uint64_t host_epoch);
/// Partition in which one controller receives its pieces.
[[nodiscard]] std::string controller_partition(const std::string& name, const ControllerId& id);

/// Number of readers that a writer is matched with.
[[nodiscard]] std::uint32_t readers_of(const Endpoint& writer);
/// True if a writer has a reader, or a reader a writer.
[[nodiscard]] bool is_matched(const Endpoint& writer);
[[nodiscard]] bool has_publisher(const Endpoint& reader);

} // namespace tactus::dds
