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

std::string list_of(const std::vector<std::string>& names)
{
    std::string text;
    for (std::size_t i = 0; i < names.size() && i < kMaxNamesShown; ++i)
    {
        text += (i > 0 ? ", " : "") + names[i];
    }
    if (names.size() > kMaxNamesShown)
    {
        text += fmt::format(" and {} more", names.size() - kMaxNamesShown);
    }
    return names.empty() ? "none" : text;
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
    participants_->report(log_);
    take_each<tactus_v4_CatalogueEntry>(
        reader_.handle, kMaxOffers,
        [this](const tactus_v4_CatalogueEntry& entry, const dds_sample_info_t& info)
        {
            const std::string name(text_of(entry.name));
            const std::string scene(text_of(entry.scene));
            const auto refuse = [&](Refused reason)
            { participants_->refuse(info.publication_handle, reason, entry.model); };
            if (tells_end(info))
            {
                on_end(entry.model, entry.host_epoch, info.publication_handle);
            }
            else if (is_valid_name(name) && (scene.empty() || is_valid_name(scene)))
            {
                if (!try_add({name, scene, hash_from(entry.model_hash), entry.host_epoch,
                              entry.model, entry.faces, entry.header_bytes, entry.base_bytes,
                              participants_->writer_of(info.publication_handle)
                                  .value_or(ParticipantId{}),
                              info.publication_handle}))
                {
                    refuse(Refused::model_room);
                }
                if (info.instance_state != DDS_ALIVE_INSTANCE_STATE)
                {
                    dispute(entry.model, entry.host_epoch);
                }
            }
            else
            {
                refuse(Refused::model_name);
            }
        });
    look_at_disputed();
}

/// A host that leaves or falls silent takes its offers with it. Anybody can dispose of an instance,
/// past the filter: that is no news, but what DDS tells of the instance isn't either from then on.
void Catalogue::on_end(std::uint32_t model, std::uint64_t host_epoch, std::uint64_t writer)
{
    if (participants_->is_host(writer, host_epoch))
    {
        remove(model, host_epoch);
        return;
    }
    participants_->refuse(writer, Refused::identity);
    dispute(model, host_epoch);
}

void Catalogue::dispute(std::uint32_t model, std::uint64_t host_epoch)
{
    for (Offer& offer : offers_)
    {
        const bool is_it = offer.model == model && offer.host_epoch == host_epoch;
        offer.is_disputed = offer.is_disputed || is_it;
    }
}

/// These go with the writer or the participant of their host.
void Catalogue::look_at_disputed()
{
    constexpr auto kEvery = std::chrono::milliseconds(50);
    const auto now = std::chrono::steady_clock::now();
    if (now - looked_ < kEvery)
    {
        return;
    }
    looked_ = now;
    version_ +=
        std::erase_if(offers_,
                      [this](const Offer& offer)
                      {
                          return offer.is_disputed && !(participants_->is_writing(offer.writer) &&
                                                        participants_->is_here(offer.host));
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

const Catalogue::Offer* Catalogue::find(const ContentHash& hash) const
{
    const auto at = std::ranges::find(offers_, hash, &Offer::hash);
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

std::optional<std::uint64_t> Catalogue::find_scene(const std::string& name) const
{
    const auto at = std::ranges::find(offers_, name, &Offer::scene);
    return at == offers_.end() ? std::nullopt : std::optional(at->host_epoch);
}

std::vector<const Catalogue::Offer*> Catalogue::offers_of(std::uint64_t host_epoch) const
{
    std::vector<const Offer*> offers;
    for (const Offer& offer : offers_)
    {
        if (offer.host_epoch == host_epoch)
        {
            offers.push_back(&offer);
        }
    }
    std::ranges::sort(offers, {}, &Offer::model);
    return offers;
}

std::string Catalogue::names() const
{
    std::vector<std::string> names;
    for (const Offer& offer : offers_)
    {
        names.push_back(offer.name);
    }
    return list_of(names);
}

std::string Catalogue::scene_names() const
{
    std::vector<std::string> names;
    for (const Offer& offer : offers_)
    {
        if (!offer.scene.empty() && std::ranges::find(names, offer.scene) == names.end())
        {
            names.push_back(offer.scene);
        }
    }
    return list_of(names);
}

/// False when there is no room.
bool Catalogue::try_add(const Offer& offer)
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
        return true; // Written anew every second.
    }
    remove(offer.model, offer.host_epoch);
    if (offers_.size() == kMaxOffers)
    {
        return false;
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
    return true;
}

void Catalogue::remove(std::uint32_t model, std::uint64_t host_epoch)
{
    version_ += std::erase_if(offers_, [&](const Offer& offer)
                              { return offer.model == model && offer.host_epoch == host_epoch; });
}

} // namespace tactus::dds
