// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/subscription.hpp"

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
    Subscription subscription(std::move(writers).value(), seen);
    subscription.controller_ = controller;
    subscription.controller_name_ = std::move(controller_name);
    return subscription;
}

std::shared_ptr<void> Subscription::try_heal(Backoff::Clock::time_point now)
{
    if (requests_.lost() <= given_up_)
    {
        given_up_ = requests_.lost(); // No further pieces are lost, or late ones have arrived.
        overdue_since_ = now;
        return nullptr;
    }
    auto old = now - overdue_since_ < kOverdue ? nullptr : writers_.try_renew(now);
    if (old != nullptr)
    {
        given_up_ = requests_.lost();
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
    const std::uint64_t pieces = requests_.fill(models, room, log);
    if (pieces == 0 || !write(server_epoch, pieces, false, room.payload))
    {
        return false; // The pieces are lost: the controller requests them again.
    }
    requests_.on_sent(pieces);
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
    sample.sent = requests_.sent();
    const tactus_v5_Pieces probe = sample;
    sample.sent += pieces;
    sample.lets_in = lets_in;
    const auto length = static_cast<std::uint32_t>(payload.size());
    sample.payload = {length, length, reinterpret_cast<std::uint8_t*>(payload.data()), false};
    return writers_.write(&sample, &probe, payload.size());
}

} // namespace tactus::dds
