// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/dds/catalogue.hpp"
#include "transport/log.hpp"
#include "transport/model_name.hpp"

#include <array>
#include <chrono>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace tactus::dds
{

/// Change of the server of a name.
enum class ServerNews : std::uint8_t
{
    pinned,   ///< The server is chosen; its statements count from now on.
    lost,     ///< The server is gone.
    back,     ///< The same server is back.
    replaced, ///< Another server's statements count from now on.
    /// Another server offers the name while the chosen one is gone, and may not replace it.
    not_followed,
    namesake, ///< Another server offers the name while the chosen one is present.
};
inline constexpr std::size_t kServerNewsKinds = 6;
/// Names in the order of ServerNews, as in the report.
[[nodiscard]] const std::array<const char*, kServerNewsKinds>& server_news_names() noexcept;

struct ServerEvent
{
    std::chrono::steady_clock::time_point time{};
    ServerNews news{ServerNews::pinned};
    std::string what;   ///< "scene 'NAME'" or "model 'NAME'".
    std::string server; ///< Program of the server, with its process and machine.
};

/// The server with authority over one name: the hash of the name, the list of objects, their poses
/// and materials. Pieces need no authority: their hashes prove them.
///
/// The first server that answers has it and keeps it; it is identified by its DDS participant. If
/// it is gone, a server with the same certificate (DDS Security) or one that Failover allows takes
/// over. If there is none, the last state stays and becomes stale. Every change is logged and
/// recorded as an event. One thread, that of the catalogue.
class Authority
{
public:
    /// `name` is that of a scene, or of a model and then has its hash (asserted). The catalogue
    /// must outlive the authority.
    Authority(Catalogue& catalogue, const ModelSelector& name, bool is_scene, Failover failover,
              Log log);

    /// Chooses the server that answered first. Call it once.
    void pin(std::uint64_t host_epoch);

    /// Epoch of the server with authority, present or not.
    [[nodiscard]] std::uint64_t host() const noexcept { return host_epoch_; }
    /// True if that server is present.
    [[nodiscard]] bool is_resident() const noexcept { return is_resident_; }

    /// Updates the state from the catalogue. Cheap if that has not changed.
    void step();

    /// Events, oldest first; those after the first kMaxEvents are not recorded.
    [[nodiscard]] const std::vector<ServerEvent>& events() const noexcept { return events_; }
    static constexpr std::size_t kMaxEvents = 64;

private:
    [[nodiscard]] std::vector<const Catalogue::Offer*> candidates() const;
    [[nodiscard]] bool has_hash(const Catalogue::Offer& offer) const;
    [[nodiscard]] bool may_follow(const Catalogue::Offer& offer) const;
    void look_for_another(const std::vector<const Catalogue::Offer*>& offers);
    void name_others(const std::vector<const Catalogue::Offer*>& offers);
    void tell(ServerNews news, const std::string& server, const std::string& line);

    Catalogue& catalogue_;
    ModelSelector name_;
    bool is_scene_;
    std::string what_;
    Failover failover_;
    RateLimitedLog log_;
    std::uint64_t host_epoch_{0};
    ParticipantId host_{};
    /// Name of that server, stored because it cannot be looked up once the server is gone.
    std::string host_name_;
    bool is_resident_{false};
    std::uint64_t seen_catalogue_{0};
    std::set<ParticipantId> named_; ///< Other servers that were logged since the last change.
    std::vector<ServerEvent> events_;
};

} // namespace tactus::dds
