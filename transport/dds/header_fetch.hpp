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

/// Fetches one model's header, part by part, from one host. What a controller needs to plan its
/// pools, and before it can check anything else. One thread.
class HeaderFetch final : private PieceReceiver
{
public:
    enum class State : std::uint8_t
    {
        under_way,
        silent,  ///< Likewise, but nothing has come for kSilence.
        done,    ///< header() is whole and has the right hash.
        refused, ///< For good; objection() tells why.
    };

    /// Both must outlive it.
    HeaderFetch(PieceExchange& exchange, const Catalogue& catalogue, const Catalogue::Offer& offer);
    HeaderFetch(const HeaderFetch&) = delete;
    HeaderFetch& operator=(const HeaderFetch&) = delete;
    ~HeaderFetch() { exchange_.remove(*this); }

    /// Asks for what is missing, and again where nothing comes. Never waits; between two calls the
    /// exchange is to be stepped.
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
    std::size_t open_{0}; ///< Parts that were asked for last and haven't come.
    Clock::time_point asked_{};
    Clock::time_point progress_; ///< Begun, or a part came, for the last time.
};

/// Finds a model and fetches its header from the first of its servers that answers: when one is
/// silent for kSilence, goes, or sends what is wrong, all others are asked, kHostsAtOnce at the
/// same time. One thread.
class HeaderSearch
{
public:
    enum class State : std::uint8_t
    {
        not_published,
        under_way,
        done,    ///< offer() is that of the host that sent header().
        refused, ///< All that offered it for a second were wrong; objection() tells the last why.
    };

    /// Both must outlive it.
    HeaderSearch(PieceExchange& exchange, Catalogue& catalogue, ModelSelector selector);

    /// Never waits; between two calls the exchange is to be stepped. Goes on after a refusal: a
    /// server that is right may come.
    State step();
    /// Its server has shown that it isn't to be asked.
    void refuse(const Catalogue::Offer& offer);

    [[nodiscard]] const ModelSelector& selector() const noexcept { return selector_; }
    /// Of the host that was asked last, or that sent the header.
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
    std::vector<std::unique_ptr<HeaderFetch>> fetches_; ///< In the end the one that is done.
    std::vector<std::uint64_t> refused_;                ///< Hosts that were wrong.
    std::string objection_;
    Clock::time_point refused_since_{};
    Clock::time_point looked_{}; ///< For other hosts.
    std::uint64_t seen_catalogue_{0};
    std::uint64_t last_arrival_{0}; ///< Of the host that was asked last.
};

} // namespace tactus::dds
