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

/// Maximum number of parts in one request, 1.8 MB.
constexpr std::size_t kPartsAtOnce = 64;
/// Time after which missing parts are requested again.
constexpr auto kAgain = std::chrono::milliseconds(100);
/// Time after the first wrong header during which another server may appear.
constexpr auto kAnother = std::chrono::seconds(1);
/// Maximum number of remembered servers that sent wrong headers.
constexpr std::size_t kMaxRefused = 256;

} // namespace

HeaderFetch::HeaderFetch(PieceExchange& exchange, const Catalogue& catalogue,
                         const Catalogue::Offer& offer)
    : exchange_(exchange)
    , catalogue_(catalogue)
    , offer_(offer)
    , header_(ContentKind::header, std::min<std::size_t>(offer.header_bytes, kMaxHeaderBytes))
    , progress_(Clock::now())
{
    exchange.add(*this);
    if (offer.header_bytes == 0 || offer.header_bytes > kMaxHeaderBytes || offer.base_bytes == 0 ||
        offer.base_bytes > kMaxBaseBytes)
    {
        refuse(fmt::format("is announced with a header of {} bytes and a base mesh of {}; at most "
                           "{} and {} are allowed",
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
        request_missing();
    }
    return now - progress_ < kSilence ? State::under_way : State::silent;
}

void HeaderFetch::receive(std::uint64_t server_epoch, ContentKey key,
                          std::span<const std::byte> bytes)
{
    if (server_epoch == offer_.server_epoch && header_.receive(key, bytes))
    {
        open_ -= open_ > 0 ? 1 : 0;
        progress_ = Clock::now();
    }
}

/// Requests missing parts while the server is present.
void HeaderFetch::request_missing()
{
    if (!catalogue_.has_server(offer_.server_epoch))
    {
        return;
    }
    std::vector<ContentKey> keys;
    header_.list_missing(keys, kPartsAtOnce);
    open_ = keys.size();
    exchange_.ask(offer_.server_epoch, offer_.model, keys, 0);
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
        return refuse(
            fmt::format("is announced with a base mesh of {} bytes, but its header states {}",
                        offer_.base_bytes, header.value().fields().base_bytes));
    }
    return state_ = State::done;
}

HeaderSearch::HeaderSearch(PieceExchange& exchange, Catalogue& catalogue, ModelSelector selector)
    : exchange_(exchange), catalogue_(catalogue), selector_(std::move(selector))
{
    catalogue.ask_for(selector_);
}

HeaderSearch::State HeaderSearch::step()
{
    bool is_silent = true; // False if any fetch is not silent.
    for (std::size_t i = 0; i < fetches_.size();)
    {
        HeaderFetch& fetch = *fetches_[i];
        const HeaderFetch::State state = fetch.step();
        if (state == HeaderFetch::State::done)
        {
            offer_ = fetch.offer();
            std::swap(fetches_.front(), fetches_[i]);
            fetches_.resize(1);
            return State::done;
        }
        if (state == HeaderFetch::State::refused)
        {
            objection_ = fetch.objection();
            refuse(fetch.offer());
            continue;
        }
        is_silent = is_silent && state == HeaderFetch::State::silent;
        ++i;
    }
    const auto now = Clock::now();
    const bool is_first = fetches_.empty() && refused_.empty();
    const bool has_news =
        std::exchange(seen_catalogue_, catalogue_.version()) != catalogue_.version();
    if (is_silent && (has_news || now - looked_ >= kAgain))
    {
        look_for_servers(is_first ? 1 : kServersAtOnce);
    }
    const bool is_over = !refused_.empty() && now - refused_since_ >= kAnother;
    return !fetches_.empty() ? State::under_way : is_over ? State::refused : State::not_published;
}

void HeaderSearch::refuse(const Catalogue::Offer& offer)
{
    refused_since_ = refused_.empty() ? Clock::now() : refused_since_;
    offer_ = offer;
    if (refused_.size() < kMaxRefused)
    {
        refused_.push_back(offer.server_epoch);
    }
    std::erase_if(fetches_, [server = offer.server_epoch](const auto& fetch)
                  { return fetch->offer().server_epoch == server; });
}

/// Starts fetches from up to `most` servers that are not being asked. If there are then more than
/// `most` fetches, the oldest end.
void HeaderSearch::look_for_servers(std::size_t most)
{
    looked_ = Clock::now();
    std::erase_if(fetches_, [this](const auto& fetch)
                  { return !catalogue_.has_server(fetch->offer().server_epoch); });
    std::vector<const Catalogue::Offer*> others = catalogue_.servers_of(selector_);
    std::erase_if(others,
                  [this](const Catalogue::Offer* offer)
                  {
                      const auto is_it = [offer](const auto& fetch)
                      { return fetch->offer().server_epoch == offer->server_epoch; };
                      return std::ranges::find(refused_, offer->server_epoch) != refused_.end() ||
                             std::ranges::any_of(fetches_, is_it);
                  });
    // Servers are asked in turn: those after the last one asked first.
    const auto after = std::ranges::find_if(others, [this](const Catalogue::Offer* offer)
                                            { return offer->arrival > last_arrival_; });
    std::rotate(others.begin(), after, others.end());
    others.resize(std::min(others.size(), most));
    const std::size_t too_many =
        fetches_.size() + others.size() - std::min(fetches_.size() + others.size(), most);
    fetches_.erase(fetches_.begin(), fetches_.begin() + static_cast<std::ptrdiff_t>(too_many));
    for (const Catalogue::Offer* offer : others)
    {
        fetches_.push_back(std::make_unique<HeaderFetch>(exchange_, catalogue_, *offer));
        offer_ = *offer;
        last_arrival_ = offer->arrival;
    }
}

} // namespace tactus::dds
