// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/piece_exchange.hpp"

#include "transport/dds/piece_frame.hpp"
#include "transport/dds/take.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// Interval of the sign of life with the credit, even without requests.
constexpr auto kRenewal = std::chrono::milliseconds(200);
/// Silence after a request, after which the credit is written off.
constexpr auto kWriteOff = std::chrono::milliseconds(400);
/// Samples taken in one step; the rest waits in the reader for the next one.
constexpr std::size_t kPiecesPerStep = 256;
/// Servers that are gone but whose credit is kept: one that was thought dead continues its count.
constexpr std::size_t kHostsKept = 64;

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
    : catalogue_(catalogue)
    , controller_name_(std::move(controller_name))
    , controller_(domain.participants().own())
{
}

void PieceExchange::ask(std::uint64_t host_epoch, std::uint32_t model,
                        std::span<const ContentKey> keys, std::uint32_t generation)
{
    Host& host = host_of(host_epoch);
    host.generation = generation;
    for (const ContentKey key : keys)
    {
        host.requests.push_back({model, key});
    }
}

void PieceExchange::ask_for_objects(std::uint64_t host_epoch)
{
    Host& host = host_of(host_epoch);
    if (host.objects == Objects::not_wanted)
    {
        host.objects = Objects::waits;
        host.last_sent = {}; // Send at once.
    }
}

bool PieceExchange::is_let_in(std::uint64_t host_epoch) const
{
    const auto host = std::ranges::find(hosts_, host_epoch, &Host::epoch);
    return host != hosts_.end() && host->is_let_in;
}

void PieceExchange::tell_objects_are_here(std::uint64_t host_epoch, bool hears_motion)
{
    Host& host = host_of(host_epoch);
    const Objects objects = hears_motion ? Objects::are_here : Objects::hear_no_motion;
    if (host.objects != objects)
    {
        host.objects = objects;
        host.last_sent = {};
    }
}

void PieceExchange::leave_objects(std::uint64_t host_epoch)
{
    Host& host = host_of(host_epoch);
    host.objects = Objects::not_wanted;
    host.is_let_in = false;
}

void PieceExchange::step()
{
    ++steps_;
    catalogue_.refresh();
    if (catalogue_.version() != seen_catalogue_)
    {
        seen_catalogue_ = catalogue_.version();
        forget_hosts();
    }
    take_pieces();
    for (Host& host : hosts_)
    {
        if (catalogue_.has_host(host.epoch))
        {
            keep_credit(host);
        }
        else
        {
            host.requests.clear(); // The requester asks again, then any server of the model.
            host.awaits_pieces = false;
        }
    }
}

PieceExchange::Host* PieceExchange::find(std::uint64_t epoch)
{
    const auto host = std::ranges::find(hosts_, epoch, &Host::epoch);
    return host == hosts_.end() ? nullptr : &*host;
}

PieceExchange::Host& PieceExchange::host_of(std::uint64_t epoch)
{
    if (Host* host = find(epoch); host != nullptr)
    {
        return *host;
    }
    hosts_.emplace_back().epoch = epoch;
    return hosts_.back();
}

void PieceExchange::forget_hosts()
{
    std::size_t too_many = hosts_.size() - std::min(hosts_.size(), kHostsKept);
    std::erase_if(hosts_,
                  [&](const Host& host)
                  {
                      const bool goes = too_many > 0 && !catalogue_.has_host(host.epoch);
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
            Host* host = info.valid_data ? find(sample.host_epoch) : nullptr;
            if (host == nullptr)
            {
                return;
            }
            host->is_let_in = host->is_let_in || sample.lets_in;
            if (!sample.lets_in)
            {
                const std::span payload(sample.payload._buffer, sample.payload._length);
                hand_over(std::as_bytes(payload), *host, sample.sent);
            }
        });
}

void PieceExchange::hand_over(std::span<const std::byte> payload, Host& host, std::uint64_t sent)
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
                receiver->receive(host.epoch, key, piece->bytes);
            }
        }
    }
    host.credit.on_sample(sent, pieces);
    host.awaits_pieces = false;
    host.write_offs = 0;
    host.last_progress = Clock::now();
}

void PieceExchange::keep_credit(Host& host)
{
    const auto now = Clock::now();
    if (host.awaits_pieces && now - host.last_progress >= kWriteOff)
    {
        host.credit.write_off();
        host.last_progress = now;
        if (++host.write_offs > 1) // A forged packet may have made the server ignore our writers.
        {
            if (auto old = wanted_->try_renew(now))
            {
                old_wanted_ = std::move(old);
            }
        }
    }
    const bool is_half_used = host.credit.granted() >= host.granted_sent + kCreditPieces / 2;
    if (!host.requests.empty() || is_half_used || now - host.last_sent >= kRenewal)
    {
        send(host);
    }
}

/// Sends the requests, or a sign of life. They count as sent even if that fails: a lost request is
/// repeated.
void PieceExchange::send(Host& host)
{
    const auto now = Clock::now();
    if (!host.requests.empty() && !host.awaits_pieces)
    {
        host.awaits_pieces = true;
        host.last_progress = now;
    }
    tactus_v5_Wanted wanted = {};
    std::memcpy(wanted.controller, controller_.data(), controller_.size());
    wanted.host_epoch = host.epoch;
    controller_name_.copy(static_cast<char*>(wanted.controller_name), kMaxNameBytes);
    wanted.generation = host.generation;
    wanted.objects = static_cast<std::uint8_t>(host.objects);
    wanted.seen = host.credit.seen();
    wanted.granted = host.credit.granted();
    wanted.received = host.credit.received();
    const tactus_v5_Wanted probe = wanted;
    std::span<const HostPiece> requests(host.requests);
    do
    {
        std::array<tactus_v5_PieceName, kMaxRequests> names{};
        const auto part = requests.first(std::min<std::size_t>(requests.size(), kMaxRequests));
        std::ranges::transform(part, names.begin(),
                               [](const HostPiece& piece)
                               {
                                   return tactus_v5_PieceName{
                                       static_cast<std::uint16_t>(piece.model),
                                       static_cast<std::uint8_t>(piece.key.kind), piece.key.number};
                               });
        const auto count = static_cast<std::uint32_t>(part.size());
        wanted.pieces = {count, count, names.data(), false};
        if (wanted_->write(&wanted, &probe))
        {
            host.granted_sent = wanted.granted;
        }
        requests = requests.subspan(part.size());
    } while (!requests.empty());
    host.requests.clear();
    host.last_sent = now;
}

} // namespace tactus::dds
