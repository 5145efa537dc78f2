// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/topics.hpp"
#include "transport/log.hpp"
#include "transport/model_name.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tactus::dds
{

/// What a controller sees of the models that are published on its domain at present. One thread,
/// that of the client; no call waits. An offer that is pointed at is there until the next
/// refresh().
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
        std::uint64_t writer{0}; ///< Handle of that one's writer.
        bool is_disputed{false}; ///< Somebody said that it is gone, perhaps another program.
    };

    /// `domain` must outlive it.
    [[nodiscard]] static Result<Catalogue, Refusal> create(const Domain& domain, Log log);

    /// Takes news from DDS: new offers, hosts that left or fell silent, programs that speak another
    /// version of the protocol; tells what was refused. Cheap when there are none.
    void refresh();

    /// Changes with what is there.
    [[nodiscard]] std::uint64_t version() const noexcept { return version_; }

    /// The offer first seen of those that are there now; null when there is none. With a hash in
    /// the selector only that one counts.
    [[nodiscard]] const Offer* find(const ModelSelector& selector) const;
    /// The same of a hash, under whatever name.
    [[nodiscard]] const Offer* find(const ContentHash& hash) const;
    /// The offer of one run of one host; null when that is gone.
    [[nodiscard]] const Offer* find(const ContentHash& hash, std::uint64_t host_epoch) const;

    /// The host with a scene of that name that was seen first of those that are there now.
    [[nodiscard]] std::optional<std::uint64_t> find_scene(const std::string& name) const;
    /// What a host serves, in the order of its numbers.
    [[nodiscard]] std::vector<const Offer*> offers_of(std::uint64_t host_epoch) const;

    /// Whether that run of a host is there.
    [[nodiscard]] bool has_host(std::uint64_t host_epoch) const;

    /// Their names for a message, "none" without any; a long list is cut.
    [[nodiscard]] std::string names() const;
    /// The same of scenes.
    [[nodiscard]] std::string scene_names() const;

private:
    Catalogue(Participants& participants, Endpoint reader, Log log);

    [[nodiscard]] bool try_add(const Offer& offer);
    void remove(std::uint32_t model, std::uint64_t host_epoch);
    void on_end(std::uint32_t model, std::uint64_t host_epoch, std::uint64_t writer);
    void dispute(std::uint32_t model, std::uint64_t host_epoch);
    void look_at_disputed();

    Participants* participants_;
    Endpoint reader_;
    RateLimitedLog log_;
    std::vector<Offer> offers_;
    std::uint64_t version_{0};
    std::chrono::steady_clock::time_point looked_{}; ///< At what is disputed.
};

} // namespace tactus::dds
