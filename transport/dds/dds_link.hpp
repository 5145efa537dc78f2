// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/chunk_link.hpp"
#include "transport/dds/catalogue.hpp"
#include "transport/dds/piece_exchange.hpp"
#include "transport/log.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::dds
{

/// One model's pieces from whichever host on the domain serves that model (that hash) at present.
///
/// When the host goes, the link says so and waits; when one comes back with the same hash, under
/// whatever epoch, it is adopted and counted as a new session: the same bytes need no reloading.
///
/// Links of one exchange take turns in stepping it: what comes for one while another is polled
/// waits until its own next poll.
class DdsLink final : public ChunkLink, private PieceReceiver
{
public:
    /// `exchange` and `catalogue` must outlive the link.
    DdsLink(PieceExchange& exchange, Catalogue& catalogue, const Catalogue::Offer& offer, Log log);
    ~DdsLink() override { exchange_.remove(*this); }

    void request(std::span<const ContentKey> keys, std::uint32_t generation) override;
    void poll(PieceSink& sink) override;
    [[nodiscard]] LinkState state() const override { return state_; }
    [[nodiscard]] std::uint64_t session() const override { return session_; }
    [[nodiscard]] std::uint64_t bytes_received() const override { return bytes_received_; }

private:
    [[nodiscard]] const ContentHash& model() const override { return offer_.hash; }
    void receive(ContentKey key, std::span<const std::byte> bytes) override;
    void follow_host();
    void adopt(const Catalogue::Offer& offer);

    PieceExchange& exchange_;
    Catalogue& catalogue_;
    Catalogue::Offer offer_; ///< Of the host that is followed.
    RateLimitedLog log_;
    ContentHash refused_hash_{}; ///< Of the changed file that was last reported.
    LinkState state_{LinkState::connected};
    std::uint64_t session_{1};
    std::uint64_t seen_catalogue_{0};
    std::uint64_t seen_steps_{0};
    std::vector<std::byte> arrived_; ///< Framed, until the next poll.
    std::uint64_t bytes_received_{0};
};

} // namespace tactus::dds
