// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/model_pieces.hpp"
#include "transport/dds/topics.hpp"
#include "transport/dds/wish_queue.hpp"
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

/// Room that all subscriptions use in turn.
struct PieceBuffers
{
    std::vector<std::byte> payload;
    std::vector<std::byte> piece;
};

/// One controller, on the host: its wishes, its credit, and writers of its own in a partition of
/// its own, so that no other controller waits for it.
class Subscription
{
public:
    /// What a request says about the credit.
    struct Credit
    {
        std::uint64_t seen{0};
        std::uint64_t granted{0};
        std::uint64_t received{0};
    };

    /// The first request's `seen` is where counting starts: a controller that was thought dead and
    /// speaks again goes on counting.
    [[nodiscard]] static Result<Subscription, Refusal> create(const Domain& domain,
                                                              const ControllerId& controller,
                                                              std::string controller_name,
                                                              std::uint64_t seen);

    [[nodiscard]] const ControllerId& controller() const noexcept { return controller_; }
    [[nodiscard]] const std::string& controller_name() const noexcept { return controller_name_; }

    /// Pieces that there are.
    void wish(const HostPiece& piece, std::uint32_t generation) { wishes_.add(piece, generation); }
    /// Requests may come in another order than they were sent in: the counts only grow. Nobody has
    /// seen more than was sent, nor grants more than kCreditPieces beyond what it has seen.
    void set_credit(const Credit& credit) noexcept;
    /// Makes new writers where pieces are missing for 300 ms that the controller says were
    /// sent and never came: who forged a packet in a writer's name has made its readers deaf to it.
    /// Returns what owns the old ones when it did so, which is less often each time; null else.
    [[nodiscard]] std::shared_ptr<void> try_heal(Backoff::Clock::time_point now);

    /// Whether send_one() would find something to do, were the controller's reader there.
    [[nodiscard]] bool has_work() const noexcept
    {
        return !wishes_.empty() && sent_ < credit_.granted;
    }
    /// Sends one sample of as many wished pieces as credit and payload allow. A piece that can't be
    /// read is skipped and named in the log. False when nothing was sent.
    bool send_one(std::uint64_t host_epoch, std::span<const ModelPieces> models, PieceBuffers& room,
                  RateLimitedLog& log);
    /// Tells the controller that it may read the objects. False while its reader is not there.
    bool let_in(std::uint64_t host_epoch);

    [[nodiscard]] std::uint64_t pieces_sent() const noexcept { return pieces_sent_; }
    [[nodiscard]] std::uint64_t bytes_sent() const noexcept { return bytes_sent_; }
    /// Pieces that wait to be sent.
    [[nodiscard]] std::size_t wishes() const noexcept { return wishes_.size(); }

private:
    explicit Subscription(WriterLanes writers) : writers_(std::move(writers)), wishes_(kMaxWaiting)
    {
    }

    [[nodiscard]] std::uint64_t fill(std::span<const ModelPieces> models, PieceBuffers& room,
                                     RateLimitedLog& log);
    bool write(std::uint64_t host_epoch, std::uint64_t pieces, bool lets_in,
               std::vector<std::byte>& payload);

    ControllerId controller_{};
    std::string controller_name_;
    WriterLanes writers_;
    WishQueue wishes_;
    Credit credit_;
    std::uint64_t lost_{0}; ///< Pieces that were sent and didn't come, as it last said.
    std::uint64_t given_up_{UINT64_MAX}; ///< Those of them that nothing is done about any more.
    Backoff::Clock::time_point overdue_since_{};
    std::uint64_t sent_{0};
    std::uint64_t pieces_sent_{0};
    std::uint64_t bytes_sent_{0};
};

} // namespace tactus::dds
