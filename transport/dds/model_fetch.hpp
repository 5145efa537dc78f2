// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/dds/piece_exchange.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tactus::dds
{

/// Fetches header and base mesh of one model, part by part, from whichever host serves it: one that
/// goes in the middle is no loss. What a controller needs before its first wish. One thread.
class ModelFetch final : private PieceReceiver
{
public:
    enum class State : std::uint8_t
    {
        under_way,
        done,    ///< header() and base() are whole and have the right hashes.
        refused, ///< For good; objection() tells why.
    };

    /// Both must outlive it.
    ModelFetch(PieceExchange& exchange, const Catalogue& catalogue, const Catalogue::Offer& offer);
    ModelFetch(const ModelFetch&) = delete;
    ModelFetch& operator=(const ModelFetch&) = delete;
    ~ModelFetch() { exchange_.remove(*this); }

    /// Asks for what is missing, and again where nothing comes. Never waits; between two calls the
    /// exchange is to be stepped.
    State step();

    [[nodiscard]] const ContentHash& model() const override { return offer_.hash; }
    [[nodiscard]] const std::string& objection() const noexcept { return objection_; }
    [[nodiscard]] std::vector<std::byte>& header() noexcept { return header_.bytes; }
    [[nodiscard]] std::vector<std::byte>& base() noexcept { return base_.bytes; }

private:
    using Clock = std::chrono::steady_clock;
    struct Whole
    {
        ContentKind kind;
        std::vector<std::byte> bytes;
        std::vector<bool> is_here; ///< By part.
        std::size_t missing{0};
    };

    [[nodiscard]] static Whole empty(ContentKind kind, std::size_t bytes);
    void receive(ContentKey key, std::span<const std::byte> bytes) override;
    void ask();
    State refuse(std::string objection);
    State check();

    PieceExchange& exchange_;
    const Catalogue& catalogue_;
    Catalogue::Offer offer_;
    Whole header_;
    Whole base_;
    State state_{State::under_way};
    std::string objection_;
    std::size_t open_{0}; ///< Parts that were asked for last and haven't come.
    Clock::time_point asked_{};
};

} // namespace tactus::dds
