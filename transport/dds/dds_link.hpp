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

/// One model's pieces from any host on the domain that serves that model (that hash) at present.
/// Their hashes prove them, so any host may send them.
///
/// A piece that doesn't come for kSilence is asked of others, kHostsAtOnce at the same time. One
/// that answers in the place of a silent one is asked first from then on; one that has sent what
/// was wrong is asked no more while there are others.
///
/// When all hosts are gone, the link says so and waits; when one comes with the same hash, under
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
    [[nodiscard]] bool distrust(ContentKey key) override;
    void poll(PieceSink& sink) override;
    [[nodiscard]] LinkState state() const override { return state_; }
    [[nodiscard]] std::uint64_t session() const override { return session_; }
    [[nodiscard]] std::uint64_t bytes_received() const override { return bytes_received_; }

private:
    using Clock = std::chrono::steady_clock;
    /// A piece that was asked for and hasn't come.
    struct Asked
    {
        Clock::time_point first{}; ///< When it was asked for first,
        Clock::time_point last{};  ///< and last, by who wants it.
        Clock::time_point since{}; ///< When it was asked of other hosts, or first.
        std::uint32_t generation{0};
        bool has_come{false}; ///< It is among what the next poll hands over.
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
    Catalogue::Offer offer_; ///< Of the host that is asked first.
    RateLimitedLog log_;
    ContentHash refused_hash_{}; ///< Of the changed file that was last reported.
    LinkState state_{LinkState::connected};
    std::uint64_t session_{1};
    std::uint64_t seen_catalogue_{0};
    std::uint64_t seen_steps_{0};
    std::vector<std::byte> arrived_;     ///< Framed, until the next poll; the number of the sender
                                         ///< is in the place of the revision.
    std::vector<std::uint64_t> senders_; ///< Hosts by that number.
    std::uint64_t handed_over_from_{0};  ///< The host that sent what a sink has.
    std::uint64_t bytes_received_{0};
    std::map<PieceId, Asked> asked_;
    std::set<std::uint64_t> base_from_;     ///< Hosts of which parts of the base mesh came.
    std::vector<std::uint64_t> distrusted_; ///< Hosts that sent what was wrong.
    std::set<std::uint64_t> told_;          ///< Hosts of which a line told that they are passed.
    Clock::time_point first_heard_{};       ///< The host that is asked first, for the last time.
    Clock::time_point looked_{};            ///< For what doesn't come.
    std::uint64_t last_arrival_{0};         ///< Of the host that was asked last of the others.
    Clock::time_point distrusted_since_{};
};

} // namespace tactus::dds
