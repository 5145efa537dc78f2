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

/// What became of the server of a name.
enum class ServerNews : std::uint8_t
{
    pinned,       ///< Its word counts from now on.
    lost,         ///< It is gone.
    back,         ///< The same one.
    replaced,     ///< Another one's word counts from now on.
    not_followed, ///< Another one offers the name while the one that is pinned is gone,
    namesake,     ///< or while it is there.
};
inline constexpr std::size_t kServerNewsKinds = 6;
/// In the order of ServerNews: words of the report.
[[nodiscard]] const std::array<const char*, kServerNewsKinds>& server_news_names() noexcept;

struct ServerEvent
{
    std::chrono::steady_clock::time_point time{};
    ServerNews news{ServerNews::pinned};
    std::string what;   ///< "scene 'NAME'" or "model 'NAME'".
    std::string server; ///< The program with its process and machine.
};

/// The server whose word counts for one name: which hash it means, which objects there are, where
/// they stand and how they feel. Pieces need none: a hash proves them.
///
/// It is the first server that answered, by its DDS participant, and stays so. When it is gone its
/// place is taken by one with the same certificate (DDS Security), by one that Failover allows, or
/// by none: then what it said last stays, and grows stale. Every change is a line and an event.
/// One thread, that of the catalogue.
class Authority
{
public:
    /// For a scene; for a model with the hash that its name meant. The catalogue must outlive it.
    Authority(Catalogue& catalogue, const ModelSelector& name, bool is_scene, Failover failover,
              Log log);

    /// The server that answered first. Once.
    void pin(std::uint64_t host_epoch);

    /// The host whose word counts: the last one that was there.
    [[nodiscard]] std::uint64_t host() const noexcept { return host_epoch_; }
    /// Whether it is there.
    [[nodiscard]] bool is_here() const noexcept { return is_here_; }

    /// Looks what has become of it. Cheap without news.
    void step();

    /// The oldest kMaxEvents.
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
    std::string host_name_; ///< As long as it can be asked for.
    bool is_here_{false};
    std::uint64_t seen_catalogue_{0};
    std::set<ParticipantId> named_; ///< Others that were told of since the last change.
    std::vector<ServerEvent> events_;
};

} // namespace tactus::dds
