// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/authority.hpp"

#include "rt_core/base/assert.hpp"
#include "transport/content_hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tactus::dds
{

namespace
{

/// Maximum number of other servers that are logged, so that many unknown ones do not fill the log.
constexpr std::size_t kMaxNamed = 16;

} // namespace

const std::array<const char*, kServerNewsKinds>& server_news_names() noexcept
{
    static const std::array<const char*, kServerNewsKinds> names{
        "pinned", "lost", "back", "replaced", "not_followed", "namesake"};
    return names;
}

Authority::Authority(Catalogue& catalogue, const ModelSelector& name, bool is_scene,
                     Failover failover, Log log)
    : catalogue_(catalogue)
    , name_(name)
    , is_scene_(is_scene)
    , what_(fmt::format("{} '{}'", is_scene ? "scene" : "model", name.name))
    , failover_(std::move(failover))
    , log_(std::move(log))
{
    TACTUS_ASSERT(is_scene || name.hash);
}

void Authority::pin(std::uint64_t server_epoch)
{
    server_epoch_ = server_epoch;
    is_resident_ = true;
    const std::vector<const Catalogue::Offer*> offers = catalogue_.offers_of(server_epoch);
    if (!offers.empty())
    {
        server_ = offers.front()->server;
        server_name_ = catalogue_.participants().name_of(server_);
    }
    catalogue_.keep(server_epoch);
    tell(ServerNews::pinned, server_name_, "");
}

void Authority::step()
{
    if (catalogue_.version() == seen_catalogue_)
    {
        return;
    }
    seen_catalogue_ = catalogue_.version();
    const std::vector<const Catalogue::Offer*> offers = candidates();
    const bool was_here = std::exchange(
        is_resident_,
        std::ranges::any_of(offers, [this](const Catalogue::Offer* offer)
                            { return offer->server_epoch == server_epoch_ && has_hash(*offer); }));
    if (was_here && !is_resident_)
    {
        named_.clear();
        tell(ServerNews::lost, server_name_,
             is_scene_ ? fmt::format("the server of {}, {}, disconnected; its objects keep their "
                                     "poses and are stale",
                                     what_, server_name_)
                       : "");
    }
    if (!was_here && is_resident_)
    {
        named_.clear();
        tell(ServerNews::back, server_name_,
             is_scene_
                 ? fmt::format("the server of {}, {}, is connected again", what_, server_name_)
                 : "");
    }
    if (!is_resident_)
    {
        look_for_another(offers);
    }
    if (is_resident_)
    {
        name_others(offers);
    }
}

/// Offers of the scene or model by its name; those of a model with any hash.
std::vector<const Catalogue::Offer*> Authority::candidates() const
{
    return is_scene_ ? catalogue_.servers_of_scene({name_.name})
                     : catalogue_.servers_of({name_.name});
}

bool Authority::has_hash(const Catalogue::Offer& offer) const
{
    return is_scene_ || offer.hash == *name_.hash;
}

bool Authority::may_follow(const Catalogue::Offer& offer) const
{
    const Participants& participants = catalogue_.participants();
    const std::string certificate = participants.certificate_of(server_);
    const bool is_same_party =
        !certificate.empty() && participants.certificate_of(offer.server) == certificate;
    return has_hash(offer) &&
           (is_same_party || failover_.any ||
            std::ranges::any_of(failover_.servers, [&](const std::string& server)
                                { return participants.is_called(offer.server, server); }));
}

void Authority::look_for_another(const std::vector<const Catalogue::Offer*>& offers)
{
    const auto next = std::ranges::find_if(offers, [this](const Catalogue::Offer* offer)
                                           { return may_follow(*offer); });
    if (next != offers.end())
    {
        const Catalogue::Offer& offer = **next;
        server_epoch_ = offer.server_epoch;
        server_ = offer.server;
        is_resident_ = true;
        named_.clear();
        catalogue_.keep(server_epoch_);
        const std::string last =
            std::exchange(server_name_, catalogue_.participants().name_of(server_));
        tell(ServerNews::replaced, server_name_,
             fmt::format("{} now follows {} instead of {}", what_, server_name_, last));
        return;
    }
    for (const Catalogue::Offer* offer : offers)
    {
        if (named_.size() < kMaxNamed && named_.insert(offer->server).second)
        {
            const std::string name = catalogue_.participants().name_of(offer->server);
            const char* form = is_scene_
                                   ? "{} is now offered by {}, which isn't followed: the server "
                                     "was {}, and --failover allows no other"
                                   : "{} is now offered by {}: its pieces are used, but not its "
                                     "objects: the server was {}, and --failover allows no other";
            // DdsLink logs a changed hash.
            tell(ServerNews::not_followed, name,
                 has_hash(*offer) ? fmt::format(fmt::runtime(form), what_, name, server_name_)
                                  : "");
        }
    }
}

void Authority::name_others(const std::vector<const Catalogue::Offer*>& offers)
{
    for (const Catalogue::Offer* offer : offers)
    {
        if (offer->server_epoch != server_epoch_ && named_.size() < kMaxNamed &&
            named_.insert(offer->server).second)
        {
            const std::string name = catalogue_.participants().name_of(offer->server);
            tell(ServerNews::namesake, name,
                 fmt::format("warning: {} is offered by a second server, {}{}; {} is followed; "
                             "choose a server with {}@SERVER",
                             what_, name,
                             has_hash(*offer) ? ""
                                              : ", with another hash, " + hash_text(offer->hash),
                             server_name_, name_.name));
        }
    }
}

void Authority::tell(ServerNews news, const std::string& server, const std::string& line)
{
    if (events_.size() < kMaxEvents)
    {
        events_.push_back({std::chrono::steady_clock::now(), news, what_, server});
    }
    if (!line.empty())
    {
        log_.write(line);
    }
}

} // namespace tactus::dds
