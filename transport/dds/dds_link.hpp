// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/chunk_link.hpp"
#include "transport/dds/catalogue.hpp"
#include "transport/dds/piece_exchange.hpp"
#include "transport/log.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace tactus::dds
{

/// Link to one model, served by any server on the domain that has the model's hash. The hashes
/// prove the pieces, so any of these servers may send them.
///
/// Pieces are requested from one server, the first. If a piece does not arrive within kSilence, it
/// is requested from other servers too, kServersAtOnce at a time. If one of them answers in place
/// of a silent first server, it becomes the first. A server that sent wrong bytes is not asked
/// while there are others.
///
/// If no server has the model, the link reports server_gone and waits. The next server with the
/// hash, even under another epoch, begins a new session; resident data stay valid.
///
/// Links share the exchange: poll() steps it unless another link has done so since the last poll().
/// Pieces for a link wait until the link's own poll().
class DdsLink final : public ChunkLink, private PieceReceiver
{
public:
    /// `exchange` and `catalogue` must outlive the link.
    DdsLink(PieceExchange& exchange, Catalogue& catalogue, const Catalogue::Offer& offer, Log log);
    ~DdsLink() override { exchange_.remove(*this); }

    void request(std::span<const ContentKey> keys, std::uint32_t generation) override;
    [[nodiscard]] bool distrust(ContentKey key) override;
    void poll(PieceSink& sink) override;
    [[nodiscard]] LinkState state() const override { return state_; }
    [[nodiscard]] std::uint64_t session() const override { return session_; }
    [[nodiscard]] std::uint64_t bytes_received() const override { return bytes_received_; }

private:
    using Clock = std::chrono::steady_clock;
    /// A requested piece that has not arrived.
    struct Asked
    {
        Clock::time_point first{}; ///< Time of the first request, or of the report of a wrong hash.
        Clock::time_point last{};  ///< Time of the last request().
        /// Start of the wait after which other servers are asked: `first` or the last such request.
        Clock::time_point since{};
        std::uint32_t generation{0};
        bool has_come{false}; ///< True if the piece is in `arrived_`.
    };
    using PieceId = std::pair<ContentKind, std::uint32_t>;

    [[nodiscard]] const ContentHash& model() const override { return offer_.hash; }
    void receive(std::uint64_t server_epoch, ContentKey key,
                 std::span<const std::byte> bytes) override;
    void follow_server();
    void adopt(const Catalogue::Offer& offer);
    void ask_others();
    void put_first(const Catalogue::Offer& offer);
    void take_over(const Catalogue::Offer& offer);
    void distrust_server(std::uint64_t server);
    [[nodiscard]] bool is_trusted(std::uint64_t server) const;
    [[nodiscard]] std::vector<const Catalogue::Offer*> others() const;
    [[nodiscard]] std::uint32_t number_of(std::uint64_t server);

    PieceExchange& exchange_;
    Catalogue& catalogue_;
    Catalogue::Offer offer_; ///< Offer of the first server.
    RateLimitedLog log_;
    ContentHash refused_hash_{}; ///< Other hash under the model's name that was logged last.
    LinkState state_{LinkState::connected};
    std::uint64_t session_{1};
    std::uint64_t seen_catalogue_{0};
    std::uint64_t seen_steps_{0};
    /// Framed pieces for the next poll(); their revision field holds an index into `senders_`.
    std::vector<std::byte> arrived_;
    std::vector<std::uint64_t> senders_; ///< Epochs of servers that sent pieces.
    std::uint64_t handed_over_from_{0};  ///< Epoch of the sender of the piece delivered last.
    std::uint64_t bytes_received_{0};
    std::map<PieceId, Asked> asked_;
    std::set<std::uint64_t> base_from_;     ///< Servers that sent parts of the base mesh.
    std::vector<std::uint64_t> distrusted_; ///< Servers that sent wrong bytes.
    std::set<std::uint64_t> told_;    ///< Servers that were replaced as the first, with a log line.
    Clock::time_point first_heard_{}; ///< Time of the last piece from the first server.
    Clock::time_point looked_{};      ///< Time of the last check for missing pieces.
    std::uint64_t last_arrival_{0};   ///< Catalogue::Offer::arrival of the last other server asked.
    Clock::time_point distrusted_since_{};
};

} // namespace tactus::dds
