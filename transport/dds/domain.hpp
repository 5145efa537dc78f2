// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/network_security.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/entity.hpp"
#include "transport/dds/participants.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace tactus::dds
{

/// Maximum domain id of the DDS port mapping.
inline constexpr std::uint32_t kMaxDomain = 232;

/// Role of a participant in discovery with the default configuration.
enum class Party : std::uint8_t
{
    /// Found by controllers; searches for no participant. Also for programs that watch controllers.
    server,
    controller, ///< Searches for servers. Controllers do not find each other.
    both,       ///< Found like a server, and searches for servers.
};

/// A domain to join, and its protection.
struct DomainChoice
{
    /// Joins without keys, on any network.
    DomainChoice(std::uint32_t domain) : id(domain), security{{}, true, false} {}
    DomainChoice(std::uint32_t domain, NetworkSecurity chosen)
        : id(domain), security(std::move(chosen))
    {
    }

    std::uint32_t id;
    NetworkSecurity security;
};

/// One participant in one DDS domain.
///
/// Without CYCLONEDDS_URI the default configuration applies: loopback, unicast, a lease of one
/// second and small thread stacks, since the process may lock its memory. Multicast and other
/// machines need a configuration by the user.
///
/// Cyclone's threads inherit policy, priority and affinity of the thread that calls join(). Call it
/// on an ordinary thread before any real-time thread exists. Cyclone's messages go to stderr at a
/// limited rate.
class Domain
{
public:
    /// Joins a domain, id 0 to kMaxDomain. Refused: keys that read_key_folder() refuses; without
    /// keys any domain if the choice requires them, and a network beyond this machine, unless the
    /// choice is plain or CYCLONEDDS_URI enables DDS Security; and Cyclone's own reasons, for
    /// example an unknown element in CYCLONEDDS_URI. The default configuration has room for ten
    /// processes with a server or watcher on one machine and domain; further ones are refused. A
    /// process that is server and controller must join as the server first (otherwise refused); its
    /// controllers then find only its own servers. After Party::both they find those of other
    /// processes too, as long as that domain lives.
    [[nodiscard]] static Result<Domain, Refusal> join(const DomainChoice& choice,
                                                      Party party = Party::server);

    [[nodiscard]] std::uint32_t id() const noexcept { return id_; }
    [[nodiscard]] std::int32_t participant() const noexcept { return participant_.get(); }
    /// Name of our certificate; empty without keys.
    [[nodiscard]] const std::string& certificate() const noexcept { return certificate_; }
    /// Participants on the domain, this one included.
    [[nodiscard]] Participants& participants() const noexcept { return *participants_; }
    /// Ends all connections of this process on the domain: it neither sends nor receives for this
    /// time, and continues then. Returns at once; logs a warning.
    void be_silent(std::chrono::seconds length) const;
    /// Disposal for entities whose deletion must not delay the caller.
    [[nodiscard]] Disposal& disposal() const noexcept { return *disposal_; }

private:
    std::uint32_t id_{0};
    std::string certificate_;
    /// Default configuration, shared by all domains of this id in the process; outlives
    /// participants.
    std::shared_ptr<Entity> configuration_;
    std::unique_ptr<Participants> participants_; ///< Used by all readers, which must end first.
    Entity participant_;
    /// Destroyed before the participant.
    std::unique_ptr<Disposal> disposal_{std::make_unique<Disposal>()};
};

/// Likely causes why no server was heard on a domain, in one text: CYCLONEDDS_URI is not set, or
/// this machine's programs are on other domains. None if no cause is known. Reads /proc/net/udp.
[[nodiscard]] std::optional<std::string> why_unheard(std::uint32_t domain);

/// Domains that the UDP ports in a text like /proc/net/udp belong to, ascending. Only the ports of
/// servers count.
[[nodiscard]] std::set<std::uint32_t> domains_in(std::string_view udp_sockets);

} // namespace tactus::dds
