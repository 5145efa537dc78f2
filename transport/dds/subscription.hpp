// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/model_pieces.hpp"
#include "transport/dds/request_queue.hpp"
#include "transport/dds/topics.hpp"
#include "transport/dds/writer_lanes.hpp"
#include "transport/log.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tactus::dds
{

/// Buffers shared by all subscriptions.
struct PieceBuffers
{
    std::vector<std::byte> payload;
    std::vector<std::byte> piece;
};

/// One controller, on the server: its requests, its credit, and its own writers in its own
/// partition, so that no other controller waits for it.
class Subscription
{
public:
    /// Credit in a request.
    struct Credit
    {
        std::uint64_t seen{0};
        std::uint64_t granted{0};
        std::uint64_t received{0};
    };

    /// Counting starts at the first request's `seen`: a controller that was thought dead and
    /// returns continues its count.
    [[nodiscard]] static Result<Subscription, Refusal> create(const Domain& domain,
                                                              const ControllerId& controller,
                                                              std::string controller_name,
                                                              std::uint64_t seen);

    [[nodiscard]] const ControllerId& controller() const noexcept { return controller_; }
    [[nodiscard]] const std::string& controller_name() const noexcept { return controller_name_; }

    /// Adds a request; the piece must exist.
    void request(const HostPiece& piece, std::uint32_t generation)
    {
        requests_.add(piece, generation);
    }
    /// Updates the credit. Requests may arrive out of order, so the counts only grow. `seen` is at
    /// most the number sent, and `granted` at most kCreditPieces more than `seen`.
    void set_credit(const Credit& credit) noexcept;
    /// Creates new writers if the controller reports for 300 ms that pieces never arrived: a forged
    /// packet in a writer's name makes its readers ignore that writer. Returns the owner of the old
    /// ones; null if nothing was done. Repetitions get rarer each time.
    [[nodiscard]] std::shared_ptr<void> try_heal(Backoff::Clock::time_point now);

    /// True if send_one() has something to send, provided that the controller's reader is present.
    [[nodiscard]] bool has_work() const noexcept
    {
        return !requests_.empty() && sent_ < credit_.granted;
    }
    /// Sends one sample of as many requested pieces as credit and payload allow. A piece that
    /// cannot be read is skipped and logged. False if nothing was sent.
    bool send_one(std::uint64_t host_epoch, std::span<const ModelPieces> models, PieceBuffers& room,
                  RateLimitedLog& log);
    /// Notifies the controller that it may read the objects. False while its reader is not present.
    bool let_in(std::uint64_t host_epoch);

    [[nodiscard]] std::uint64_t pieces_sent() const noexcept { return pieces_sent_; }
    [[nodiscard]] std::uint64_t bytes_sent() const noexcept { return bytes_sent_; }
    /// Number of pieces that wait to be sent.
    [[nodiscard]] std::size_t requests() const noexcept { return requests_.size(); }

private:
    explicit Subscription(WriterLanes writers)
        : writers_(std::move(writers)), requests_(kMaxWaiting)
    {
    }

    [[nodiscard]] std::uint64_t fill(std::span<const ModelPieces> models, PieceBuffers& room,
                                     RateLimitedLog& log);
    bool write(std::uint64_t host_epoch, std::uint64_t pieces, bool lets_in,
               std::vector<std::byte>& payload);

    ControllerId controller_{};
    std::string controller_name_;
    WriterLanes writers_;
    RequestQueue requests_;
    Credit credit_;
    std::uint64_t lost_{0};              ///< Pieces sent that did not arrive, as last reported.
    std::uint64_t given_up_{UINT64_MAX}; ///< Lost pieces that are not healed any more.
    Backoff::Clock::time_point overdue_since_{};
    std::uint64_t sent_{0};
    std::uint64_t pieces_sent_{0};
    std::uint64_t bytes_sent_{0};
};

} // namespace tactus::dds
