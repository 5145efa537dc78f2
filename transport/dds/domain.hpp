// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/disposal.hpp"
#include "transport/dds/entity.hpp"
#include "transport/dds/participants.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace tactus::dds
{

/// Maximum domain id of the DDS port mapping.
inline constexpr std::uint32_t kMaxDomain = 232;

/// Role of a participant in discovery, in the configuration that Tactus sets.
enum class Party : std::uint8_t
{
    /// Is found by controllers and searches for none; also for programs that watch controllers.
    host,
    controller, ///< Finds servers. Controllers do not find each other.
    both,       ///< Is found as a server, and finds servers.
};

/// One participant in one DDS domain.
///
/// The configuration is always explicit: the user's CYCLONEDDS_URI if set, otherwise loopback,
/// unicast, a lease of one second and small thread stacks (the process may lock its memory).
/// Nothing is multicast or leaves the machine unless the user configures it.
///
/// Cyclone's threads inherit policy, priority and affinity of the thread that joins: join before a
/// real-time thread exists, from an ordinary one. Cyclone's messages go to stderr at a limited
/// rate.
class Domain
{
public:
    /// `id` is 0 .. 232. Refused with Cyclone's own reason, e.g. for an unknown element in
    /// CYCLONEDDS_URI or if no network interface fits. In the default configuration a machine has
    /// room for ten processes with a server or watcher on a domain; further ones are refused. A
    /// process that is both server and controller must join as a server first; the other order is
    /// refused. Its controllers then find only its own servers; if it joined as `both`, and as long
    /// as that domain lives, also those of other processes.
    [[nodiscard]] static Result<Domain, Refusal> join(std::uint32_t id, Party party = Party::host);

    [[nodiscard]] std::uint32_t id() const noexcept { return id_; }
    [[nodiscard]] std::int32_t participant() const noexcept { return participant_.get(); }
    /// Participants on the domain, this one included.
    [[nodiscard]] Participants& participants() const noexcept { return *participants_; }
    /// Disposal for entities whose deletion must not delay the caller.
    [[nodiscard]] Disposal& disposal() const noexcept { return *disposal_; }

private:
    std::uint32_t id_{0};
    /// Default configuration, shared by the process; outlives participants.
    std::shared_ptr<Entity> configuration_;
    std::unique_ptr<Participants> participants_; ///< Used by all readers, which must end first.
    Entity participant_;
    /// Destroyed before the participant.
    std::unique_ptr<Disposal> disposal_{std::make_unique<Disposal>()};
};

/// Likely causes, from this machine's state, why no server was heard on a domain: CYCLONEDDS_URI is
/// not set, so only this machine is heard; and the other domains on which this machine's programs
/// are. None if nothing is known. Reads /proc.
[[nodiscard]] std::optional<std::string> why_unheard(std::uint32_t domain);

/// Domains that the ports in a text like /proc/net/udp belong to, ascending. Only ports of
/// discoverable programs count.
[[nodiscard]] std::set<std::uint32_t> domains_in(std::string_view udp_sockets);

} // namespace tactus::dds
