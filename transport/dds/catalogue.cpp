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
    auto reader = make_reader(domain, Topic::catalogue, "");
    if (!reader)
    {
        return reader.error();
    }
    return Catalogue(domain.participants(), std::move(reader).value(), std::move(log));
}

Catalogue::Catalogue(Participants& participants, Endpoint reader, Log log)
    : participants_(&participants), reader_(std::move(reader)), log_(std::move(log))
{
}

void Catalogue::refresh()
{
    participants_->report_other_versions(log_);
    take_each<tactus_v2_CatalogueEntry>(
        reader_.handle, kMaxOffers,
        [this](const tactus_v2_CatalogueEntry& entry, const dds_sample_info_t& info)
        {
            const std::string name(entry.name, ::strnlen(entry.name, sizeof(entry.name)));
            if (info.instance_state != DDS_ALIVE_INSTANCE_STATE)
            {
                remove(entry.model, entry.host_epoch);
            }
            else if (info.valid_data && is_valid_name(name))
            {
                add({name, hash_from(entry.model_hash), entry.host_epoch, entry.model, entry.faces,
                     entry.header_bytes, entry.base_bytes});
            }
        });
}

const Catalogue::Offer* Catalogue::find(const ModelSelector& selector) const
{
    const auto at = std::find_if(offers_.begin(), offers_.end(),
                                 [&](const Offer& offer) {
                                     return offer.name == selector.name &&
                                            (!selector.hash || offer.hash == *selector.hash);
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

bool Catalogue::has_host(std::uint64_t host_epoch) const
{
    return std::ranges::find(offers_, host_epoch, &Offer::host_epoch) != offers_.end();
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
    const bool is_known =
        std::any_of(offers_.begin(), offers_.end(),
                    [&](const Offer& known)
                    {
                        return known.name == offer.name && known.model == offer.model &&
                               known.host_epoch == offer.host_epoch && known.hash == offer.hash;
                    });
    if (is_known)
    {
        return; // Written anew every second.
    }
    remove(offer.model, offer.host_epoch);
    if (offers_.size() == kMaxOffers)
    {
        return;
    }
    const Offer* first = find(ModelSelector{offer.name, std::nullopt});
    if (first != nullptr && first->hash != offer.hash)
    {
        log_.write(fmt::format("warning: model '{}' is published with two hashes, {} (seen first, "
                               "used unless pinned by NAME@HASH) and {}",
                               offer.name, hash_text(first->hash), hash_text(offer.hash)));
    }
    offers_.push_back(offer);
    ++version_;
}

void Catalogue::remove(std::uint32_t model, std::uint64_t host_epoch)
{
    version_ += std::erase_if(offers_, [&](const Offer& offer)
                              { return offer.model == model && offer.host_epoch == host_epoch; });
}

} // namespace tactus::dds
