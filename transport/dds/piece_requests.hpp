// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/dds/model_pieces.hpp"
#include "transport/dds/request_queue.hpp"
#include "transport/dds/topics.hpp"
#include "transport/log.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

struct tactus_v5_Wanted; // idlc's type of a sample.

namespace tactus::dds
{

/// Memory for building samples, shared by all controllers of a server.
struct PieceBuffers
{
    std::vector<std::byte> payload;
    std::vector<std::byte> piece;
};

/// Requests of one controller and its credit, as untrusted samples state them, and the payloads
/// that answer them. No network.
class PieceRequests
{
public:
    /// Credit as stated in a request (CreditWindow); all numbers are totals of pieces.
    struct Credit
    {
        std::uint64_t seen{0};
        std::uint64_t granted{0};
        std::uint64_t received{0};
    };

    /// `sent`: number of pieces that were sent before, as the controller states it.
    explicit PieceRequests(std::uint64_t sent) : queue_(kMaxWaiting), sent_(sent) {}

    /// Queues the pieces of a sample, except those that no model has. Returns the number of the
    /// latter.
    [[nodiscard]] std::uint32_t take(const tactus_v5_Wanted& wanted,
                                     std::span<const ModelPieces> models);
    /// Queues a request; the piece must exist.
    void add(const ServerPiece& piece, std::uint32_t generation) { queue_.add(piece, generation); }
    /// Updates the credit from a request. Requests may arrive out of order, so values never
    /// decrease. `seen` is limited to the number sent, and `granted` to kCreditPieces beyond
    /// `seen`.
    void set_credit(const Credit& credit) noexcept;

    /// True if there are requests and credit.
    [[nodiscard]] bool has_work() const noexcept
    {
        return !queue_.empty() && sent_ < credit_.granted;
    }
    /// Fills the payload with as many requested pieces as credit and kPayloadBytes allow, which
    /// leave the queue. Unreadable pieces are skipped and logged. Returns the number of pieces.
    [[nodiscard]] std::uint64_t fill(std::span<const ModelPieces> models, PieceBuffers& room,
                                     RateLimitedLog& log);
    /// Counts filled pieces as sent.
    void on_sent(std::uint64_t pieces) noexcept { sent_ += pieces; }

    /// Total of pieces sent.
    [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }
    /// Number of sent pieces that did not arrive, as last reported.
    [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }

private:
    RequestQueue queue_;
    Credit credit_;
    std::uint64_t lost_{0};
    std::uint64_t sent_{0};
};

} // namespace tactus::dds
