// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/catalogue.hpp"

#include "transport/dds/take.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// Offers that a controller remembers; a domain with more shows the first ones.
constexpr std::size_t kMaxOffers = 4'096;
constexpr std::size_t kMaxNamesShown = 20;

ContentHash hash_from(const std::uint8_t (&bytes)[16]) // NOLINT: idlc's type.
{
    ContentHash hash{};
    std::memcpy(hash.data(), bytes, hash.size());
    return hash;
}

} // namespace

Result<Catalogue, Refusal> Catalogue::create(const Domain& domain, Log log)
{
    const std::string everywhere;
    auto reader = make_reader(domain, Topic::catalogue, {&everywhere, 1});
    if (!reader)
    {
        return reader.error();
    }
    return Catalogue(std::move(reader).value(), std::move(log));
}

Catalogue::Catalogue(Endpoint reader, Log log) : reader_(std::move(reader)), log_(std::move(log)) {}

void Catalogue::refresh()
{
    take_each<tactus_v1_CatalogueEntry>(
        reader_.handle, kMaxOffers,
        [this](const tactus_v1_CatalogueEntry& entry, const dds_sample_info_t& info)
        {
            const std::string name(entry.name, ::strnlen(entry.name, sizeof(entry.name)));
            if (info.instance_state != DDS_ALIVE_INSTANCE_STATE)
            {
                remove(name, entry.host_epoch);
            }
            else if (info.valid_data && is_valid_name(name))
            {
                add({name, hash_from(entry.model_hash), entry.host_epoch, entry.revision,
                     entry.protocol_version, entry.faces});
            }
        });
}

const Catalogue::Offer* Catalogue::find(const ModelSelector& selector) const
{
    const auto at = std::find_if(offers_.begin(), offers_.end(),
                                 [&](const Offer& offer)
                                 {
                                     return offer.name == selector.name &&
                                            (!selector.hash || offer.hash == *selector.hash) &&
                                            offer.protocol_version == kProtocolVersion;
                                 });
    return at == offers_.end() ? nullptr : &*at;
}

const Catalogue::Offer* Catalogue::find(const ContentHash& hash, std::uint64_t host_epoch) const
{
    const auto at = std::find_if(offers_.begin(), offers_.end(),
                                 [&](const Offer& offer)
                                 { return offer.hash == hash && offer.host_epoch == host_epoch; });
    return at == offers_.end() ? nullptr : &*at;
}

std::string Catalogue::names() const
{
    std::string text;
    for (std::size_t i = 0; i < offers_.size() && i < kMaxNamesShown; ++i)
    {
        text += (i > 0 ? ", " : "") + offers_[i].name;
    }
    if (offers_.size() > kMaxNamesShown)
    {
        text += fmt::format(" and {} more", offers_.size() - kMaxNamesShown);
    }
    return offers_.empty() ? "none" : text;
}

void Catalogue::add(const Offer& offer)
{
    const bool is_known = std::any_of(offers_.begin(), offers_.end(),
                                      [&](const Offer& known)
                                      {
                                          return known.name == offer.name &&
                                                 known.host_epoch == offer.host_epoch &&
                                                 known.hash == offer.hash;
                                      });
    if (is_known)
    {
        return; // Written anew every second.
    }
    remove(offer.name, offer.host_epoch);
    if (offers_.size() == kMaxOffers)
    {
        return;
    }
    if (offer.protocol_version != kProtocolVersion)
    {
        log_.write(fmt::format("model '{}' is published with protocol version {}; this build "
                               "speaks {}",
                               offer.name, offer.protocol_version, kProtocolVersion));
    }
    const Offer* first = find(ModelSelector{offer.name, std::nullopt});
    if (first != nullptr && first->hash != offer.hash)
    {
        log_.write(fmt::format("warning: model '{}' is published with two hashes, {} (seen first, "
                               "used unless pinned by NAME@HASH) and {}",
                               offer.name, hash_text(first->hash), hash_text(offer.hash)));
    }
    offers_.push_back(offer);
}

void Catalogue::remove(const std::string& name, std::uint64_t host_epoch)
{
    std::erase_if(offers_, [&](const Offer& offer)
                  { return offer.name == name && offer.host_epoch == host_epoch; });
}

} // namespace tactus::dds
