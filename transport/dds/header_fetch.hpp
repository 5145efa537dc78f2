// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/dds/piece_exchange.hpp"
#include "transport/part_intake.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tactus::dds
{

/// Fetches one model's header, part by part, from one server. A controller needs the header to plan
/// its pools and to verify everything else. One thread.
class HeaderFetch final : private PieceReceiver
{
public:
    enum class State : std::uint8_t
    {
        under_way,
        silent,  ///< Under way, but nothing has arrived for kSilence.
        done,    ///< header() is complete and has the right hash.
        refused, ///< Final; objection() has the reason.
    };

    /// `exchange` and `catalogue` must outlive the fetch.
    HeaderFetch(PieceExchange& exchange, const Catalogue& catalogue, const Catalogue::Offer& offer);
    HeaderFetch(const HeaderFetch&) = delete;
    HeaderFetch& operator=(const HeaderFetch&) = delete;
    ~HeaderFetch() { exchange_.remove(*this); }

    /// Requests missing parts, again after a timeout. Never waits; the exchange must be stepped
    /// between two calls.
    State step();

    [[nodiscard]] const ContentHash& model() const override { return offer_.hash; }
    [[nodiscard]] const Catalogue::Offer& offer() const noexcept { return offer_; }
    [[nodiscard]] const std::string& objection() const noexcept { return objection_; }
    [[nodiscard]] std::vector<std::byte>& header() noexcept { return header_.bytes(); }

private:
    using Clock = std::chrono::steady_clock;
    void receive(std::uint64_t host_epoch, ContentKey key,
                 std::span<const std::byte> bytes) override;
    void ask();
    State refuse(std::string objection);
    State check();

    PieceExchange& exchange_;
    const Catalogue& catalogue_;
    Catalogue::Offer offer_;
    PartIntake header_;
    State state_{State::under_way};
    std::string objection_;
    std::size_t open_{0}; ///< Parts requested last that have not arrived.
    Clock::time_point asked_{};
    Clock::time_point progress_; ///< Time of the start or of the last part.
};

/// Finds a model and fetches its header from the first of its servers that answers. If one is
/// silent for kSilence, leaves, or sends wrong bytes, all others are asked, kHostsAtOnce at a time.
/// One thread.
class HeaderSearch
{
public:
    enum class State : std::uint8_t
    {
        not_published,
        under_way,
        done, ///< offer() is that of the server that sent header().
        /// Every server sent a wrong header for a second; objection() has the last reason.
        refused,
    };

    /// `exchange` and `catalogue` must outlive the search.
    HeaderSearch(PieceExchange& exchange, Catalogue& catalogue, ModelSelector selector);

    /// Never waits; the exchange must be stepped between two calls. Continues after a refusal,
    /// since a correct server may appear.
    State step();
    /// Excludes the server of this offer from the search.
    void refuse(const Catalogue::Offer& offer);

    [[nodiscard]] const ModelSelector& selector() const noexcept { return selector_; }
    /// Offer of the server that was asked last, or that sent the header.
    [[nodiscard]] const Catalogue::Offer& offer() const noexcept { return offer_; }
    [[nodiscard]] const std::string& objection() const noexcept { return objection_; }
    [[nodiscard]] std::vector<std::byte>& header() noexcept { return fetches_.front()->header(); }

private:
    using Clock = std::chrono::steady_clock;
    void look_for_hosts(std::size_t most);

    PieceExchange& exchange_;
    Catalogue& catalogue_;
    ModelSelector selector_;
    Catalogue::Offer offer_;
    /// Open fetches; at the end only the complete one.
    std::vector<std::unique_ptr<HeaderFetch>> fetches_;
    std::vector<std::uint64_t> refused_; ///< Servers that sent wrong headers.
    std::string objection_;
    Clock::time_point refused_since_{};
    Clock::time_point looked_{}; ///< Time of the last search for other servers.
    std::uint64_t seen_catalogue_{0};
    std::uint64_t last_arrival_{0}; ///< Arrival number of the server that was asked last.
};

} // namespace tactus::dds
