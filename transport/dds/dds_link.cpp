// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/dds_link.hpp"

#include "transport/content_hash.hpp"
#include "transport/dds/piece_frame.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::dds
{

namespace
{

/// Interval of ask_others().
constexpr auto kLookEvery = std::chrono::milliseconds(20);
/// Time after the last request() for a piece after which the piece is no longer wanted.
constexpr auto kForgotten = std::chrono::seconds(2);
/// Time after the first wrong bytes during which another server may appear.
constexpr auto kAnotherAfter = std::chrono::seconds(1);
/// Maximum number of servers in each of `distrusted_`, `told_` and `senders_`.
constexpr std::size_t kMaxRemembered = 256;

} // namespace

DdsLink::DdsLink(PieceExchange& exchange, Catalogue& catalogue, const Catalogue::Offer& offer,
                 Log log)
    : exchange_(exchange), catalogue_(catalogue), offer_(offer), log_(std::move(log))
{
    exchange.add(*this);
    exchange.announce_to(offer.server_epoch);
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
    exchange_.ask(offer_.server_epoch, offer_.model, keys, generation);
}

bool DdsLink::distrust(ContentKey key)
{
    const auto now = Clock::now();
    distrusted_since_ = distrusted_.empty() ? now : distrusted_since_;
    if (key.kind == ContentKind::base)
    {
        // If several servers sent parts, the wrong one is unknown and none is distrusted.
        if (base_from_.size() == 1)
        {
            distrust_server(*base_from_.begin());
        }
        base_from_.clear();
        std::erase_if(asked_,
                      [](const auto& entry) { return entry.first.first == ContentKind::base; });
        return is_trusted(offer_.server_epoch) || now - distrusted_since_ < kAnotherAfter;
    }
    distrust_server(handed_over_from_);
    const auto at = asked_.find({key.kind, key.number});
    if (at != asked_.end() && at->second.has_come)
    {
        at->second = {now, at->second.last, now, at->second.generation};
        if (is_trusted(offer_.server_epoch)) // Otherwise the next request() does.
        {
            exchange_.ask(offer_.server_epoch, offer_.model, {&key, 1}, at->second.generation);
        }
    }
    return true;
}

void DdsLink::distrust_server(std::uint64_t server)
{
    if (is_trusted(server) && distrusted_.size() < kMaxRemembered)
    {
        distrusted_.push_back(server);
    }
    if (server == offer_.server_epoch)
    {
        const auto servers = others();
        const auto next = std::ranges::find_if(servers, [this](const Catalogue::Offer* offer)
                                               { return is_trusted(offer->server_epoch); });
        if (next != servers.end())
        {
            put_first(**next);
        }
    }
}

bool DdsLink::is_trusted(std::uint64_t server) const
{
    return std::ranges::find(distrusted_, server) == distrusted_.end();
}

/// Servers with the model except the first, starting after the last one asked. Distrusted servers
/// are included only if all servers, the first too, are distrusted.
std::vector<const Catalogue::Offer*> DdsLink::others() const
{
    auto servers = catalogue_.servers_of({.name = "", .hash = offer_.hash});
    std::erase_if(servers, [this](const Catalogue::Offer* offer)
                  { return offer->server_epoch == offer_.server_epoch; });
    const auto trusts = [this](const Catalogue::Offer* offer)
    { return is_trusted(offer->server_epoch); };
    if (std::ranges::any_of(servers, trusts) || is_trusted(offer_.server_epoch))
    {
        std::erase_if(servers, [&](const Catalogue::Offer* offer) { return !trusts(offer); });
    }
    const auto after = std::ranges::find_if(servers, [this](const Catalogue::Offer* offer)
                                            { return offer->arrival > last_arrival_; });
    std::rotate(servers.begin(), after, servers.end());
    return servers;
}

/// Index of a server in `senders_`; servers beyond kMaxRemembered share the last index.
std::uint32_t DdsLink::number_of(std::uint64_t server)
{
    const auto at = std::ranges::find(senders_, server);
    if (at == senders_.end() && senders_.size() < kMaxRemembered)
    {
        senders_.push_back(server);
        return static_cast<std::uint32_t>(senders_.size() - 1);
    }
    return static_cast<std::uint32_t>(
        std::min<std::ptrdiff_t>(at - senders_.begin(), kMaxRemembered - 1));
}

void DdsLink::poll(PieceSink& sink)
{
    // True if no other link has stepped the exchange since the last poll.
    if (exchange_.steps() == seen_steps_)
    {
        exchange_.step();
    }
    seen_steps_ = exchange_.steps();
    if (catalogue_.version() != seen_catalogue_)
    {
        seen_catalogue_ = catalogue_.version();
        follow_server();
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

/// Requests the pieces that have not arrived within kSilence from other servers.
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
    auto servers = others();
    servers.resize(std::min(servers.size(), kServersAtOnce));
    for (const Catalogue::Offer* offer : servers)
    {
        exchange_.ask(offer->server_epoch, offer->model, keys, generation);
        last_arrival_ = offer->arrival;
    }
}

/// Stores a piece for the next poll(). Parts of a base mesh are verified together, so only those of
/// the first server are stored.
void DdsLink::receive(std::uint64_t server_epoch, ContentKey key, std::span<const std::byte> bytes)
{
    if (key.kind == ContentKind::header)
    {
        return;
    }
    const auto at = asked_.find({key.kind, key.number});
    if (server_epoch == offer_.server_epoch)
    {
        first_heard_ = Clock::now();
    }
    else if (at != asked_.end() && first_heard_ < at->second.first && is_trusted(server_epoch))
    {
        if (const Catalogue::Offer* offer = catalogue_.find(offer_.hash, server_epoch))
        {
            put_first(*offer);
        }
    }
    if (key.kind == ContentKind::base)
    {
        if (server_epoch != offer_.server_epoch)
        {
            return;
        }
        base_from_.insert(server_epoch);
    }
    if (at != asked_.end())
    {
        at->second.has_come = true;
    }
    append_piece(
        arrived_,
        {offer_.hash, number_of(server_epoch), static_cast<std::uint32_t>(key.kind), key.number},
        bytes);
    bytes_received_ += kFrameBytes + bytes.size();
}

/// Makes another server the first, and logs the reason.
void DdsLink::put_first(const Catalogue::Offer& offer)
{
    if (told_.size() < kMaxRemembered && told_.insert(offer_.server_epoch).second)
    {
        const Participants& participants = catalogue_.participants();
        log_.write(
            fmt::format("model '{}': {} {}; pieces are now requested from {}", offer_.name,
                        participants.name_of(offer_.server),
                        is_trusted(offer_.server_epoch) ? "doesn't answer" : "sends wrong data",
                        participants.name_of(offer.server)));
    }
    take_over(offer);
    first_heard_ = Clock::now();
}

/// Changes the first server. The model keeps its name, even if the new server has another for it.
void DdsLink::take_over(const Catalogue::Offer& offer)
{
    const std::string name = offer_.name;
    offer_ = offer;
    offer_.name = name;
    exchange_.announce_to(offer.server_epoch);
}

void DdsLink::follow_server()
{
    const Catalogue::Offer* same_server = catalogue_.find(offer_.hash, offer_.server_epoch);
    const bool was_connected = state_ == LinkState::connected;
    if (same_server != nullptr && was_connected)
    {
        return;
    }
    const Catalogue::Offer* offer = same_server;
    if (const auto servers = others(); same_server == nullptr && !servers.empty())
    {
        offer = servers.front();
    }
    if (offer != nullptr)
    {
        adopt(*offer);
        return;
    }
    if (was_connected)
    {
        state_ = LinkState::server_gone;
        log_.write(fmt::format("server of model '{}' disconnected; the resident data stay in use",
                               offer_.name));
    }
    const Catalogue::Offer* changed = catalogue_.find({offer_.name});
    if (changed != nullptr && changed->hash != refused_hash_)
    {
        refused_hash_ = changed->hash;
        log_.write(fmt::format(
            "model '{}' is now published with another hash, {}; the resident data are kept",
            offer_.name, hash_text(changed->hash)));
    }
}

void DdsLink::adopt(const Catalogue::Offer& offer)
{
    const bool is_restarted = offer.server_epoch != offer_.server_epoch;
    take_over(offer);
    state_ = LinkState::connected;
    ++session_;
    log_.write(fmt::format("model '{}' is served again{}", offer_.name,
                           is_restarted
                               ? ", by another server or a restarted one with the same file"
                               : " by the same server"));
}

} // namespace tactus::dds
