// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/dds/piece_exchange.hpp"
#include "transport/part_intake.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tactus::dds
{

/// Fetches one model's header, part by part, from whichever host serves it: one that goes in the
/// middle is no loss. What a controller needs to plan its pools, and before it can check anything
/// else. One thread.
class HeaderFetch final : private PieceReceiver
{
public:
    enum class State : std::uint8_t
    {
        under_way,
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
    [[nodiscard]] const std::string& objection() const noexcept { return objection_; }
    [[nodiscard]] std::vector<std::byte>& header() noexcept { return header_.bytes(); }

private:
    using Clock = std::chrono::steady_clock;
    void receive(ContentKey key, std::span<const std::byte> bytes) override;
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
};

} // namespace tactus::dds
