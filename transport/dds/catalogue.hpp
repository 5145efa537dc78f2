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
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace tactus::dds
{

/// What a controller sees of the models that are published on its domain at present. One thread,
/// that of the client; no call waits. An offer that is pointed at is there until the next
/// refresh().
///
/// Offers of what was asked for are kept first, then those of other names. Where there is no room
/// for one more, the participant with the most offers loses its last: so many strangers can't keep
/// a server out. What was left out is announced again within a second.
class Catalogue
{
public:
    struct Offer
    {
        std::string name;
        std::string scene; ///< Of its host's objects; may be empty.
        ContentHash hash{};
        std::uint64_t host_epoch{0};
        std::uint32_t model{0}; ///< Its number on that host.
        std::uint32_t faces{0};
        std::uint32_t header_bytes{0};
        std::uint32_t base_bytes{0};
        ParticipantId host{};
        std::uint64_t writer{0};  ///< Handle of that one's writer.
        bool is_disputed{false};  ///< Somebody said that it is gone, perhaps another program.
        std::uint64_t arrival{0}; ///< Higher for what was seen later.
    };
    static constexpr std::size_t kMaxOffers = 16'384;

    /// `domain` must outlive it. `room` is for the offers of all participants, above 0.
    [[nodiscard]] static Result<Catalogue, Refusal> create(const Domain& domain, Log log,
                                                           std::size_t room = kMaxOffers);

    /// From now on offers like these are asked for. Call it before the first refresh(), or what was
    /// left out until then comes within a second.
    void ask_for(const ModelSelector& model);
    void ask_for_scene(const std::string& name);
    /// All offers of this host are kept.
    void keep(std::uint64_t host_epoch);

    /// Takes news from DDS: new offers, hosts that left or fell silent, programs that speak another
    /// version of the protocol; tells what was refused. Cheap when there are none.
    void refresh();

    /// Changes with what is there of what was asked for; with all that is there if nothing was.
    [[nodiscard]] std::uint64_t version() const noexcept { return version_; }

    /// In the order in which they were seen: those of a name, or of any where it is empty; with a
    /// hash or a server in the selector only theirs.
    [[nodiscard]] std::vector<const Offer*> offers(const ModelSelector& selector) const;
    /// The first of those of each host.
    [[nodiscard]] std::vector<const Offer*> servers_of(const ModelSelector& selector) const;
    /// The first of all; null when there is none.
    [[nodiscard]] const Offer* find(const ModelSelector& selector) const;
    /// The offer of one run of one host; null when that is gone.
    [[nodiscard]] const Offer* find(const ContentHash& hash, std::uint64_t host_epoch) const;

    /// The same of a scene.
    [[nodiscard]] std::vector<const Offer*> servers_of_scene(const ModelSelector& selector) const;
    /// What a host serves, in the order of its numbers.
    [[nodiscard]] std::vector<const Offer*> offers_of(std::uint64_t host_epoch) const;

    /// Whether that run of a host is there.
    [[nodiscard]] bool has_host(std::uint64_t host_epoch) const;

    /// Their names for a message, "none" without any; a long list is cut.
    [[nodiscard]] std::string names() const;
    /// The same of scenes.
    [[nodiscard]] std::string scene_names() const;

    [[nodiscard]] const Participants& participants() const noexcept { return *participants_; }

private:
    /// Host and number.
    using Key = std::pair<std::uint64_t, std::uint32_t>;
    /// How many offers a host has here that are asked for, and others.
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
    [[nodiscard]] bool try_make_room(std::uint64_t host_epoch, bool for_asked);
    [[nodiscard]] bool try_take_from_largest(bool asked, std::size_t more_than);
    void count_again();
    void remove(const Key& key);
    void on_end(std::uint32_t model, std::uint64_t host_epoch, std::uint64_t writer);
    void dispute(std::uint32_t model, std::uint64_t host_epoch);
    void look_at_disputed();

    Participants* participants_;
    Endpoint reader_;
    RateLimitedLog log_;
    std::size_t room_;
    std::map<Key, Offer> offers_;
    std::map<std::uint64_t, Share> shares_; ///< By host.
    std::set<std::string> asked_names_;
    std::set<ContentHash> asked_hashes_;
    std::set<std::string> asked_scenes_;
    std::set<std::uint64_t> kept_hosts_;
    std::uint64_t arrivals_{0};
    std::uint64_t version_{0};
    std::chrono::steady_clock::time_point looked_{}; ///< At what is disputed.
};

} // namespace tactus::dds
