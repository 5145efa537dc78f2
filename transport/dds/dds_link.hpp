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

/// One model's pieces from any server on the domain that has that model (that hash) at present. The
/// hashes prove the pieces, so any server may send them.
///
/// A piece that does not arrive within kSilence is requested from other servers, kHostsAtOnce at a
/// time. A server that answers in place of a silent one is asked first from then on; one that sent
/// wrong bytes is not asked while there are others.
///
/// If all servers are gone, the link reports that and waits. If one with the same hash appears,
/// under any epoch, it is adopted and counted as a new session: the same bytes need no reloading.
///
/// Links of one exchange take turns in stepping it: pieces for one link that arrive while another
/// is polled wait until its own next poll.
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
        Clock::time_point first{}; ///< Time of the first request.
        Clock::time_point last{};  ///< Time of the caller's last request.
        /// Time of the last request to other servers, otherwise of the first one.
        Clock::time_point since{};
        std::uint32_t generation{0};
        bool has_come{false}; ///< True if the next poll delivers it.
    };
    using PieceId = std::pair<ContentKind, std::uint32_t>;

    [[nodiscard]] const ContentHash& model() const override { return offer_.hash; }
    void receive(std::uint64_t host_epoch, ContentKey key,
                 std::span<const std::byte> bytes) override;
    void follow_host();
    void adopt(const Catalogue::Offer& offer);
    void ask_others();
    void put_first(const Catalogue::Offer& offer);
    void take_over(const Catalogue::Offer& offer);
    void distrust_host(std::uint64_t host);
    [[nodiscard]] bool is_trusted(std::uint64_t host) const;
    [[nodiscard]] std::vector<const Catalogue::Offer*> others() const;
    [[nodiscard]] std::uint32_t number_of(std::uint64_t host);

    PieceExchange& exchange_;
    Catalogue& catalogue_;
    Catalogue::Offer offer_; ///< Offer of the server that is asked first.
    RateLimitedLog log_;
    ContentHash refused_hash_{}; ///< Hash of the changed file that was last reported.
    LinkState state_{LinkState::connected};
    std::uint64_t session_{1};
    std::uint64_t seen_catalogue_{0};
    std::uint64_t seen_steps_{0};
    /// Framed pieces until the next poll; the sender's number is in the place of the revision.
    std::vector<std::byte> arrived_;
    std::vector<std::uint64_t> senders_; ///< Servers by that number.
    std::uint64_t handed_over_from_{0};  ///< Server that sent the piece which a sink has.
    std::uint64_t bytes_received_{0};
    std::map<PieceId, Asked> asked_;
    std::set<std::uint64_t> base_from_;     ///< Servers that sent parts of the base mesh.
    std::vector<std::uint64_t> distrusted_; ///< Servers that sent wrong bytes.
    std::set<std::uint64_t> told_;          ///< Servers whose replacement was logged.
    Clock::time_point first_heard_{}; ///< Time when the server that is asked first was last heard.
    Clock::time_point looked_{};      ///< Time of the last check for missing pieces.
    std::uint64_t last_arrival_{0};   ///< Arrival number of the other server that was asked last.
    Clock::time_point distrusted_since_{};
};

} // namespace tactus::dds
