// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/catalogue.hpp"

#include "transport/dds/take.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// Maximum number of samples taken in one refresh(); further ones wait in the reader.
constexpr std::size_t kEntriesPerRefresh = 4'096;
/// Maximum number of servers that keep() protects. A further one replaces one that is gone, or else
/// any.
constexpr std::size_t kMaxKeptServers = 64;
constexpr std::size_t kMaxNamesShown = 20;

ContentHash hash_from(const std::uint8_t (&bytes)[16]) // NOLINT: idlc's type.
{
    ContentHash hash{};
    std::memcpy(hash.data(), bytes, hash.size());
    return hash;
}

std::vector<const Catalogue::Offer*> first_of_each(std::vector<const Catalogue::Offer*> offers)
{
    std::set<std::uint64_t> servers;
    std::erase_if(offers, [&](const Catalogue::Offer* offer)
                  { return !servers.insert(offer->server_epoch).second; });
    return offers;
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

std::optional<Catalogue::Offer> offer_from(const tactus_v5_CatalogueEntry& entry)
{
    const std::string name(text_of(entry.name));
    const std::string scene(text_of(entry.scene));
    if (!is_valid_name(name) || !(scene.empty() || is_valid_name(scene)))
    {
        return std::nullopt;
    }
    return Catalogue::Offer{name,
                            scene,
                            hash_from(entry.model_hash),
                            entry.server_epoch,
                            entry.model,
                            entry.faces,
                            entry.header_bytes,
                            entry.base_bytes,
                            std::min(entry.edit_room, kMaxAddedFaces)};
}

Result<Catalogue, Refusal> Catalogue::create(const Domain& domain, Log log, std::size_t room)
{
    auto reader = make_reader(domain, Topic::catalogue, "");
    if (!reader)
    {
        return reader.error();
    }
    return Catalogue(domain.participants(), std::move(reader).value(), std::move(log), room);
}

Catalogue::Catalogue(Participants& participants, Endpoint reader, Log log, std::size_t room)
    : participants_(&participants), reader_(std::move(reader)), log_(std::move(log)), room_(room)
{
}

void Catalogue::ask_for(const ModelSelector& model)
{
    const bool is_new_name = !model.name.empty() && asked_names_.insert(model.name).second;
    const bool is_new_hash = model.hash && asked_hashes_.insert(*model.hash).second;
    if (is_new_name || is_new_hash)
    {
        count_again();
    }
}

void Catalogue::ask_for_scene(const std::string& name)
{
    if (asked_scenes_.insert(name).second)
    {
        count_again();
    }
}

void Catalogue::keep(std::uint64_t server_epoch)
{
    if (!kept_servers_.insert(server_epoch).second)
    {
        return;
    }
    if (kept_servers_.size() > kMaxKeptServers)
    {
        const auto is_other = [&](std::uint64_t epoch) { return epoch != server_epoch; };
        auto given_up = std::ranges::find_if(kept_servers_, [&](std::uint64_t epoch)
                                             { return is_other(epoch) && !has_server(epoch); });
        if (given_up == kept_servers_.end())
        {
            given_up = std::ranges::find_if(kept_servers_, is_other);
        }
        kept_servers_.erase(given_up);
    }
    count_again();
}

/// Counts all shares again after a change of the requested offers.
void Catalogue::count_again()
{
    shares_.clear();
    for (const auto& [key, offer] : offers_)
    {
        Share& share = shares_[key.first];
        ++(is_asked(offer) ? share.asked : share.others);
    }
    ++version_;
}

bool Catalogue::is_asked(const Offer& offer) const
{
    return asked_names_.contains(offer.name) || asked_hashes_.contains(offer.hash) ||
           (!offer.scene.empty() && asked_scenes_.contains(offer.scene)) ||
           kept_servers_.contains(offer.server_epoch);
}

void Catalogue::refresh()
{
    participants_->report(log_);
    take_each<tactus_v5_CatalogueEntry>(
        reader_.handle, kEntriesPerRefresh,
        [this](const tactus_v5_CatalogueEntry& entry, const dds_sample_info_t& info)
        {
            const auto refuse = [&](Refused reason)
            { participants_->refuse(info.publication_handle, reason, entry.model); };
            if (tells_end(info))
            {
                on_end(entry.model, entry.server_epoch, info.publication_handle);
            }
            else if (auto offer = offer_from(entry))
            {
                const auto server = participants_->writer_of(info.publication_handle);
                offer->server = server.value_or(ParticipantId{});
                offer->writer = info.publication_handle;
                if (!try_add(*std::move(offer)))
                {
                    refuse(Refused::model_room);
                }
                if (info.instance_state != DDS_ALIVE_INSTANCE_STATE)
                {
                    dispute(entry.model, entry.server_epoch);
                }
            }
            else
            {
                refuse(Refused::model_name);
            }
        });
    remove_gone_offers();
}

/// Handles the end of an offer in DDS. If its server left, the offer is removed. A server that is
/// only silent keeps it until the lease ends, since a flood of packets can silence servers. Any
/// program can end an instance past the filter; DDS's later reports on it are then unreliable, so
/// the offer becomes disputed and is checked.
void Catalogue::on_end(std::uint32_t model, std::uint64_t server_epoch, std::uint64_t writer)
{
    if (!participants_->is_server(writer, server_epoch))
    {
        participants_->refuse(writer, Refused::identity);
    }
    else if (!participants_->is_writing(writer))
    {
        remove({server_epoch, model});
        return;
    }
    dispute(model, server_epoch);
}

void Catalogue::dispute(std::uint32_t model, std::uint64_t server_epoch)
{
    if (const auto offer = offers_.find({server_epoch, model}); offer != offers_.end())
    {
        offer->second.is_disputed = true;
    }
}

/// Removes each disputed offer whose server, or its writer, is gone. Checks every 50 ms.
void Catalogue::remove_gone_offers()
{
    constexpr auto kEvery = std::chrono::milliseconds(50);
    const auto now = std::chrono::steady_clock::now();
    if (now - looked_ < kEvery)
    {
        return;
    }
    looked_ = now;
    std::vector<Key> gone;
    for (const auto& [key, offer] : offers_)
    {
        if (offer.is_disputed &&
            !(participants_->is_writing(offer.writer) && participants_->is_resident(offer.server)))
        {
            gone.push_back(key);
        }
    }
    std::ranges::for_each(gone, [this](const Key& key) { remove(key); });
}

std::vector<const Catalogue::Offer*> Catalogue::select(const ModelSelector& selector,
                                                       bool by_scene) const
{
    std::map<std::uint64_t, bool> called; // Result by server, to query each one once.
    const auto is_called = [&](const Offer& offer)
    {
        const auto [known, is_new] = called.try_emplace(offer.server_epoch, false);
        known->second =
            is_new ? participants_->is_called(offer.server, selector.server) : known->second;
        return known->second;
    };
    std::vector<const Offer*> found;
    for (const auto& [key, offer] : offers_)
    {
        const std::string& name = by_scene ? offer.scene : offer.name;
        if ((selector.name.empty() || name == selector.name) &&
            (!selector.hash || offer.hash == *selector.hash) &&
            (selector.server.empty() || is_called(offer)))
        {
            found.push_back(&offer);
        }
    }
    std::ranges::sort(found, {}, &Offer::arrival);
    return found;
}

std::vector<const Catalogue::Offer*> Catalogue::offers(const ModelSelector& selector) const
{
    return select(selector, false);
}

std::vector<const Catalogue::Offer*> Catalogue::servers_of(const ModelSelector& selector) const
{
    return first_of_each(select(selector, false));
}

std::vector<const Catalogue::Offer*>
Catalogue::servers_of_scene(const ModelSelector& selector) const
{
    return first_of_each(select(selector, true));
}

const Catalogue::Offer* Catalogue::find(const ModelSelector& selector) const
{
    const std::vector<const Offer*> found = offers(selector);
    return found.empty() ? nullptr : found.front();
}

const Catalogue::Offer* Catalogue::find(const ContentHash& hash, std::uint64_t server_epoch) const
{
    for (auto at = offers_.lower_bound({server_epoch, 0});
         at != offers_.end() && at->first.first == server_epoch; ++at)
    {
        if (at->second.hash == hash)
        {
            return &at->second;
        }
    }
    return nullptr;
}

bool Catalogue::has_server(std::uint64_t server_epoch) const
{
    const auto at = offers_.lower_bound({server_epoch, 0});
    return at != offers_.end() && at->first.first == server_epoch;
}

std::vector<const Catalogue::Offer*> Catalogue::offers_of(std::uint64_t server_epoch) const
{
    std::vector<const Offer*> found;
    for (auto at = offers_.lower_bound({server_epoch, 0});
         at != offers_.end() && at->first.first == server_epoch; ++at)
    {
        found.push_back(&at->second);
    }
    return found;
}

std::string Catalogue::names() const
{
    std::vector<std::string> names;
    for (const Offer* offer : offers({}))
    {
        names.push_back(offer->name);
    }
    return list_of(names);
}

std::string Catalogue::scene_names() const
{
    std::vector<std::string> names;
    std::set<std::string> listed;
    for (const Offer* offer : offers({}))
    {
        if (!offer->scene.empty() && listed.insert(offer->scene).second)
        {
            names.push_back(offer->scene);
        }
    }
    return list_of(names);
}

/// Stores an offer, or updates a known one; false if there is no room.
bool Catalogue::try_add(Offer offer)
{
    const Key key{offer.server_epoch, offer.model};
    const auto known = offers_.find(key);
    if (known != offers_.end() && known->second.name == offer.name &&
        known->second.hash == offer.hash && known->second.scene == offer.scene)
    {
        return true; // Offers are repeated every second.
    }
    remove(key);
    const bool asked = is_asked(offer);
    if (offers_.size() >= room_ && !try_make_room(offer.server_epoch, asked))
    {
        return false;
    }
    Share& share = shares_[offer.server_epoch];
    ++(asked ? share.asked : share.others);
    offer.arrival = ++arrivals_;
    offers_.emplace(key, std::move(offer));
    version_ += asked || (asked_names_.empty() && asked_hashes_.empty() && asked_scenes_.empty());
    return true;
}

/// Removes one stored offer for a new one of `server_epoch`; false if none may be removed. A
/// requested offer displaces one that was not requested first.
bool Catalogue::try_make_room(std::uint64_t server_epoch, bool for_asked)
{
    const auto share = shares_.find(server_epoch);
    const Share own = share == shares_.end() ? Share{} : share->second;
    return for_asked ? try_take_from_largest(false, 0) || try_take_from_largest(true, own.asked + 1)
                     // The margin of 1 keeps two servers with equal shares from displacing each
                     // other.
                     : try_take_from_largest(false, own.others + 1);
}

/// Removes the last offer of the server with the most offers of this kind (`asked`: requested
/// ones). False if no server has more than `more_than`.
bool Catalogue::try_take_from_largest(bool asked, std::size_t more_than)
{
    const auto count = [&](const auto& entry)
    { return kept_servers_.contains(entry.first) ? 0 : entry.second.of(asked); };
    const auto largest = std::ranges::max_element(shares_, {}, count);
    if (largest == shares_.end() || count(*largest) <= more_than)
    {
        return false;
    }
    const std::uint64_t epoch = largest->first;
    for (auto at = offers_.upper_bound({epoch, UINT32_MAX}); at != offers_.begin();)
    {
        --at;
        if (is_asked(at->second) == asked)
        {
            const Offer lost = at->second;
            remove(at->first);
            participants_->refuse(lost.writer, Refused::model_room, lost.model);
            return true;
        }
    }
    return false;
}

void Catalogue::remove(const Key& key)
{
    const auto at = offers_.find(key);
    if (at == offers_.end())
    {
        return;
    }
    const bool asked = is_asked(at->second);
    const auto share = shares_.find(key.first);
    --(asked ? share->second.asked : share->second.others);
    if (share->second.asked == 0 && share->second.others == 0)
    {
        shares_.erase(share);
    }
    offers_.erase(at);
    version_ += asked || (asked_names_.empty() && asked_hashes_.empty() && asked_scenes_.empty());
}

} // namespace tactus::dds
