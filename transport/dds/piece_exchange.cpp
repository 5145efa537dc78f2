// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/piece_exchange.hpp"

#include "transport/dds/piece_frame.hpp"
#include "transport/dds/take.hpp"

#include <array>
#include <cstring>
#include <utility>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// Longest interval of samples to a server, with or without requests.
constexpr auto kRenewal = std::chrono::milliseconds(200);
/// Time without pieces after a request, after which the credit is written off.
constexpr auto kWriteOff = std::chrono::milliseconds(400);
/// Maximum number of samples taken in one step; further ones wait in the reader.
constexpr std::size_t kPiecesPerStep = 256;
/// Number of servers above which those that are gone are removed. Until then their credit is kept
/// for servers that return.
constexpr std::size_t kServersKept = 64;

} // namespace

Result<std::unique_ptr<PieceExchange>, Refusal>
PieceExchange::create(const Domain& domain, Catalogue& catalogue, std::string controller_name)
{
    std::unique_ptr<PieceExchange> exchange(
        new PieceExchange(domain, catalogue, std::move(controller_name)));
    const std::string& name = exchange->controller_name_;
    auto chunks =
        make_reader(domain, Topic::chunks, controller_partition(name, exchange->controller_));
    if (!chunks)
    {
        return chunks.error();
    }
    auto wanted = WriterLanes::create(domain, Topic::wanted, name);
    if (!wanted)
    {
        return wanted.error();
    }
    exchange->chunks_ = std::move(chunks).value();
    exchange->wanted_ = std::make_unique<WriterLanes>(std::move(wanted).value());
    return exchange;
}

PieceExchange::PieceExchange(const Domain& domain, Catalogue& catalogue,
                             std::string controller_name)
    : domain_(domain)
    , catalogue_(catalogue)
    , controller_name_(std::move(controller_name))
    , controller_(domain.participants().own())
{
}

void PieceExchange::ask(std::uint64_t server_epoch, std::uint32_t model,
                        std::span<const ContentKey> keys, std::uint32_t generation)
{
    Server& server = server_of(server_epoch);
    server.generation = generation;
    for (const ContentKey key : keys)
    {
        server.requests.push_back({model, key});
    }
}

void PieceExchange::ask_for_objects(std::uint64_t server_epoch)
{
    Server& server = server_of(server_epoch);
    if (server.objects == Objects::not_wanted)
    {
        server.objects = Objects::waits;
        server.last_sent = {}; // 0: send in the next step.
    }
}

bool PieceExchange::is_admitted(std::uint64_t server_epoch) const
{
    const auto server = std::ranges::find(servers_, server_epoch, &Server::epoch);
    return server != servers_.end() && server->is_admitted;
}

void PieceExchange::report_objects_received(std::uint64_t server_epoch, bool hears_motion)
{
    Server& server = server_of(server_epoch);
    const Objects objects = hears_motion ? Objects::are_here : Objects::hear_no_motion;
    if (server.objects != objects)
    {
        server.objects = objects;
        server.last_sent = {};
    }
}

void PieceExchange::leave_objects(std::uint64_t server_epoch)
{
    Server& server = server_of(server_epoch);
    server.objects = Objects::not_wanted;
    server.is_admitted = false;
}

void PieceExchange::step()
{
    ++steps_;
    catalogue_.refresh();
    watch_handshakes();
    if (catalogue_.version() != seen_catalogue_)
    {
        seen_catalogue_ = catalogue_.version();
        forget_servers();
    }
    take_pieces();
    for (Server& server : servers_)
    {
        if (catalogue_.has_server(server.epoch))
        {
            keep_credit(server);
        }
        else
        {
            // The receivers request them again, from any server of the model.
            server.requests.clear();
            server.awaits_pieces = false;
        }
    }
}

PieceExchange::Server* PieceExchange::find(std::uint64_t epoch)
{
    const auto server = std::ranges::find(servers_, epoch, &Server::epoch);
    return server == servers_.end() ? nullptr : &*server;
}

PieceExchange::Server& PieceExchange::server_of(std::uint64_t epoch)
{
    if (Server* server = find(epoch); server != nullptr)
    {
        return *server;
    }
    servers_.emplace_back().epoch = epoch;
    return servers_.back();
}

/// Restarts handshakes that never end, while no server is connected: a silence would end the other
/// connections too.
void PieceExchange::watch_handshakes()
{
    constexpr std::chrono::milliseconds kInterval(500);
    const auto now = Clock::now();
    const Participants& participants = catalogue_.participants();
    if (now < next_watch_ || participants.certificate_of(participants.own()).empty())
    {
        return;
    }
    next_watch_ = now + kInterval;
    const auto servers = catalogue_.servers_of({});
    for (const Catalogue::Offer* offer : servers)
    {
        certificates_.insert(participants.certificate_of(offer->server));
    }
    const bool is_discovered = servers.empty() && participants.has_any_of(certificates_);
    if (const auto silence = handshakes_.step(now, !servers.empty(), is_discovered))
    {
        domain_.be_silent(*silence);
    }
}

