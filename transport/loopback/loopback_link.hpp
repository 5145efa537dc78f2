// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/chunk_link.hpp"

#include <cstdint>
#include <vector>

namespace tactus
{

/// Faults that a LoopbackLink applies to passing pieces. Shares are in 0 .. 1, per piece and
/// independent.
struct LoopbackFaults
{
    std::uint64_t seed{1};
    double loss{0.0};
    double duplicates{0.0};
    double damage{0.0};  ///< Share of pieces with one bit flipped.
    double mix_ups{0.0}; ///< Share of pieces delivered under the key of the one before.
    std::uint32_t delay_polls_min{0}; ///< Least delay of a piece, in polls.
    std::uint32_t delay_polls_max{0}; ///< Greatest delay; unequal delays reorder.
};

/// An in-process stand-in for a network: wraps another link and delays, loses, repeats, reorders,
/// damages and mixes up its pieces, reproducibly from a seed. For tests; it allocates.
class LoopbackLink final : public ChunkLink, private PieceSink
{
public:
    LoopbackLink(ChunkLink& wrapped, const LoopbackFaults& faults);

    void request(std::span<const ContentKey> keys, std::uint32_t generation) override;
    void poll(PieceSink& sink) override;
    [[nodiscard]] LinkState state() const override { return state_; }
    [[nodiscard]] std::uint64_t session() const override { return session_; }
    [[nodiscard]] std::uint64_t bytes_received() const override { return bytes_received_; }

    /// Removes the server and all pieces in transit.
    void lose_host();
    /// Restores a server, the same or another one.
    void regain_host();

private:
    struct InFlight
    {
        ContentKey key;
        std::uint64_t due_poll{0};
        std::vector<std::byte> bytes;
    };

    void receive(ContentKey key, std::span<const std::byte> bytes) override;
    void launch(ContentKey key, std::span<const std::byte> bytes);
    [[nodiscard]] std::uint64_t next_random() noexcept;
    [[nodiscard]] bool happens(double share) noexcept;

    ChunkLink& wrapped_;
    LoopbackFaults faults_;
    LinkState state_{LinkState::connected};
    std::uint64_t session_{1};
    std::uint64_t random_;
    std::uint64_t polls_{0};
    std::uint64_t bytes_received_{0};
    ContentKey last_key_{};
    std::vector<InFlight> in_flight_;
};

} // namespace tactus
