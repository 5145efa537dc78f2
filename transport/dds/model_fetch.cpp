// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/model_fetch.hpp"

#include "transport/content_hash.hpp"
#include "transport/dds/model_pieces.hpp"
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

ModelFetch::ModelFetch(PieceExchange& exchange, const Catalogue& catalogue,
                       const Catalogue::Offer& offer)
    : exchange_(exchange)
    , catalogue_(catalogue)
    , offer_(offer)
    , header_(
          empty(ContentKind::header, std::min<std::size_t>(offer.header_bytes, kMaxHeaderBytes)))
    , base_(empty(ContentKind::base, std::min<std::size_t>(offer.base_bytes, kMaxBaseBytes)))
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

ModelFetch::Whole ModelFetch::empty(ContentKind kind, std::size_t bytes)
{
    const std::uint32_t parts = parts_of(bytes);
    return {kind, std::vector<std::byte>(bytes), std::vector<bool>(parts, false), parts};
}

ModelFetch::State ModelFetch::step()
{
    if (state_ != State::under_way)
    {
        return state_;
    }
    if (header_.missing + base_.missing == 0)
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

void ModelFetch::receive(ContentKey key, std::span<const std::byte> bytes)
{
    Whole& whole = key.kind == ContentKind::header ? header_ : base_;
    if (key.kind != whole.kind || key.number >= whole.is_here.size() || whole.is_here[key.number])
    {
        return;
    }
    const std::size_t begin = key.number * kPartBytes;
    if (bytes.size() != std::min(kPartBytes, whole.bytes.size() - begin))
    {
        return; // Not of a model of this size.
    }
    std::ranges::copy(bytes, whole.bytes.begin() + static_cast<std::ptrdiff_t>(begin));
    whole.is_here[key.number] = true;
    --whole.missing;
    open_ -= open_ > 0 ? 1 : 0;
}

/// Of the host that has the model now; without one nothing is asked.
void ModelFetch::ask()
{
    const Catalogue::Offer* offer = catalogue_.find(offer_.hash, offer_.host_epoch);
    offer = offer != nullptr ? offer : catalogue_.find({offer_.name, offer_.hash});
    if (offer == nullptr)
    {
        return;
    }
    offer_.host_epoch = offer->host_epoch;
    std::vector<ContentKey> keys;
    for (const Whole* whole : {&header_, &base_})
    {
        for (std::uint32_t i = 0; i < whole->is_here.size() && keys.size() < kPartsAtOnce; ++i)
        {
            if (!whole->is_here[i])
            {
                keys.push_back({whole->kind, i});
            }
        }
    }
    open_ = keys.size();
    exchange_.ask(offer->host_epoch, offer->model, keys, 0);
}

ModelFetch::State ModelFetch::refuse(std::string objection)
{
    objection_ = std::move(objection);
    return state_ = State::refused;
}

ModelFetch::State ModelFetch::check()
{
    const auto header = parse_trusted_header(header_.bytes);
    if (!header)
    {
        return refuse(fmt::format("has a header that {}", refusal_text(header.error())));
    }
    if (model_hash(header_.bytes) != offer_.hash)
    {
        return refuse(
            fmt::format("has a header that {}", refusal_text(SpmRefusal::wrong_identity)));
    }
    if (content_hash(base_.bytes) != header.value().fields().base_hash)
    {
        return refuse("has a base mesh of another hash than its header names");
    }
    return state_ = State::done;
}

} // namespace tactus::dds
