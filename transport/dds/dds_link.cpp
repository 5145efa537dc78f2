// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/dds_link.hpp"

#include "transport/content_hash.hpp"
#include "transport/dds/piece_frame.hpp"

#include <fmt/format.h>

#include <utility>

namespace tactus::dds
{

DdsLink::DdsLink(PieceExchange& exchange, Catalogue& catalogue, const Catalogue::Offer& offer,
                 Log log)
    : exchange_(exchange), catalogue_(catalogue), offer_(offer), log_(std::move(log))
{
    exchange.add(*this);
    exchange.meet(offer.host_epoch);
}

void DdsLink::request(std::span<const ContentKey> keys, std::uint32_t generation)
{
    if (state_ == LinkState::connected) // Else asked again by the courier in the next session.
    {
        exchange_.ask(offer_.host_epoch, offer_.model, keys, generation);
    }
}

void DdsLink::poll(PieceSink& sink)
{
    if (exchange_.steps() == seen_steps_) // Nobody has since our last poll.
    {
        exchange_.step();
    }
    seen_steps_ = exchange_.steps();
    if (catalogue_.version() != seen_catalogue_)
    {
        seen_catalogue_ = catalogue_.version();
        follow_host();
    }
    PieceReader reader(arrived_);
    for (auto piece = reader.next(); piece; piece = reader.next())
    {
        sink.receive({static_cast<ContentKind>(piece->key.kind), piece->key.number}, piece->bytes);
    }
    arrived_.clear();
}

void DdsLink::receive(ContentKey key, std::span<const std::byte> bytes)
{
    if (key.kind != ContentKind::header)
    {
        append_piece(arrived_, {offer_.hash, 0, static_cast<std::uint32_t>(key.kind), key.number},
                     bytes);
        bytes_received_ += kFrameBytes + bytes.size();
    }
}

void DdsLink::follow_host()
{
    const Catalogue::Offer* same_host = catalogue_.find(offer_.hash, offer_.host_epoch);
    const bool was_connected = state_ == LinkState::connected;
    if (same_host != nullptr && was_connected)
    {
        return;
    }
    const Catalogue::Offer* offer =
        same_host != nullptr ? same_host : catalogue_.find({offer_.name, offer_.hash});
    if (offer != nullptr)
    {
        adopt(*offer);
        return;
    }
    if (was_connected)
    {
        state_ = LinkState::host_gone;
        log_.write(
            fmt::format("host of model '{}' is gone; going on with what is resident", offer_.name));
    }
    const Catalogue::Offer* changed = catalogue_.find({offer_.name, std::nullopt});
    if (changed != nullptr && changed->hash != refused_hash_)
    {
        refused_hash_ = changed->hash;
        log_.write(fmt::format("model '{}' is now published with another hash, {}; what is "
                               "resident is kept",
                               offer_.name, hash_text(changed->hash)));
    }
}

void DdsLink::adopt(const Catalogue::Offer& offer)
{
    const bool is_restarted = offer.host_epoch != offer_.host_epoch;
    offer_ = offer;
    exchange_.meet(offer.host_epoch);
    state_ = LinkState::connected;
    ++session_;
    log_.write(fmt::format("model '{}' is served again{}", offer_.name,
                           is_restarted ? ", by another host or a restarted one with the same file"
                                        : " by the same host"));
}

} // namespace tactus::dds
