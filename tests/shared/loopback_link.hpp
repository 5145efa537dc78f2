// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/chunk_link.hpp"

#include <cstdint>
#include <vector>

namespace tactus
{

/// Faults that a LoopbackLink applies to pieces. Shares are probabilities, 0 to 1, independent for
/// each piece.
struct LoopbackFaults
{
    std::uint64_t seed{1};
    double loss{0.0};
    double duplicates{0.0};
    double damage{0.0};  ///< Share of pieces in which one bit is flipped.
    double mix_ups{0.0}; ///< Share of pieces delivered under the key of the previous piece.
    std::uint32_t delay_polls_min{0}; ///< Minimum delay of a piece, in calls of poll().
    /// Maximum delay; if above the minimum, pieces are reordered.
    std::uint32_t delay_polls_max{0};
};

/// Link for tests that imitates a network: wraps another link and delays, loses, repeats, reorders,
/// damages and mixes up its pieces, reproducibly from a seed. Allocates.
class LoopbackLink final : public ChunkLink, private PieceSink
{
public:
    LoopbackLink(ChunkLink& wrapped, const LoopbackFaults& faults);

    void request(std::span<const ContentKey> keys, std::uint32_t generation) override;
    void poll(PieceSink& sink) override;
    [[nodiscard]] LinkState state() const override { return state_; }
    [[nodiscard]] std::uint64_t session() const override { return session_; }
    [[nodiscard]] std::uint64_t bytes_received() const override { return bytes_received_; }

    /// Imitates the loss of the server: drops all pieces in transit, and state() is server_gone.
    void lose_server();
    /// Imitates the return of a server: a new session.
    void regain_server();

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
