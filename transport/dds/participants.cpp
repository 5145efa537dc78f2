// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/participants.hpp"

#include "transport/base/printable.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/key_folder.hpp"
#include "transport/dds/take.hpp"
#include "transport/dds/topics.hpp"

#include <dds/dds.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

namespace tactus::dds
{

namespace
{

/// Maximum number of remembered writers and participants, including deleted ones.
constexpr std::size_t kMaxKnown = 16'384;
constexpr std::string_view kTopicRoot = "tactus/v";

ParticipantId id_of(const dds_guid_t& guid)
{
    ParticipantId id{};
    std::memcpy(id.data(), static_cast<const std::uint8_t*>(guid.v), id.size());
    return id;
}

/// True with DDS Security: without, a GUID begins with the vendor's 01.
bool is_certified(const ParticipantId& participant)
{
    return (participant[0] & 0x80U) != 0;
}

/// Takes changes from the built-in reader `news`: calls `visit(sample)` for present entities and
/// `forget(sample)`, with only the key set, for ended ones. Ended ones are also removed from the
/// reader `kept`, which otherwise keeps them permanently. 1 us without changes.
template <typename Sample, typename Visit, typename Forget>
void take_news(std::int32_t news, std::int32_t kept, Visit&& visit, Forget&& forget)
{
    take_each<Sample>(
        news, kMaxKnown,
        [&](const Sample& sample, const dds_sample_info_t& info)
        {
            if (info.instance_state == DDS_ALIVE_INSTANCE_STATE)
            {
                visit(sample);
                return;
            }
            forget(sample);
            void* last = nullptr;
            dds_sample_info_t last_info = {};
            if (dds_take_instance(kept, &last, &last_info, 1, 1, info.instance_handle) > 0)
            {
                dds_return_loan(kept, &last, 1);
            }
        });
}

/// Calls `visit(about, info)` with the participant's data in DDS; no call if it is unknown.
template <typename Visit>
void read_participant(std::int32_t reader, const ParticipantId& who, Visit&& visit)
{
    dds_builtintopic_participant_t key = {};
    std::memcpy(static_cast<std::uint8_t*>(key.key.v), who.data(), who.size());
    const dds_instance_handle_t handle = dds_lookup_instance(reader, &key);
    void* sample = nullptr;
    dds_sample_info_t info = {};
    if (handle != DDS_HANDLE_NIL && dds_read_instance(reader, &sample, &info, 1, 1, handle) == 1)
    {
        visit(*static_cast<const dds_builtintopic_participant_t*>(sample), info);
        dds_return_loan(reader, &sample, 1);
    }
}

std::string property(const dds_qos_t* qos, const char* name)
{
    char* value = nullptr;
    std::string text;
    if (qos != nullptr && dds_qget_prop(qos, name, &value) && value != nullptr)
    {
        text = printable(value);
        dds_free(value);
    }
    return text;
}

/// Protocol version in the name of a topic; none for a topic of another program.
std::optional<std::string> version_of(const char* topic)
{
    std::string_view name(topic == nullptr ? "" : topic);
    if (!name.starts_with(kTopicRoot))
    {
        return std::nullopt;
    }
    name.remove_prefix(kTopicRoot.size());
    return printable(name.substr(0, std::min<std::size_t>(name.find('/'), 8)));
}

} // namespace

std::uint64_t server_epoch_of(const ParticipantId& participant) noexcept
{
    const ContentHash hash = content_hash(std::as_bytes(std::span(participant)));
    std::uint64_t epoch = 0;
    std::memcpy(&epoch, hash.data(), sizeof(epoch));
    return epoch;
}

Participants::Participants(std::int32_t participant)
    : writers_(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr))
    , participants_(
          dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr))
    , writer_news_(
          dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr))
    , participant_news_(
          dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr))
{
    dds_guid_t guid = {};
    dds_get_guid(participant, &guid);
    own_ = id_of(guid);
    own_epoch_ = server_epoch_of(own_);
}

std::optional<ParticipantId> Participants::writer_of(std::uint64_t publication_handle)
{
    const std::lock_guard lock(mutex_);
    if (const auto known = known_.find(publication_handle); known != known_.end())
    {
        return known->second;
    }
    void* sample = nullptr;
    dds_sample_info_t info = {};
    if (dds_read_instance(writers_, &sample, &info, 1, 1, publication_handle) != 1)
    {
        return std::nullopt;
    }
    std::optional<ParticipantId> owner;
    if (info.valid_data)
    {
        owner = id_of(static_cast<const dds_builtintopic_endpoint_t*>(sample)->participant_key);
    }
    dds_return_loan(writers_, &sample, 1);
    if (owner)
    {
        if (known_.size() == kMaxKnown)
        {
            known_.erase(known_.begin());
        }
        known_.emplace(publication_handle, *owner);
    }
    return owner;
}

bool Participants::is_server(std::uint64_t publication_handle, std::uint64_t server_epoch)
{
    const auto writer = writer_of(publication_handle);
    return writer && server_epoch_of(*writer) == server_epoch;
}

bool Participants::has_any_of(const std::set<std::string>& certificates) const
{
    return !certificates.empty() &&
           std::ranges::any_of(here_,
                               [&](const auto& participant) {
                                   return participant.first != own_ &&
                                          certificates.contains(certificate_of(participant.first));
                               });
}

void Participants::refuse(std::uint64_t publication_handle, Refused reason, std::uint32_t number)
{
    if (const auto writer = writer_of(publication_handle))
    {
        refusals_.count(*writer, reason, number);
    }
}

void Participants::report(RateLimitedLog& log)
{
    report_other_versions(log);
    report_crowds(log);
    refusals_.report(log, [this](const ParticipantId& who) { return name_of(who); });
}

