// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/dds_link.hpp"

#include "transport/content_hash.hpp"
#include "transport/dds/piece_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tactus::dds
{

namespace
{

/// Interval of the check for missing pieces.
constexpr auto kLookEvery = std::chrono::milliseconds(20);
/// Time after which a piece that is not requested again is no longer wanted.
constexpr auto kForgotten = std::chrono::seconds(2);
/// Time in which another server may appear after all present ones sent wrong bytes.
constexpr auto kAnotherAfter = std::chrono::seconds(1);
/// Maximum number of remembered servers: wrong ones, replaced ones and senders.
constexpr std::size_t kMaxRemembered = 256;

} // namespace

DdsLink::DdsLink(PieceExchange& exchange, Catalogue& catalogue, const Catalogue::Offer& offer,
                 Log log)
    : exchange_(exchange), catalogue_(catalogue), offer_(offer), log_(std::move(log))
{
    exchange.add(*this);
    exchange.meet(offer.host_epoch);
}

void DdsLink::request(std::span<const ContentKey> keys, std::uint32_t generation)
{
    if (state_ != LinkState::connected)
    {
        return; // The ChunkLoader repeats the request in the next session.
    }
    const auto now = Clock::now();
    for (const ContentKey key : keys)
    {
        const auto [asked, is_new] =
            asked_.try_emplace({key.kind, key.number}, Asked{now, now, now, generation});
        asked->second.last = now;
        asked->second.generation = generation;
    }
    exchange_.ask(offer_.host_epoch, offer_.model, keys, generation);
}

bool DdsLink::distrust(ContentKey key)
{
    const auto now = Clock::now();
    distrusted_since_ = distrusted_.empty() ? now : distrusted_since_;
    if (key.kind == ContentKind::base)
    {
        // If several servers sent parts, none is blamed: the next attempt takes all parts from one.
        if (base_from_.size() == 1)
        {
            distrust_host(*base_from_.begin());
        }
        base_from_.clear();
        std::erase_if(asked_,
                      [](const auto& entry) { return entry.first.first == ContentKind::base; });
        return is_trusted(offer_.host_epoch) || now - distrusted_since_ < kAnotherAfter;
    }
    distrust_host(handed_over_from_);
    const auto at = asked_.find({key.kind, key.number});
    if (at != asked_.end() && at->second.has_come)
    {
        at->second = {now, at->second.last, now, at->second.generation};
        if (is_trusted(offer_.host_epoch)) // Otherwise the next request asks again.
        {
            exchange_.ask(offer_.host_epoch, offer_.model, {&key, 1}, at->second.generation);
        }
    }
    return true;
}

void DdsLink::distrust_host(std::uint64_t host)
{
    if (is_trusted(host) && distrusted_.size() < kMaxRemembered)
    {
        distrusted_.push_back(host);
    }
    if (host == offer_.host_epoch)
    {
        const auto hosts = others();
        const auto next = std::ranges::find_if(hosts, [this](const Catalogue::Offer* offer)
                                               { return is_trusted(offer->host_epoch); });
        if (next != hosts.end())
        {
            put_first(**next);
        }
    }
}

bool DdsLink::is_trusted(std::uint64_t host) const
{
    return std::ranges::find(distrusted_, host) == distrusted_.end();
}

/// Other servers with the model, in rotation from the one after the last that was asked; only
/// trusted ones if any server is trusted.
std::vector<const Catalogue::Offer*> DdsLink::others() const
{
    auto hosts = catalogue_.servers_of({.name = "", .hash = offer_.hash});
    std::erase_if(hosts, [this](const Catalogue::Offer* offer)
                  { return offer->host_epoch == offer_.host_epoch; });
    const auto trusts = [this](const Catalogue::Offer* offer)
    { return is_trusted(offer->host_epoch); };
    if (std::ranges::any_of(hosts, trusts) || is_trusted(offer_.host_epoch))
    {
        std::erase_if(hosts, [&](const Catalogue::Offer* offer) { return !trusts(offer); });
    }
    const auto after = std::ranges::find_if(hosts, [this](const Catalogue::Offer* offer)
                                            { return offer->arrival > last_arrival_; });
    std::rotate(hosts.begin(), after, hosts.end());
    return hosts;
}

/// Number of a server; those beyond the limit share the last number.
std::uint32_t DdsLink::number_of(std::uint64_t host)
{
    const auto at = std::ranges::find(senders_, host);
    if (at == senders_.end() && senders_.size() < kMaxRemembered)
    {
        senders_.push_back(host);
        return static_cast<std::uint32_t>(senders_.size() - 1);
    }
    return static_cast<std::uint32_t>(
        std::min<std::ptrdiff_t>(at - senders_.begin(), kMaxRemembered - 1));
}

void DdsLink::poll(PieceSink& sink)
{
    // No other link has stepped the exchange since the last poll.
    if (exchange_.steps() == seen_steps_)
    {
        exchange_.step();
    }
    seen_steps_ = exchange_.steps();
    if (catalogue_.version() != seen_catalogue_)
    {
        seen_catalogue_ = catalogue_.version();
        follow_host();
    }
    if (state_ == LinkState::connected && Clock::now() - looked_ >= kLookEvery)
    {
        ask_others();
    }
    PieceReader reader(arrived_);
    for (auto piece = reader.next(); piece; piece = reader.next())
    {
        const ContentKey key{static_cast<ContentKind>(piece->key.kind), piece->key.number};
        handed_over_from_ = senders_[piece->key.revision];
        sink.receive(key, piece->bytes);
        const auto asked = asked_.find({key.kind, key.number});
        if (asked != asked_.end() && asked->second.has_come) // The sink did not distrust it.
        {
            asked_.erase(asked);
        }
    }
    arrived_.clear();
}

/// Requests from other servers the pieces that have not arrived within kSilence.
void DdsLink::ask_others()
{
    const auto now = Clock::now();
    looked_ = now;
    std::erase_if(asked_, [&](const auto& entry) { return now - entry.second.last >= kForgotten; });
    std::vector<ContentKey> keys;
    std::uint32_t generation = 0;
    for (auto& [id, asked] : asked_)
    {
        if (!asked.has_come && now - asked.since >= kSilence)
        {
            asked.since = now;
            generation = asked.generation;
            keys.push_back({id.first, id.second});
        }
    }
    if (keys.empty())
    {
        return;
    }
    auto hosts = others();
    hosts.resize(std::min(hosts.size(), kHostsAtOnce));
    for (const Catalogue::Offer* offer : hosts)
    {
        exchange_.ask(offer->host_epoch, offer->model, keys, generation);
        last_arrival_ = offer->arrival;
    }
}

/// Stores a piece until the next poll. Parts of a base mesh are verified together, so they are
/// taken only from the server that is asked first.
void DdsLink::receive(std::uint64_t host_epoch, ContentKey key, std::span<const std::byte> bytes)
{
    if (key.kind == ContentKind::header)
    {
        return;
    }
    const auto at = asked_.find({key.kind, key.number});
    if (host_epoch == offer_.host_epoch)
    {
        first_heard_ = Clock::now();
    }
    else if (at != asked_.end() && first_heard_ < at->second.first && is_trusted(host_epoch))
    {
        if (const Catalogue::Offer* offer = catalogue_.find(offer_.hash, host_epoch))
        {
            put_first(*offer);
        }
    }
    if (key.kind == ContentKind::base)
    {
        if (host_epoch != offer_.host_epoch)
        {
            return;
        }
        base_from_.insert(host_epoch);
    }
    if (at != asked_.end())
    {
        at->second.has_come = true;
    }
    append_piece(
        arrived_,
        {offer_.hash, number_of(host_epoch), static_cast<std::uint32_t>(key.kind), key.number},
        bytes);
    bytes_received_ += kFrameBytes + bytes.size();
}

/// Replaces a server that does not answer or sent wrong bytes.
void DdsLink::put_first(const Catalogue::Offer& offer)
{
    if (told_.size() < kMaxRemembered && told_.insert(offer_.host_epoch).second)
    {
        const Participants& participants = catalogue_.participants();
        log_.write(
            fmt::format("model '{}': {} {}; its pieces come from {} now", offer_.name,
                        participants.name_of(offer_.host),
                        is_trusted(offer_.host_epoch) ? "doesn't answer" : "sends what is wrong",
                        participants.name_of(offer.host)));
    }
    take_over(offer);
    first_heard_ = Clock::now();
}

/// Changes the server; the model keeps its name even if that server publishes another one.
void DdsLink::take_over(const Catalogue::Offer& offer)
{
    const std::string name = offer_.name;
    offer_ = offer;
    offer_.name = name;
    exchange_.meet(offer.host_epoch);
}

void DdsLink::follow_host()
{
    const Catalogue::Offer* same_host = catalogue_.find(offer_.hash, offer_.host_epoch);
    const bool was_connected = state_ == LinkState::connected;
    if (same_host != nullptr && was_connected)
    {
        return;
    }
    const Catalogue::Offer* offer = same_host;
    if (const auto hosts = others(); same_host == nullptr && !hosts.empty())
    {
        offer = hosts.front();
    }
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
    const Catalogue::Offer* changed = catalogue_.find({offer_.name});
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
    take_over(offer);
    state_ = LinkState::connected;
    ++session_;
    log_.write(fmt::format("model '{}' is served again{}", offer_.name,
                           is_restarted ? ", by another host or a restarted one with the same file"
                                        : " by the same host"));
}

} // namespace tactus::dds
