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
        silent,  ///< Under way, without a new part for kSilence.
        done,    ///< header() is complete and verified.
        refused, ///< Final: the header is wrong; objection() has the reason.
    };

    /// `exchange` and `catalogue` must outlive the fetch.
    HeaderFetch(PieceExchange& exchange, const Catalogue& catalogue, const Catalogue::Offer& offer);
    HeaderFetch(const HeaderFetch&) = delete;
    HeaderFetch& operator=(const HeaderFetch&) = delete;
    ~HeaderFetch() { exchange_.remove(*this); }

    /// Requests missing parts, again after a timeout. Never waits. Call PieceExchange::step()
    /// between two calls.
    State step();

    [[nodiscard]] const ContentHash& model() const override { return offer_.hash; }
    [[nodiscard]] const Catalogue::Offer& offer() const noexcept { return offer_; }
    [[nodiscard]] const std::string& objection() const noexcept { return objection_; }
    [[nodiscard]] std::vector<std::byte>& header() noexcept { return header_.bytes(); }

private:
    using Clock = std::chrono::steady_clock;
    void receive(std::uint64_t server_epoch, ContentKey key,
                 std::span<const std::byte> bytes) override;
    void request_missing();
    State refuse(std::string objection);
    State check();

    PieceExchange& exchange_;
    const Catalogue& catalogue_;
    Catalogue::Offer offer_;
    PartIntake header_;
    State state_{State::under_way};
    std::string objection_;
    std::size_t open_{0}; ///< Number of parts in the last request that have not arrived.
    Clock::time_point asked_{};
    Clock::time_point progress_; ///< Time when the fetch began or a part last arrived.
};

/// Finds a model and fetches its header from the first of its servers that answers. If that server
/// is silent for kSilence, leaves or sends wrong bytes, the others are asked, kServersAtOnce at a
/// time. One thread.
class HeaderSearch
{
public:
    enum class State : std::uint8_t
    {
        not_published,
        under_way,
        done, ///< header() is verified; offer() is from the server that sent it.
        /// All servers have sent wrong headers for a second; objection() has the last reason.
        refused,
    };

    /// `exchange` and `catalogue` must outlive the search.
    HeaderSearch(PieceExchange& exchange, Catalogue& catalogue, ModelSelector selector);

    /// Never waits. Call PieceExchange::step() between two calls. The search goes on after
    /// `refused`, since a correct server may appear.
    State step();
    /// Ends the fetch from this offer's server and never asks the server again.
    void refuse(const Catalogue::Offer& offer);

    [[nodiscard]] const ModelSelector& selector() const noexcept { return selector_; }
    /// Offer of the server that sent the header; before that, of the server asked or refused last.
    [[nodiscard]] const Catalogue::Offer& offer() const noexcept { return offer_; }
    [[nodiscard]] const std::string& objection() const noexcept { return objection_; }
    [[nodiscard]] std::vector<std::byte>& header() noexcept { return fetches_.front()->header(); }

private:
    using Clock = std::chrono::steady_clock;
    void look_for_servers(std::size_t most);

    PieceExchange& exchange_;
    Catalogue& catalogue_;
    ModelSelector selector_;
    Catalogue::Offer offer_;
    /// Fetches under way; after `done` only the complete one.
    std::vector<std::unique_ptr<HeaderFetch>> fetches_;
    std::vector<std::uint64_t> refused_; ///< Epochs of servers that refuse() excluded.
    std::string objection_;
    Clock::time_point refused_since_{};
    Clock::time_point looked_{}; ///< Time of the last search for other servers.
    std::uint64_t seen_catalogue_{0};
    std::uint64_t last_arrival_{0}; ///< Catalogue::Offer::arrival of the last server asked.
};

} // namespace tactus::dds