void PieceExchange::forget_servers()
{
    std::size_t too_many = servers_.size() - std::min(servers_.size(), kServersKept);
    std::erase_if(servers_,
                  [&](const Server& server)
                  {
                      const bool goes = too_many > 0 && !catalogue_.has_server(server.epoch);
                      too_many -= goes ? 1 : 0;
                      return goes;
                  });
}

void PieceExchange::take_pieces()
{
    take_each<tactus_v5_Pieces>(
        chunks_.handle, kPiecesPerStep,
        [&](const tactus_v5_Pieces& sample, const dds_sample_info_t& info)
        {
            Server* server = info.valid_data ? find(sample.server_epoch) : nullptr;
            if (server == nullptr)
            {
                return;
            }
            server->is_admitted = server->is_admitted || sample.lets_in;
            if (!sample.lets_in)
            {
                const std::span payload(sample.payload._buffer, sample.payload._length);
                hand_over(std::as_bytes(payload), *server, sample.sent);
            }
        });
}

void PieceExchange::hand_over(std::span<const std::byte> payload, Server& server,
                              std::uint64_t sent)
{
    std::uint64_t pieces = 0;
    PieceReader reader(payload);
    for (auto piece = reader.next(); piece; piece = reader.next())
    {
        ++pieces;
        if (piece->key.kind > static_cast<std::uint32_t>(ContentKind::header))
        {
            break;
        }
        const ContentKey key{static_cast<ContentKind>(piece->key.kind), piece->key.number};
        for (PieceReceiver* receiver : receivers_)
        {
            if (receiver->model() == piece->key.model)
            {
                receiver->receive(server.epoch, key, piece->bytes);
            }
        }
    }
    server.credit.on_sample(sent, pieces);
    server.awaits_pieces = false;
    server.write_offs = 0;
    server.last_progress = Clock::now();
}

void PieceExchange::keep_credit(Server& server)
{
    const auto now = Clock::now();
    if (server.awaits_pieces && now - server.last_progress >= kWriteOff)
    {
        server.credit.write_off();
        server.last_progress = now;
        if (++server.write_offs > 1) // A forged packet may make the server ignore the writers.
        {
            if (auto old = wanted_->try_renew(now))
            {
                old_wanted_ = std::move(old);
            }
        }
    }
    const bool is_half_used = server.credit.granted() >= server.granted_sent + kCreditPieces / 2;
    if (!server.requests.empty() || is_half_used || now - server.last_sent >= kRenewal)
    {
        send(server);
    }
}

/// Sends the queued requests and the credit, and empties the queue even if the write fails:
/// receivers repeat lost requests.
void PieceExchange::send(Server& server)
{
    const auto now = Clock::now();
    if (!server.requests.empty() && !server.awaits_pieces)
    {
        server.awaits_pieces = true;
        server.last_progress = now;
    }
    tactus_v5_Wanted wanted = {};
    std::memcpy(wanted.controller, controller_.data(), controller_.size());
    wanted.server_epoch = server.epoch;
    controller_name_.copy(static_cast<char*>(wanted.controller_name), kMaxNameBytes);
    wanted.generation = server.generation;
    wanted.objects = static_cast<std::uint8_t>(server.objects);
    wanted.seen = server.credit.seen();
    wanted.granted = server.credit.granted();
    wanted.received = server.credit.received();
    const tactus_v5_Wanted probe = wanted;
    std::span<const ServerPiece> requests(server.requests);
    do
    {
        std::array<tactus_v5_PieceName, kMaxRequests> names{};
        const auto part = requests.first(std::min<std::size_t>(requests.size(), kMaxRequests));
        std::ranges::transform(part, names.begin(),
                               [](const ServerPiece& piece)
                               {
                                   return tactus_v5_PieceName{
                                       static_cast<std::uint16_t>(piece.model),
                                       static_cast<std::uint8_t>(piece.key.kind), piece.key.number};
                               });
        const auto count = static_cast<std::uint32_t>(part.size());
        wanted.pieces = {count, count, names.data(), false};
        if (wanted_->write(&wanted, &probe))
        {
            server.granted_sent = wanted.granted;
        }
        requests = requests.subspan(part.size());
    } while (!requests.empty());
    server.requests.clear();
    server.last_sent = now;
}

} // namespace tactus::dds
