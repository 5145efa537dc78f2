// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/entity.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace tactus::dds
{

/// Both sides must agree on it; a sample of another version is ignored and reported.
inline constexpr std::uint32_t kProtocolVersion = 1;

/// Names of pieces in one request; also how many a host keeps waiting per controller and model.
inline constexpr std::uint32_t kMaxWishes = 256;
/// Pieces that may be under way to one controller for one model: at 0.6 KB a piece and 20 ms from
/// request to arrival 6,400 a second. Readers keep at least as many samples.
inline constexpr std::uint32_t kCreditPieces = 128;
/// Payload of one sample, in bytes: fits the type's bound and leaves a UDP datagram room.
inline constexpr std::size_t kPayloadBytes = 60'000;

/// Random, one per controller link; names its partition.
using ControllerId = std::array<std::uint8_t, 16>;

enum class Topic : std::uint8_t
{
    catalogue,
    model,
    wanted,
    chunks,
    poses,
    telemetry
};

/// Creates a writer or reader with the topic's quality of service (docs/protocol.md). No call on it
/// blocks for more than 5 ms. The domain must outlive it.
[[nodiscard]] Result<Endpoint, Refusal> make_writer(const Domain& domain, Topic topic,
                                                    const std::string& partition);
[[nodiscard]] Result<Endpoint, Refusal> make_reader(const Domain& domain, Topic topic,
                                                    std::span<const std::string> partitions);

/// Partition of what concerns one model, whoever serves it.
[[nodiscard]] std::string model_partition(const ContentHash& model);
/// Partition of what one controller gets of one model.
[[nodiscard]] std::string controller_partition(const ControllerId& controller,
                                               const ContentHash& model);

/// Random bits from the system: host epochs and controller ids.
[[nodiscard]] std::uint64_t random_bits();
[[nodiscard]] ControllerId random_controller();

/// Whether a reader or writer has anybody on the other side.
[[nodiscard]] bool is_matched(const Endpoint& writer);
[[nodiscard]] bool has_publisher(const Endpoint& reader);

} // namespace tactus::dds
