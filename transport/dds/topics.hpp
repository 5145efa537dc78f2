// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/entity.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

struct tactus_v5_CatalogueEntry; // idlc's types of samples.
struct tactus_v5_Edits;
struct tactus_v5_ObjectRecord;

namespace tactus::dds
{

/// Version in the names of the topics. Programs with different versions do not receive each other.
inline constexpr std::uint32_t kProtocolVersion = 5;

/// Maximum number of pieces in one request.
inline constexpr std::uint32_t kMaxRequests = 256;
/// Maximum number of requests that wait on a server for one controller.
inline constexpr std::uint32_t kMaxWaiting = 1'024;
/// Maximum number of objects in one sample of motion.
inline constexpr std::uint32_t kMaxMoved = 64;
/// Maximum number of pieces in transit from one server to one controller: 6,400 a second with 20 ms
/// from request to arrival. Readers must keep at least as many samples.
inline constexpr std::uint32_t kCreditPieces = 128;
/// Maximum bytes of pieces in one sample: below the bound in tactus.idl and a UDP datagram.
inline constexpr std::size_t kPayloadBytes = 60'000;
/// Maximum bytes of a header and of a base mesh that a controller fetches.
inline constexpr std::size_t kMaxHeaderBytes = std::size_t{8} << 20U;
inline constexpr std::size_t kMaxBaseBytes = std::size_t{1} << 20U;
/// Number of single edits of a model that its server keeps for readers that are late.
inline constexpr std::uint32_t kKeptEdits = 1'024;
/// Maximum number of parts of the sum of a model's edits: four million removed faces.
inline constexpr std::uint32_t kMaxSumParts = 4'096;
/// Number of samples of a controller that a reader of refinement states keeps; not all samples have
/// a state.
inline constexpr std::int32_t kStateDepth = 16;

enum class Topic : std::uint8_t
{
    catalogue,
    objects,
    motion,
    wanted,
    chunks,
    telemetry,
    states, ///< The same topic for readers that want the refinement states.
    edits,
    edit_requests,
};

/// Creates a writer with the topic's quality of service (docs/protocol.md). A write waits at most 5
/// ms. `domain` must outlive the writer.
[[nodiscard]] Result<Endpoint, Refusal> make_writer(const Domain& domain, Topic topic,
                                                    const std::string& partition);
/// Creates a reader with the topic's quality of service. It drops samples with the identity of
/// another server or controller than their writer's, and those with impossible numbers of objects,
/// models or parts of an edit. `domain` must outlive the reader.
[[nodiscard]] Result<Endpoint, Refusal> make_reader(const Domain& domain, Topic topic,
                                                    const std::string& partition);

/// Reason why the readers of make_reader() drop a sample with these numbers; none if they don't.
[[nodiscard]] std::optional<Refused> fault_of(const tactus_v5_CatalogueEntry& entry) noexcept;
[[nodiscard]] std::optional<Refused> fault_of(const tactus_v5_ObjectRecord& record) noexcept;
/// The payload is checked by edit_from().
[[nodiscard]] std::optional<Refused> fault_of(const tactus_v5_Edits& edit) noexcept;

/// Partition name for readers that matches the partitions of all controllers.
inline constexpr const char* kAnyPartition = "*";
/// Partition in which a server publishes its objects.
[[nodiscard]] std::string server_partition(std::uint64_t server_epoch);
/// Partition in which a controller receives its pieces.
[[nodiscard]] std::string controller_partition(const std::string& name, const ControllerId& id);

/// Number of readers matched with a writer.
[[nodiscard]] std::uint32_t readers_of(const Endpoint& writer);
/// True if a writer has a reader; has_publisher(): true if a reader has a writer.
[[nodiscard]] bool is_matched(const Endpoint& writer);
/// True if a writer of telemetry has a reader of Topic::states. May allocate.
[[nodiscard]] bool has_reader_of_states(const Endpoint& writer);
[[nodiscard]] bool has_publisher(const Endpoint& reader);

} // namespace tactus::dds
