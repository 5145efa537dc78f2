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

/// Kinds of events about the server that has authority over a name (Authority).
enum class ServerNews : std::uint8_t
{
    pinned,   ///< The first server was chosen; its objects count from now on.
    lost,     ///< The chosen server is gone.
    back,     ///< The chosen server is present again.
    replaced, ///< Another server was chosen in place of one that is gone.
    /// Another server offers the name while the chosen one is gone, and may not replace it.
    not_followed,
    namesake, ///< Another server offers the name while the chosen one is present.
};
inline constexpr std::size_t kServerNewsKinds = 6;
/// Names in the order of ServerNews, as in the report.
[[nodiscard]] const std::array<const char*, kServerNewsKinds>& server_news_names() noexcept;

/// A change of the server that a controller follows.
struct ServerEvent
{
    std::chrono::steady_clock::time_point time{};
    ServerNews news{ServerNews::pinned};
    std::string what;   ///< "scene 'NAME'" or "model 'NAME'".
    std::string server; ///< Name of the server's program, with its process and machine.
};

/// Chooses the one server that decides over a name: the hash of the model, the objects, their poses
/// and materials. Pieces may come from any server, since their hashes prove them.
///
/// The first server that answers is chosen; its DDS participant identifies it. If it is gone, a
/// server with the same certificate (DDS Security) or one that Failover allows replaces it. Without
/// such a server the last state stays and becomes stale. Each change is logged and recorded as an
/// event. One thread, that of the catalogue.
class Authority
{
public:
    /// `name` is the name of a scene, or the name and hash (asserted) of a model. The catalogue
    /// must outlive the authority.
    Authority(Catalogue& catalogue, const ModelSelector& name, bool is_scene, Failover failover,
              Log log);

    /// Chooses the first server. Call it once, before step().
    void pin(std::uint64_t server_epoch);

    /// Epoch of the chosen server, present or not.
    [[nodiscard]] std::uint64_t server() const noexcept { return server_epoch_; }
    /// True if the chosen server is present.
    [[nodiscard]] bool is_resident() const noexcept { return is_resident_; }

    /// Updates the choice from the catalogue. Cheap if the catalogue has not changed.
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
    std::uint64_t server_epoch_{0};
    ParticipantId server_{};
    /// Name of the chosen server, stored since DDS does not know it once the server is gone.
    std::string server_name_;
    bool is_resident_{false};
    std::uint64_t seen_catalogue_{0};
    std::set<ParticipantId> named_; ///< Other servers that were logged since the last change.
    std::vector<ServerEvent> events_;
};

} // namespace tactus::dds
