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

/// Domain ids of the DDS port mapping.
inline constexpr std::uint32_t kMaxDomain = 232;

/// Whom a participant finds in our own configuration, and by whom it is found.
enum class Party : std::uint8_t
{
    host,       ///< Is found by controllers, looks for nobody; or one that watches controllers.
    controller, ///< Finds hosts. Controllers don't find each other.
    both,       ///< Is found as a host, and finds hosts.
};

/// One participant in one DDS domain.
///
/// Configuration is always explicit: the user's CYCLONEDDS_URI when it is set, else loopback,
/// unicast, a lease of one second and small thread stacks (the process may lock its memory).
/// Nothing multicasts or leaves the machine unless the user says so.
///
/// Cyclone's threads inherit policy, priority and affinity of the thread that joins: join before a
/// real-time thread exists, from an ordinary one. Its messages go to stderr at a limited rate.
class Domain
{
public:
    /// `id` is 0 .. 232. Refused with Cyclone's own reason, e.g. for an unknown element in
    /// CYCLONEDDS_URI or when no network interface fits. In our own configuration a machine has
    /// room for ten processes with a host or watcher on a domain, and a process that is both host
    /// and controller must join as a host first: refused else. Its controllers then find its own
    /// hosts alone; as `both`, and as long as that domain lives, other processes' hosts as well.
    [[nodiscard]] static Result<Domain, Refusal> join(std::uint32_t id, Party party = Party::host);

    [[nodiscard]] std::uint32_t id() const noexcept { return id_; }
    [[nodiscard]] std::int32_t participant() const noexcept { return participant_.get(); }
    /// Who is there, and who we are.
    [[nodiscard]] Participants& participants() const noexcept { return *participants_; }
    /// For what is over, where its end must not be waited for.
    [[nodiscard]] Disposal& disposal() const noexcept { return *disposal_; }

private:
    std::uint32_t id_{0};
    std::shared_ptr<Entity> configuration_; ///< Ours, shared by the process; outlives participants.
    std::unique_ptr<Participants> participants_; ///< In use as long as there are readers.
    Entity participant_;
    std::unique_ptr<Disposal> disposal_{std::make_unique<Disposal>()}; ///< Ends before that.
};

/// Where on a domain no host was heard: the likeliest causes that can be known here. That
/// CYCLONEDDS_URI isn't set, so that only this machine is heard, and the other domains on which
/// this machine's programs are. None where nothing is known. Reads /proc.
[[nodiscard]] std::optional<std::string> why_unheard(std::uint32_t domain);

/// The domains of the ports of a text like that of /proc/net/udp, ascending; by the ports that
/// programs have which others find.
[[nodiscard]] std::set<std::uint32_t> domains_in(std::string_view udp_sockets);

} // namespace tactus::dds
