// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/refusals.hpp"

#include "rt_core/limits.hpp"
#include "transport/model_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tactus::dds
{

namespace
{

/// Text of the log line for a reason; empty for reasons that are logged elsewhere.
std::string reason_of(Refused reason, std::uint32_t number)
{
    switch (reason)
    {
    case Refused::identity:
        return "a sample with the identity of another server or controller";
    case Refused::object_number:
        return fmt::format("object {}: its number is not in 0 .. {}", number, kMaxObjects - 1);
    case Refused::model_number:
        return fmt::format("model {}: its number is not in 0 .. {}", number, kMaxModels - 1);
    case Refused::object_name:
        return fmt::format("object {}: its name is not {}", number, kNameForm);
    case Refused::object_material:
        return fmt::format(
            "object {}: its material is invalid: the stiffness must be above 0, friction, damping "
            "and "
            "viscosity at least 0, the dynamic friction at most the static friction, and the "
            "texture height at most 1/32 of the texture length of 0.0001 to 1 m",
            number);
    case Refused::object_pose:
        return fmt::format("object {}: its pose is invalid", number);
    case Refused::model_name:
        return fmt::format("model {}: its name, or its scene's, is not {}", number, kNameForm);
    case Refused::model_room:
        return fmt::format("model {}: the domain has too many models", number);
    case Refused::request:
        return "a request for a piece that does not exist";
    case Refused::telemetry:
        return "telemetry with an invalid name or number, or of too many controllers";
    case Refused::rate:
        return "more pieces requested in a second than a server accepts from one process";
    case Refused::edit:
        return fmt::format("model {}: an edit with wrong numbers or damaged bytes", number);
    case Refused::edit_request:
        return fmt::format("model {}: a request of an edit with impossible values, of a model "
                           "without edits, or of a controller that may not edit",
                           number);
    case Refused::not_served:
    case Refused::controller:
        break;
    }
    return "";
}

} // namespace

const std::array<const char*, kRefusedKinds>& refused_names() noexcept
{
    static constexpr std::array<const char*, kRefusedKinds> names{
        "identity",    "object_number", "model_number", "object_name", "object_material",
        "object_pose", "not_served",    "model_name",   "model_room",  "controller",
        "request",     "telemetry",     "rate",         "edit",        "edit_request"};
    return names;
}

void Refusals::count(const ParticipantId& peer, Refused reason, std::uint32_t number)
{
    const std::lock_guard lock(mutex_);
    auto at =
        std::ranges::find_if(peers_, [&](const Peer& known) { return known.refused.id == peer; });
    if (at == peers_.end() && peers_.size() < kMaxPeers)
    {
        Peer news;
        news.refused.id = peers_.size() + 1 < kMaxPeers ? peer : ParticipantId{};
        at = peers_.insert(peers_.end(), std::move(news));
    }
    Peer& known = at == peers_.end() ? peers_.back() : *at;
    const auto kind = static_cast<std::size_t>(reason);
    if (known.refused.counts.at(kind)++ == 0)
    {
        known.reasons.at(kind).first = number;
    }
    has_news_ = true;
}

/// Holds the lock neither to look up names nor to write lines, since Cyclone's threads wait for it.
void Refusals::report(RateLimitedLog& log,
                      const std::function<std::string(const ParticipantId&)>& name_of)
{
    if (!has_news_.exchange(false))
    {
        return;
    }
    const std::vector<PeerRefusals> known = list();
    std::vector<std::string> names;
    for (const PeerRefusals& peer : known)
    {
        names.push_back(peer.name.empty() ? name_of(peer.id) : peer.name);
    }
    for (const std::string& line : take_lines(names))
    {
        log.write(line);
    }
}

/// Returns a log line for each count that reached its next power of ten, and raises that limit.
/// `names` are those of the first participants in `peers_`; only these are searched.
std::vector<std::string> Refusals::take_lines(std::span<const std::string> names)
{
    std::vector<std::string> lines;
    const std::lock_guard lock(mutex_);
    for (std::size_t k = 0; k < names.size(); ++k)
    {
        Peer& peer = peers_[k];
        peer.refused.name = names[k];
        for (std::size_t i = 0; i < kRefusedKinds; ++i)
        {
            Reason& reason = peer.reasons.at(i);
            const std::uint64_t count = peer.refused.counts.at(i);
            const std::string text = reason_of(static_cast<Refused>(i), reason.first);
            if (text.empty() || count < reason.told_at)
            {
                continue;
            }
            while (reason.told_at <= count)
            {
                reason.told_at *= 10;
            }
            lines.push_back(fmt::format("refused from {}: {}{}", names[k], text,
                                        count > 1 ? fmt::format(" ({} so far)", count) : ""));
        }
    }
    return lines;
}

std::vector<PeerRefusals> Refusals::list() const
{
    const std::lock_guard lock(mutex_);
    std::vector<PeerRefusals> list;
    for (const Peer& peer : peers_)
    {
        list.push_back(peer.refused);
    }
    return list;
}

} // namespace tactus::dds
