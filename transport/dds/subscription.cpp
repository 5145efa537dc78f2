// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/subscription.hpp"

#include "transport/dds/piece_frame.hpp"

#include <utility>

#include "tactus.h"

namespace tactus::dds
{

Result<Subscription, Refusal> Subscription::create(const Domain& domain, const ModelStore& store,
                                                   const ControllerId& controller,
                                                   std::string controller_name, std::uint64_t seen)
{
    auto writers =
        WriterLanes::create(domain, Topic::chunks, controller_partition(controller, store.hash()));
    if (!writers)
    {
        return writers.error();
    }
    Subscription subscription(store, std::move(writers).value());
    subscription.controller_ = controller;
    subscription.controller_name_ = std::move(controller_name);
    subscription.sent_ = seen;
    return subscription;
}

bool Subscription::send_one(std::uint64_t host_epoch, std::vector<std::byte>& payload,
                            std::vector<std::byte>& piece, RateLimitedLog& log)
{
    if (!has_work() || !writers_.is_matched())
    {
        return false; // Written before the reader is known, a sample would reach nobody.
    }
    const std::uint64_t pieces = fill(payload, piece, log);
    if (pieces == 0)
    {
        return false;
    }
    tactus_v1_Pieces sample = {};
    sample.host_epoch = host_epoch;
    sample.sent = sent_ + pieces;
    const auto length = static_cast<std::uint32_t>(payload.size());
    sample.payload = {length, length, reinterpret_cast<std::uint8_t*>(payload.data()), false};
    tactus_v1_Pieces probe = {};
    probe.host_epoch = host_epoch;
    probe.sent = sent_;
    if (!writers_.write(&sample, &probe))
    {
        return false; // The pieces count as lost: the controller asks again.
    }
    sent_ += pieces;
    pieces_sent_ += pieces;
    bytes_sent_ += length;
    return true;
}

std::uint64_t Subscription::fill(std::vector<std::byte>& payload, std::vector<std::byte>& piece,
                                 RateLimitedLog& log)
{
    payload.clear();
    std::uint64_t pieces = 0;
    while (!wishes_.empty() && sent_ + pieces < credit_.granted)
    {
        const ContentKey key = wishes_.front();
        if (payload.size() + kFrameBytes + store_->coded_bytes(key) > kPayloadBytes)
        {
            break;
        }
        wishes_.pop_front();
        if (auto done = store_->read(key, piece); !done)
        {
            log.write(done.error().text);
            continue;
        }
        append_piece(
            payload,
            {store_->hash(), store_->revision(), static_cast<std::uint32_t>(key.kind), key.number},
            piece);
        ++pieces;
    }
    return pieces;
}

} // namespace tactus::dds