void Participants::report_other_versions(RateLimitedLog& log)
{
    const std::string ours = std::to_string(kProtocolVersion);
    take_news<dds_builtintopic_endpoint_t>(
        writer_news_, writers_,
        [&](const dds_builtintopic_endpoint_t& writer)
        {
            const auto version = version_of(writer.topic_name);
            const ParticipantId who = id_of(writer.participant_key);
            if (!version || *version == ours || reported_.size() == kMaxKnown ||
                !reported_.insert(who).second)
            {
                return;
            }
            log.write(fmt::format("{} is refused: its protocol version is {}, this build's is {}",
                                  name_of(who), *version, ours));
        },
        [](const dds_builtintopic_endpoint_t&) {});
}

/// Logs processes with many participants. Cyclone keeps a few KB of each until its lease ends, and
/// participants choose their own lease. Cyclone has no limit, so a log line is the only defence.
void Participants::report_crowds(RateLimitedLog& log)
{
    take_news<dds_builtintopic_participant_t>(
        participant_news_, participants_,
        [&](const dds_builtintopic_participant_t& about)
        {
            const ParticipantId who = id_of(about.key);
            if (here_.size() == kMaxKnown || here_.contains(who))
            {
                return;
            }
            const std::string& name = here_.emplace(who, name_of(who)).first->second;
            Crowd& crowd = crowds_[name];
            if (++crowd.count >= crowd.told_at)
            {
                crowd.told_at = 10 * crowd.count;
                log.write(fmt::format("{} has {} participants on this domain", name, crowd.count));
            }
        },
        [&](const dds_builtintopic_participant_t& gone) { forget_participant(id_of(gone.key)); });
    if (here_.size() >= told_at_)
    {
        told_at_ = 10 * here_.size();
        log.write(fmt::format("{} participants are on this domain, and each takes memory until its "
                              "lease ends",
                              here_.size()));
    }
}

void Participants::forget_participant(const ParticipantId& who)
{
    const auto gone = here_.find(who);
    if (gone == here_.end())
    {
        return;
    }
    if (const auto crowd = crowds_.find(gone->second); --crowd->second.count == 0)
    {
        crowds_.erase(crowd);
    }
    here_.erase(gone);
}

bool Participants::is_writing(std::uint64_t publication_handle) const
{
    void* sample = nullptr;
    dds_sample_info_t info = {};
    if (dds_read_instance(writers_, &sample, &info, 1, 1, publication_handle) != 1)
    {
        return false;
    }
    dds_return_loan(writers_, &sample, 1);
    return info.valid_data && info.instance_state == DDS_ALIVE_INSTANCE_STATE;
}

bool Participants::is_resident(const ParticipantId& who) const
{
    bool is_alive = false;
    read_participant(
        participants_, who,
        [&](const dds_builtintopic_participant_t& /*about*/, const dds_sample_info_t& info)
        { is_alive = info.instance_state == DDS_ALIVE_INSTANCE_STATE; });
    return is_alive;
}

std::set<std::string> Participants::names() const
{
    constexpr std::uint32_t kMost = 1'024;
    std::vector<void*> samples(kMost, nullptr);
    std::vector<dds_sample_info_t> infos(kMost);
    const dds_return_t count =
        dds_read_mask(participants_, samples.data(), infos.data(), kMost, kMost,
                      DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ALIVE_INSTANCE_STATE);
    std::set<std::string> names;
    for (dds_return_t i = 0; i < count; ++i)
    {
        const auto at = static_cast<std::size_t>(i);
        const ParticipantId who =
            id_of(static_cast<const dds_builtintopic_participant_t*>(samples[at])->key);
        if (infos[at].valid_data && who != own_)
        {
            names.insert(name_of(who));
        }
    }
    if (count > 0)
    {
        dds_return_loan(participants_, samples.data(), count);
    }
    return names;
}

std::string Participants::name_of(const ParticipantId& who) const
{
    std::string name = "a program that has ended";
    read_participant(
        participants_, who,
        [&](const dds_builtintopic_participant_t& about, const dds_sample_info_t& info)
        {
            const std::string program = info.valid_data ? property(about.qos, "__ProcessName") : "";
            const std::string certificate = certificate_of(who);
            if (!program.empty())
            {
                name = fmt::format("{} (process {} on {}{})", program, property(about.qos, "__Pid"),
                                   property(about.qos, "__Hostname"),
                                   certificate.empty() ? "" : ", cert:" + certificate);
            }
        });
    return name;
}

bool Participants::is_called(const ParticipantId& who, const std::string& server) const
{
    constexpr std::string_view kCertificate = "cert:";
    if (server.starts_with(kCertificate))
    {
        const std::string certificate = certificate_of(who);
        return !certificate.empty() && server.substr(kCertificate.size()) == certificate;
    }
    if (is_protected()) // What a machine says of itself would be a claim.
    {
        const std::string digits = certificate_digits(server); // Empty if the text is too long.
        return !digits.empty() && certificate_of(who) == digits;
    }
    bool is_it = false;
    read_participant(
        participants_, who,
        [&](const dds_builtintopic_participant_t& about, const dds_sample_info_t& info)
        {
            const std::string machine = info.valid_data ? property(about.qos, "__Hostname") : "";
            is_it = server == machine || server == machine + ":" + property(about.qos, "__Pid");
        });
    return is_it;
}

bool Participants::is_protected() const
{
    return is_certified(own_);
}

std::string Participants::certificate_of(const ParticipantId& who) const
{
    constexpr std::size_t kBytes = 6;
    if (!is_protected() || !is_certified(who))
    {
        return {};
    }
    std::string text;
    for (const std::uint8_t byte : std::span(who).first(kBytes))
    {
        text += fmt::format("{:02x}", byte);
    }
    return text;
}

} // namespace tactus::dds
