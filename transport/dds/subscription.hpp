// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/model_pieces.hpp"
#include "transport/dds/piece_requests.hpp"
#include "transport/dds/topics.hpp"
#include "transport/dds/writer_lanes.hpp"
#include "transport/log.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tactus::dds
{

/// State of one controller on the server: requests, credit, and writers in a partition of its own,
/// so that no controller waits for another.
class Subscription
{
public:
    /// The number of sent pieces starts at `seen` of the first request, so that a controller that
    /// was taken for gone continues its count.
    [[nodiscard]] static Result<Subscription, Refusal> create(const Domain& domain,
                                                              const ControllerId& controller,
                                                              std::string controller_name,
                                                              std::uint64_t seen);

    [[nodiscard]] const ControllerId& controller() const noexcept { return controller_; }
    [[nodiscard]] const std::string& controller_name() const noexcept { return controller_name_; }

    /// Requests and credit, for samples of this controller.
    [[nodiscard]] PieceRequests& requests() noexcept { return requests_; }
    /// Replaces the writers if the controller reports for 300 ms that pieces did not arrive: a
    /// forged packet in a writer's name makes readers ignore the writer. Returns the owner of the
    /// old writers; null if nothing was replaced. Limited by a Backoff.
    [[nodiscard]] std::shared_ptr<void> try_heal(Backoff::Clock::time_point now);

    /// True if there are requests and credit. send_one() also needs the controller's reader.
    [[nodiscard]] bool has_work() const noexcept { return requests_.has_work(); }
    /// Sends one sample of PieceRequests::fill(). False if nothing was sent.
    bool send_one(std::uint64_t server_epoch, std::span<const ModelPieces> models,
                  PieceBuffers& room, RateLimitedLog& log);
    /// Tells the controller that it may read the objects. False if its reader is not present or the
    /// write fails.
    bool admit(std::uint64_t server_epoch);

    [[nodiscard]] std::uint64_t pieces_sent() const noexcept { return pieces_sent_; }
    [[nodiscard]] std::uint64_t bytes_sent() const noexcept { return bytes_sent_; }

private:
    Subscription(WriterLanes writers, std::uint64_t seen)
        : writers_(std::move(writers)), requests_(seen)
    {
    }

    bool write(std::uint64_t server_epoch, std::uint64_t pieces, bool lets_in,
               std::vector<std::byte>& payload);

    ControllerId controller_{};
    std::string controller_name_;
    WriterLanes writers_;
    PieceRequests requests_;
    std::uint64_t given_up_{UINT64_MAX}; ///< Lost pieces up to which writers are not replaced.
    Backoff::Clock::time_point overdue_since_{};
    std::uint64_t pieces_sent_{0};
    std::uint64_t bytes_sent_{0};
};

} // namespace tactus::dds
