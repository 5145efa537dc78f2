// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "transport/chunk_link.hpp"
#include "transport/dds/catalogue.hpp"
#include "transport/dds/credit.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/topics.hpp"
#include "transport/dds/writer_lanes.hpp"
#include "transport/log.hpp"

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

namespace tactus::dds
{

/// One model's pieces from whichever host on the domain serves that model (that hash) at present.
///
/// When the host goes, the link says so and waits; when one comes back with the same hash, under
/// whatever epoch, it is adopted and counted as a new session: the same bytes need no reloading.
class DdsLink final : public ChunkLink
{
public:
    /// `domain` and `catalogue` must outlive the link.
    [[nodiscard]] static Result<std::unique_ptr<DdsLink>, Refusal>
    create(const Domain& domain, Catalogue& catalogue, const Catalogue::Offer& offer,
           const std::string& controller_name, Log log);

    void request(std::span<const ContentKey> keys, std::uint32_t generation) override;
    void poll(PieceSink& sink) override;
    [[nodiscard]] LinkState state() const override { return state_; }
    [[nodiscard]] std::uint64_t session() const override { return session_; }
    [[nodiscard]] std::uint64_t bytes_received() const override { return bytes_received_; }

    /// Whether the host has our wishes' writer and its writer for us has our reader: from then on
    /// nothing is lost. Needs poll() meanwhile.
    [[nodiscard]] bool is_ready() const;

private:
    using Clock = std::chrono::steady_clock;

    DdsLink(Catalogue& catalogue, const Catalogue::Offer& offer, std::string controller_name,
            Log log);

    void follow_host();
    void adopt(const Catalogue::Offer& offer);
    void take_pieces(PieceSink& sink);
    void take_sample(std::span<const std::byte> payload, std::uint64_t sent, PieceSink& sink);
    void keep_credit();
    void send(std::span<const ContentKey> keys);

    Catalogue& catalogue_;
    ModelSelector model_; ///< Pinned to the hash.
    std::uint32_t revision_;
    std::uint64_t host_epoch_;
    std::string controller_name_;
    RateLimitedLog log_;
    ControllerId controller_{};
    std::optional<WriterLanes> wanted_; ///< From create() on.
    Endpoint chunks_;
    CreditWindow credit_{kCreditPieces};
    ContentHash refused_hash_{}; ///< Of the changed file that was last reported.
    LinkState state_{LinkState::connected};
    std::uint64_t session_{1};
    std::uint32_t generation_{0};
    std::uint64_t granted_sent_{0}; ///< As last told to the host.
    bool awaits_pieces_{false};     ///< Something was asked for since the last sample came.
    Clock::time_point last_sent_{};
    Clock::time_point last_progress_{};
    std::uint64_t bytes_received_{0};
};

} // namespace tactus::dds
