// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/header_fetch.hpp"

#include "transport/content_hash.hpp"
#include "transport/dds/topics.hpp"
#include "transport/served_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tactus::dds
{

namespace
{

/// Parts asked for at once: 1.8 MB.
constexpr std::size_t kPartsAtOnce = 64;
/// Nothing came for so long: asked again. Longer than a round trip of any use to a hand.
constexpr auto kAgain = std::chrono::milliseconds(100);

} // namespace

HeaderFetch::HeaderFetch(PieceExchange& exchange, const Catalogue& catalogue,
                         const Catalogue::Offer& offer)
    : exchange_(exchange)
    , catalogue_(catalogue)
    , offer_(offer)
    , header_(ContentKind::header, std::min<std::size_t>(offer.header_bytes, kMaxHeaderBytes))
{
    exchange.add(*this);
    if (offer.header_bytes == 0 || offer.header_bytes > kMaxHeaderBytes || offer.base_bytes == 0 ||
        offer.base_bytes > kMaxBaseBytes)
    {
        refuse(fmt::format("is announced with a header of {} bytes and a base mesh of {}; at most "
                           "{} and {}",
                           offer.header_bytes, offer.base_bytes, kMaxHeaderBytes, kMaxBaseBytes));
    }
}

HeaderFetch::State HeaderFetch::step()
{
    if (state_ != State::under_way)
    {
        return state_;
    }
    if (header_.missing() == 0)
    {
        return check();
    }
    const auto now = Clock::now();
    if (open_ == 0 || now - asked_ >= kAgain)
    {
        asked_ = now;
        ask();
    }
    return state_;
}

void HeaderFetch::receive(ContentKey key, std::span<const std::byte> bytes)
{
    if (header_.receive(key, bytes))
    {
        open_ -= open_ > 0 ? 1 : 0;
    }
}

/// Of the host that has the model now; without one nothing is asked.
void HeaderFetch::ask()
{
    const Catalogue::Offer* offer = catalogue_.find(offer_.hash, offer_.host_epoch);
    offer = offer != nullptr ? offer : catalogue_.find({offer_.name, offer_.hash});
    if (offer == nullptr)
    {
        return;
    }
    offer_.host_epoch = offer->host_epoch;
    std::vector<ContentKey> keys;
    header_.list_missing(keys, kPartsAtOnce);
    open_ = keys.size();
    exchange_.ask(offer->host_epoch, offer->model, keys, 0);
}

HeaderFetch::State HeaderFetch::refuse(std::string objection)
{
    objection_ = std::move(objection);
    return state_ = State::refused;
}

HeaderFetch::State HeaderFetch::check()
{
    const auto header = parse_trusted_header(header_.bytes());
    if (!header)
    {
        return refuse(fmt::format("has a header that {}", refusal_text(header.error())));
    }
    if (model_hash(header_.bytes()) != offer_.hash)
    {
        return refuse(
            fmt::format("has a header that {}", refusal_text(SpmRefusal::wrong_identity)));
    }
    if (header.value().fields().base_bytes != offer_.base_bytes)
    {
        return refuse(fmt::format("is announced with a base mesh of {} bytes, but its header names "
                                  "one of {}",
                                  offer_.base_bytes, header.value().fields().base_bytes));
    }
    return state_ = State::done;
}

} // namespace tactus::dds
