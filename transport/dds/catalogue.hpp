// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/topics.hpp"
#include "transport/log.hpp"
#include "transport/model_name.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace tactus::dds
{

/// The models published on the domain at present, as a controller receives them. One thread, that
/// of the client; no call waits. Pointers to offers are valid until the next refresh().
///
/// If all room is taken, a requested offer (ask_for(), keep()) displaces one that was not
/// requested. Otherwise an offer displaces one of the same kind of a server with at least two more.
/// Unknown participants thus cannot keep a server out. An omitted offer is announced again within a
/// second.
class Catalogue
{
public:
    struct Offer
    {
        std::string name;
        std::string scene; ///< Scene that consists of all objects of the server; empty: none.
        ContentHash hash{};
        std::uint64_t server_epoch{0};
        std::uint32_t model{0}; ///< Number of the model on that server.
        std::uint32_t faces{0};
        std::uint32_t header_bytes{0};
        std::uint32_t base_bytes{0};
        std::uint32_t edit_room{0}; ///< Slots for faces that edits add; 0: no edits.
        ParticipantId server{};
        std::uint64_t writer{0}; ///< Handle of the server's writer.
        /// True if any program ended the offer in DDS; refresh() checks whether its server is gone.
        bool is_disputed{false};
        std::uint64_t arrival{0}; ///< Number in the order of discovery, from 1.
    };
    static constexpr std::size_t kMaxOffers = 16'384;

    /// `domain` must outlive the catalogue. `room` is the maximum number of stored offers, of all
    /// servers together; above 0.
    [[nodiscard]] static Result<Catalogue, Refusal> create(const Domain& domain, Log log,
                                                           std::size_t room = kMaxOffers);

    /// Requests offers that match the selector: they have priority from now on. Call it before the
    /// first refresh(); an offer omitted earlier returns within a second.
    void ask_for(const ModelSelector& model);
    void ask_for_scene(const std::string& name);
    /// Requests all offers of this server, and never displaces them.
    void keep(std::uint64_t server_epoch);

    /// Processes DDS events: new offers, servers that are gone, programs with another version of
    /// the protocol. Logs refusals. Cheap without events.
    void refresh();

    /// Number that changes with the requested offers; with all offers if no name, hash or scene was
    /// requested.
    [[nodiscard]] std::uint64_t version() const noexcept { return version_; }

    /// Offers that match the selector, in order of discovery. Empty fields of the selector match
    /// every offer.
    [[nodiscard]] std::vector<const Offer*> offers(const ModelSelector& selector) const;
    /// The first matching offer of each server.
    [[nodiscard]] std::vector<const Offer*> servers_of(const ModelSelector& selector) const;
    /// The first matching offer; null if there is none.
    [[nodiscard]] const Offer* find(const ModelSelector& selector) const;
    /// The offer of a model by the server with this epoch; null if it is gone.
    [[nodiscard]] const Offer* find(const ContentHash& hash, std::uint64_t server_epoch) const;

    /// The first offer of each server that matches, with selector.name as the name of a scene.
    [[nodiscard]] std::vector<const Offer*> servers_of_scene(const ModelSelector& selector) const;
    /// The offers of a server, ascending by the number of the model.
    [[nodiscard]] std::vector<const Offer*> offers_of(std::uint64_t server_epoch) const;

    /// True if the server with this epoch is present.
    [[nodiscard]] bool has_server(std::uint64_t server_epoch) const;

    /// Names of the offered models for a message; "none" without models; a long list is cut.
    [[nodiscard]] std::string names() const;
    /// Names of the offered scenes, in the same form.
    [[nodiscard]] std::string scene_names() const;

    [[nodiscard]] const Participants& participants() const noexcept { return *participants_; }

private:
    /// Epoch of the server and number of the model on it.
    using Key = std::pair<std::uint64_t, std::uint32_t>;
    /// Numbers of stored offers of one server: requested offers and others.
    struct Share
    {
        std::size_t asked{0};
        std::size_t others{0};

        [[nodiscard]] std::size_t of(bool is_asked) const noexcept
        {
            return is_asked ? asked : others;
        }
    };

    Catalogue(Participants& participants, Endpoint reader, Log log, std::size_t room);

    [[nodiscard]] std::vector<const Offer*> select(const ModelSelector& selector,
                                                   bool by_scene) const;
    [[nodiscard]] bool is_asked(const Offer& offer) const;
    [[nodiscard]] bool try_add(Offer offer);
    [[nodiscard]] bool try_make_room(std::uint64_t server_epoch, bool for_asked);
    [[nodiscard]] bool try_take_from_largest(bool asked, std::size_t more_than);
    void count_again();
    void remove(const Key& key);
    void on_end(std::uint32_t model, std::uint64_t server_epoch, std::uint64_t writer);
    void dispute(std::uint32_t model, std::uint64_t server_epoch);
    void remove_gone_offers();

    Participants* participants_;
    Endpoint reader_;
    RateLimitedLog log_;
    std::size_t room_;
    std::map<Key, Offer> offers_;
    std::map<std::uint64_t, Share> shares_; ///< Shares by epoch of the server.
    std::set<std::string> asked_names_;
    std::set<ContentHash> asked_hashes_;
    std::set<std::string> asked_scenes_;
    std::set<std::uint64_t> kept_servers_;
    std::uint64_t arrivals_{0};
    std::uint64_t version_{0};
    std::chrono::steady_clock::time_point looked_{}; ///< Time of the last check of disputed offers.
};

/// Offer in a sample, without `server` and `writer`; none if the name of the model or of its scene
/// is invalid.
[[nodiscard]] std::optional<Catalogue::Offer> offer_from(const tactus_v5_CatalogueEntry& entry);

} // namespace tactus::dds
