// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/dds_link.hpp"

#include "transport/content_hash.hpp"
#include "transport/dds/piece_frame.hpp"
#include "transport/dds/take.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// A sign of life and the credit, also when there is nothing to ask for.
constexpr auto kRenewal = std::chrono::milliseconds(200);
/// Nothing came for this long though something was asked for: the credit is written off.
constexpr auto kWriteOff = std::chrono::milliseconds(400);
/// Samples taken in one poll; the rest waits in the reader for the next one.
constexpr std::size_t kPiecesPerPoll = 256;

} // namespace

Result<std::unique_ptr<DdsLink>, Refusal>
DdsLink::create(const Domain& domain, Catalogue& catalogue, const Catalogue::Offer& offer,
                const std::string& controller_name, Log log)
{
    std::unique_ptr<DdsLink> link(new DdsLink(catalogue, offer, controller_name, std::move(log)));
    const std::string own = controller_partition(link->controller_, offer.hash);
    auto chunks = make_reader(domain, Topic::chunks, {&own, 1});
    if (!chunks)
    {
        return chunks.error();
    }
    auto wanted = WriterLanes::create(domain, Topic::wanted, model_partition(offer.hash));
    if (!wanted)
    {
        return wanted.error();
    }
    link->chunks_ = std::move(chunks).value();
    link->wanted_.emplace(std::move(wanted).value());
    return link;
}

DdsLink::DdsLink(Catalogue& catalogue, const Catalogue::Offer& offer, std::string controller_name,
                 Log log)
    : catalogue_(catalogue)
    , model_{offer.name, offer.hash}
    , revision_(offer.revision)
    , host_epoch_(offer.host_epoch)
    , controller_name_(std::move(controller_name))
    , log_(std::move(log))
    , controller_(random_controller())
{
}

void DdsLink::request(std::span<const ContentKey> keys, std::uint32_t generation)
{
    generation_ = generation;
    if (state_ == LinkState::host_gone || keys.empty())
    {
        return; // Asked again by the courier in the next session.
    }
    if (!awaits_pieces_)
    {
        awaits_pieces_ = true;
        last_progress_ = Clock::now();
    }
    while (!keys.empty())
    {
        const auto part = keys.first(std::min<std::size_t>(keys.size(), kMaxWishes));
        send(part);
        keys = keys.subspan(part.size());
    }
}

void DdsLink::poll(PieceSink& sink)
{
    catalogue_.refresh();
    follow_host();
    take_pieces(sink);
    keep_credit();
}

bool DdsLink::is_ready() const
{
    return wanted_->is_matched() && has_publisher(chunks_);
}

void DdsLink::follow_host()
{
    const Catalogue::Offer* same_host = catalogue_.find(*model_.hash, host_epoch_);
    const bool was_connected = state_ == LinkState::connected;
    if (same_host != nullptr && was_connected)
    {
        return;
    }
    if (const Catalogue::Offer* offer = same_host != nullptr ? same_host : catalogue_.find(model_);
        offer != nullptr)
    {
        adopt(*offer);
        return;
    }
    if (was_connected)
    {
        state_ = LinkState::host_gone;
        log_.write(
            fmt::format("host of model '{}' is gone; going on with what is resident", model_.name));
    }
    const Catalogue::Offer* changed = catalogue_.find(ModelSelector{model_.name, std::nullopt});
    if (changed != nullptr && changed->hash != refused_hash_)
    {
        refused_hash_ = changed->hash;
        log_.write(fmt::format("model '{}' is now published with another hash, {}; what is "
                               "resident is kept",
                               model_.name, hash_text(changed->hash)));
    }
}

void DdsLink::adopt(const Catalogue::Offer& offer)
{
    const bool is_restarted = offer.host_epoch != host_epoch_;
    if (is_restarted)
    {
        host_epoch_ = offer.host_epoch;
        credit_.restart();
    }
    state_ = LinkState::connected;
    ++session_;
    awaits_pieces_ = false;
    last_sent_ = {}; // Present ourselves at once.
    log_.write(fmt::format("model '{}' is served again{}", model_.name,
                           is_restarted ? ", by another host or a restarted one with the same file"
                                        : " by the same host"));
}

void DdsLink::take_pieces(PieceSink& sink)
{
    take_each<tactus_v1_Pieces>(chunks_.handle, kPiecesPerPoll,
                                [&](const tactus_v1_Pieces& sample, const dds_sample_info_t& info)
                                {
                                    if (!info.valid_data || sample.host_epoch != host_epoch_)
                                    {
                                        return;
                                    }
                                    const std::span payload(sample.payload._buffer,
                                                            sample.payload._length);
                                    take_sample(std::as_bytes(payload), sample.sent, sink);
                                });
}

void DdsLink::take_sample(std::span<const std::byte> payload, std::uint64_t sent, PieceSink& sink)
{
    bytes_received_ += payload.size();
    std::uint64_t pieces = 0;
    PieceReader reader(payload);
    for (auto piece = reader.next(); piece; piece = reader.next())
    {
        ++pieces;
        const bool is_of_model = piece->key.model == *model_.hash &&
                                 piece->key.revision == revision_ &&
                                 piece->key.kind <= static_cast<std::uint32_t>(ContentKind::chunk);
        if (!is_of_model)
        {
            break;
        }
        sink.receive({static_cast<ContentKind>(piece->key.kind), piece->key.number}, piece->bytes);
    }
    credit_.on_sample(sent, pieces);
    awaits_pieces_ = false;
    last_progress_ = Clock::now();
}

void DdsLink::keep_credit()
{
    if (state_ == LinkState::host_gone)
    {
        return;
    }
    const auto now = Clock::now();
    if (awaits_pieces_ && now - last_progress_ >= kWriteOff)
    {
        credit_.write_off();
        last_progress_ = now;
    }
    const bool is_half_used = credit_.granted() >= granted_sent_ + kCreditPieces / 2;
    if (is_half_used || now - last_sent_ >= kRenewal)
    {
        send({});
    }
}

void DdsLink::send(std::span<const ContentKey> keys)
{
    std::array<tactus_v1_PieceName, kMaxWishes> names{};
    TACTUS_ASSERT(keys.size() <= names.size());
    std::transform(keys.begin(), keys.end(), names.begin(),
                   [](ContentKey key) {
                       return tactus_v1_PieceName{static_cast<std::uint32_t>(key.kind), key.number};
                   });
    tactus_v1_Wanted wanted = {};
    std::memcpy(wanted.controller, controller_.data(), controller_.size());
    std::memcpy(wanted.model_hash, model_.hash->data(), model_.hash->size());
    wanted.protocol_version = kProtocolVersion;
    wanted.host_epoch = host_epoch_;
    wanted.revision = revision_;
    controller_name_.copy(static_cast<char*>(wanted.controller_name), kMaxNameBytes);
    wanted.generation = generation_;
    wanted.seen = credit_.seen();
    wanted.granted = credit_.granted();
    wanted.received = credit_.received();
    const auto count = static_cast<std::uint32_t>(keys.size());
    wanted.pieces = {count, count, names.data(), false};
    last_sent_ = Clock::now();
    // A write that fails is a lost request: the courier asks again.
    tactus_v1_Wanted probe = wanted;
    probe.pieces = {};
    if (wanted_->write(&wanted, &probe))
    {
        granted_sent_ = wanted.granted;
    }
}

} // namespace tactus::dds
