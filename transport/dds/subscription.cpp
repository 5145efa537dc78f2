// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/subscription.hpp"

#include "transport/dds/piece_frame.hpp"

#include <utility>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// Time after which pieces count as lost; longer than the repetition of a lost datagram.
constexpr auto kOverdue = std::chrono::milliseconds(300);

} // namespace

Result<Subscription, Refusal> Subscription::create(const Domain& domain,
                                                   const ControllerId& controller,
                                                   std::string controller_name, std::uint64_t seen)
{
    auto writers = WriterLanes::create(domain, Topic::chunks,
                                       controller_partition(controller_name, controller));
    if (!writers)
    {
        return writers.error();
    }
    Subscription subscription(std::move(writers).value());
    subscription.controller_ = controller;
    subscription.controller_name_ = std::move(controller_name);
    subscription.sent_ = seen;
    return subscription;
}

void Subscription::set_credit(const Credit& credit) noexcept
{
    const std::uint64_t seen = std::min(credit.seen, sent_);
    lost_ = seen - std::min(credit.received, seen);
    credit_.seen = std::max(credit_.seen, seen);
    credit_.granted =
        std::max(credit_.granted, std::min(credit.granted, credit_.seen + kCreditPieces));
    credit_.received = std::max(credit_.received, credit.received);
}

std::shared_ptr<void> Subscription::try_heal(Backoff::Clock::time_point now)
{
    if (lost_ <= given_up_)
    {
        given_up_ = lost_; // No further pieces are lost, or late ones have arrived.
        overdue_since_ = now;
        return nullptr;
    }
    auto old = now - overdue_since_ < kOverdue ? nullptr : writers_.try_renew(now);
    if (old != nullptr)
    {
        given_up_ = lost_;
        overdue_since_ = now;
    }
    return old;
}

bool Subscription::send_one(std::uint64_t server_epoch, std::span<const ModelPieces> models,
                            PieceBuffers& room, RateLimitedLog& log)
{
    if (!has_work() || !writers_.is_matched())
    {
        return false; // DDS drops samples written before the reader is known.
    }
    const std::uint64_t pieces = fill(models, room, log);
    if (pieces == 0 || !write(server_epoch, pieces, false, room.payload))
    {
        return false; // The pieces are lost: the controller requests them again.
    }
    sent_ += pieces;
    pieces_sent_ += pieces;
    bytes_sent_ += room.payload.size();
    return true;
}

bool Subscription::admit(std::uint64_t server_epoch)
{
    std::vector<std::byte> nothing;
    return writers_.is_matched() && write(server_epoch, 0, true, nothing);
}

bool Subscription::write(std::uint64_t server_epoch, std::uint64_t pieces, bool lets_in,
                         std::vector<std::byte>& payload)
{
    tactus_v5_Pieces sample = {};
    sample.server_epoch = server_epoch;
    sample.sent = sent_;
    const tactus_v5_Pieces probe = sample;
    sample.sent += pieces;
    sample.lets_in = lets_in;
    const auto length = static_cast<std::uint32_t>(payload.size());
    sample.payload = {length, length, reinterpret_cast<std::uint8_t*>(payload.data()), false};
    return writers_.write(&sample, &probe, payload.size());
}

std::uint64_t Subscription::fill(std::span<const ModelPieces> models, PieceBuffers& room,
                                 RateLimitedLog& log)
{
    room.payload.clear();
    std::uint64_t pieces = 0;
    while (!requests_.empty() && sent_ + pieces < credit_.granted)
    {
        const ServerPiece request = requests_.front();
        const ModelPieces& model = models[request.model];
        if (room.payload.size() + kFrameBytes + model.bytes(request.key) > kPayloadBytes)
        {
            break;
        }
        requests_.pop_front();
        if (auto done = model.read(request.key, room.piece); !done)
        {
            log.write(done.error().text);
            continue;
        }
        append_piece(room.payload,
                     {model.store().hash(), model.store().revision(),
                      static_cast<std::uint32_t>(request.key.kind), request.key.number},
                     room.piece);
        ++pieces;
    }
    return pieces;
}

} // namespace tactus::dds
