// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/scene_reader.hpp"

#include "transport/content_hash.hpp"
#include "transport/dds/take.hpp"
#include "transport/dds/wire_values.hpp"
#include "transport/model_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// Maximum numbers of samples taken in one poll; further ones wait in the readers.
constexpr std::size_t kRecordsPerPoll = 1'024;
constexpr std::size_t kMotionPerPoll = 128;
/// Time after the admission at which a server's objects count as complete, even if some are
/// missing.
constexpr auto kCompleteMax = std::chrono::seconds(2);
/// Time in which a server must announce the model of an object; models are announced every second.
constexpr auto kServedMax = std::chrono::seconds(2);
/// Time after which the number of objects that a server sends includes its earlier removals.
constexpr auto kDispute = std::chrono::milliseconds(40);
/// Time without motion, sent every 20 ms, after which the server is asked for another writer.
constexpr auto kMotionLost = std::chrono::milliseconds(300);

} // namespace

Result<SeenObject, Refused> object_from(const tactus_v5_ObjectRecord& record)
{
    SeenObject object;
    object.server_epoch = record.server_epoch;
    object.number = record.object;
    object.generation = record.generation;
    object.shown.name = text_of(record.name);
    std::memcpy(object.shown.model.data(), record.model_hash, object.shown.model.size());
    object.shown.material = material_of(record);
    if (!is_valid_name(object.shown.name))
    {
        return Refused::object_name;
    }
    if (!is_sound(object.shown.material))
    {
        return Refused::object_material;
    }
    return object;
}

std::uint64_t PoseCounts::refused_in_all() const noexcept
{
    return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
}

void SceneReader::poll(std::span<const std::uint64_t> servers, const Take& take)
{
    for (auto server = servers_.begin(); server != servers_.end();)
    {
        if (std::ranges::find(servers, server->first) != servers.end())
        {
            ++server;
            continue;
        }
        while (!server->second.objects.empty())
        {
            remove(server->second, server->second.objects.begin()->first, take);
        }
        exchange_.leave_objects(server->first);
        server = servers_.erase(server);
    }
    for (const std::uint64_t epoch : servers)
    {
        Server& server = servers_[epoch];
        watch(epoch, server);
        if (!server.motion.is_valid())
        {
            join(epoch, server);
            continue;
        }
        take_records(epoch, server, take);
        take_motion(epoch, server, take);
        check_strangers(epoch, server, take);
        if (!server.is_complete && Clock::now() - server.since > kCompleteMax)
        {
            server.is_complete = true; // The missing objects may never arrive.
        }
        if (server.is_complete)
        {
            drop_unconfirmed(server, take);
            exchange_.report_objects_received(epoch, server.objects.empty() ||
                                                         Clock::now() - server.heard < kMotionLost);
        }
    }
}

bool SceneReader::was_heard(std::uint64_t server_epoch) const
{
    const auto server = servers_.find(server_epoch);
    return server != servers_.end() && server->second.was_heard;
}

bool SceneReader::is_complete(std::uint64_t server_epoch) const
{
    const auto server = servers_.find(server_epoch);
    return server != servers_.end() && server->second.is_complete;
}

const std::map<std::uint32_t, SeenObject>& SceneReader::objects(std::uint64_t server_epoch) const
{
    static const std::map<std::uint32_t, SeenObject> none;
    const auto server = servers_.find(server_epoch);
    return server == servers_.end() ? none : server->second.objects;
}

void SceneReader::join(std::uint64_t epoch, Server& server)
{
    exchange_.ask_for_objects(epoch);
    if (!exchange_.is_admitted(epoch))
    {
        return;
    }
    auto records = make_reader(domain_, Topic::objects, server_partition(epoch));
    auto motion = make_reader(domain_, Topic::motion, server_partition(epoch));
    if (!records || !motion)
    {
        fault_ = records ? motion.error().text : records.error().text;
        return;
    }
    server.records = std::move(records).value();
    server.motion = std::move(motion).value();
    server.since = server.heard = Clock::now();
}

/// Replaces the readers when a server returns, since the old ones miss removals during its absence.
void SceneReader::watch(std::uint64_t epoch, Server& server)
{
    const bool was_gone = std::exchange(server.is_gone, !exchange_.catalogue().has_server(epoch));
    if (!was_gone || server.is_gone || !server.motion.is_valid())
    {
        return;
    }
    server.records = {};
    server.motion = {};
    server.motion_writer = 0;
    server.disputed.clear();
    server.strangers.clear();
    server.is_complete = false;
    for (const auto& [number, object] : server.objects)
    {
        server.unconfirmed.insert(number);
    }
    exchange_.leave_objects(epoch);
}

void SceneReader::drop_unconfirmed(Server& server, const Take& take)
{
    for (const std::uint32_t number : std::exchange(server.unconfirmed, {}))
    {
        remove(server, number, take);
    }
}

void SceneReader::take_records(std::uint64_t epoch, Server& server, const Take& take)
{
    std::map<std::uint64_t, bool> writers; // Cache of is_writing() for this call.
    const auto is_there = [&](std::uint64_t writer)
    {
        const auto [known, is_new] = writers.try_emplace(writer, false);
        known->second = is_new ? domain_.participants().is_writing(writer) : known->second;
        return known->second;
    };
    take_each<tactus_v5_ObjectRecord>(
        server.records.handle, kRecordsPerPoll,
        [&](const tactus_v5_ObjectRecord& record, const dds_sample_info_t& info)
        {
            if (info.valid_data)
            {
                if (const auto refused = take_record(server, record, take))
                {
                    domain_.participants().refuse(info.publication_handle, *refused, record.object);
                }
            }
            if (info.instance_state == DDS_ALIVE_INSTANCE_STATE)
            {
                server.disputed.erase(record.object);
            }
            else if (!tells_end(info))
            {
                server.disputed.emplace(record.object, Clock::now());
            }
            else if (domain_.participants().is_server(info.publication_handle, epoch))
            {
                if (!is_there(info.publication_handle))
                {
                    return; // The server left; its objects stay.
                }
                server.disputed.erase(record.object);
                server.strangers.erase(record.object);
                remove(server, record.object, take);
            }
            else
            {
                domain_.participants().refuse(info.publication_handle, Refused::identity);
            }
        });
}

/// Processes one record; returns a reason if it is refused.
std::optional<Refused>
SceneReader::take_record(Server& server, const tactus_v5_ObjectRecord& record, const Take& take)
{
    auto read = object_from(record);
    if (!read)
    {
        return read.error();
    }
    SeenObject news = std::move(read).value();
    server.unconfirmed.erase(record.object);
    const auto known = server.objects.find(record.object);
    if (known != server.objects.end() && known->second.generation == record.generation)
    {
        if (record.serial > known->second.serial &&
            try_move(known->second, record.serial, record.pose))
        {
            take(SceneNews::moves, known->second);
        }
        if (news.shown.material != known->second.shown.material)
        {
            known->second.shown.material = news.shown.material;
            take(SceneNews::feels, known->second);
        }
        return std::nullopt;
    }
    if (!try_move(news, record.serial, record.pose))
    {
        return Refused::object_pose;
    }
    remove(server, record.object, take);
    if (exchange_.catalogue().find(news.shown.model, news.server_epoch) == nullptr)
    {
        Stranger& stranger = server.strangers[record.object];
        const bool is_new = stranger.object.generation != news.generation;
        stranger = is_new ? Stranger{news, Clock::now()}
                          : Stranger{news, stranger.since, stranger.is_told};
        return is_new ? std::optional(Refused::not_served) : std::nullopt;
    }
    server.strangers.erase(record.object);
    take(SceneNews::comes, server.objects.emplace(record.object, std::move(news)).first->second);
    return std::nullopt;
}

/// Resets the serial numbers if the writer changed, since a forged packet of the last writer may
/// have raised them.
void SceneReader::begin_with(Server& server, std::uint64_t writer)
{
    if (server.motion_writer == 0 || server.motion_writer == writer)
    {
        return;
    }
    server.motion_serial = 0;
    for (auto& [number, object] : server.objects)
    {
        object.serial = 0;
    }
}

/// Records new motion, and logs if it was lost before. A packet with a much later sample number in
/// a writer's name makes Cyclone drop the writer's other samples.
void SceneReader::note_motion(std::uint64_t epoch, Server& server, std::uint64_t writer)
{
    const auto now = Clock::now();
    const auto silent = std::chrono::duration_cast<std::chrono::milliseconds>(now - server.heard);
    const bool is_other = server.motion_writer != 0 && server.motion_writer != writer;
    if (is_other && silent >= kMotionLost)
    {
        ++motion_regained_;
        log_.write(fmt::format("motion of server {:016x} was lost for {} ms by a forged packet or "
                               "a long stall; another writer sends it now",
                               epoch, silent.count()));
    }
    server.heard = now;
    server.motion_writer = writer;
    server.was_heard = true;
}

void SceneReader::take_motion(std::uint64_t epoch, Server& server, const Take& take)
{
    server.was_heard = false;
    take_each<tactus_v5_Motion>(
        server.motion.handle, kMotionPerPoll,
        [&](const tactus_v5_Motion& motion, const dds_sample_info_t& info)
        {
            if (!info.valid_data)
            {
                return;
            }
            begin_with(server, info.publication_handle);
            bool is_news = motion.serial > server.motion_serial;
            for (std::uint32_t i = 0; i < motion.moved._length; ++i)
            {
                const tactus_v5_MovedObject& moved = motion.moved._buffer[i];
                const auto known = server.objects.find(moved.object);
                if (known == server.objects.end() || known->second.generation != moved.generation)
                {
                    // The object has no record yet, was removed or replaced, or is a stranger.
                    continue;
                }
                SeenObject& object = known->second;
                is_news = is_news && motion.serial > object.serial;
                if (try_move(object, motion.serial, moved.pose))
                {
                    object.server_time_ns = motion.server_time_ns;
                    take(SceneNews::moves, object);
                }
            }
            // Old samples count as silence, so that another writer is requested in the end.
            if (is_news)
            {
                server.motion_serial = motion.serial;
                note_motion(epoch, server, info.publication_handle);
            }
            settle_disputed(server, motion.objects, take);
            server.is_complete = server.is_complete || server.known() >= motion.objects;
        });
}

/// Removes disputed objects if more objects are known than the server's count `objects`.
void SceneReader::settle_disputed(Server& server, std::uint32_t objects, const Take& take)
{
    const auto now = Clock::now();
    for (auto at = server.disputed.begin(); at != server.disputed.end();)
    {
        const auto [number, since] = *at;
        if (now - since < kDispute)
        {
            ++at;
            continue;
        }
        at = server.disputed.erase(at);
        if (server.objects.size() + server.strangers.size() > objects)
        {
            server.strangers.erase(number);
            remove(server, number, take);
        }
    }
}

/// Adds strangers whose model is now served, and logs each other one once after kServedMax.
void SceneReader::check_strangers(std::uint64_t epoch, Server& server, const Take& take)
{
    const auto now = Clock::now();
    const Catalogue& catalogue = exchange_.catalogue();
    const bool has_news =
        std::exchange(server.seen_catalogue, catalogue.version()) != catalogue.version();
    for (auto at = server.strangers.begin(); at != server.strangers.end();)
    {
        Stranger& stranger = at->second;
        if (has_news && catalogue.find(stranger.object.shown.model, epoch) != nullptr)
        {
            take(SceneNews::comes,
                 server.objects.emplace(at->first, std::move(stranger.object)).first->second);
            at = server.strangers.erase(at);
            continue;
        }
        if (!stranger.is_told && now - stranger.since > kServedMax)
        {
            stranger.is_told = true;
            log_.write(fmt::format("object '{}' is refused: its server doesn't serve its model, {}",
                                   stranger.object.shown.name,
                                   hash_text(stranger.object.shown.model)));
        }
        ++at;
    }
}

/// Checks a pose and applies it if valid and newer; counts it in any case. True if applied.
bool SceneReader::try_move(SeenObject& object, std::uint64_t serial, const tactus_v5_Placement& to)
{
    const auto refuse = [&](PoseRefusal refusal)
    {
        ++object.counts.refused.at(static_cast<std::size_t>(refusal));
        return false;
    };
    if (serial <= object.serial)
    {
        return refuse(PoseRefusal::not_newer);
    }
    const auto pose = checked_pose(from_wire(to));
    if (!pose)
    {
        return refuse(pose.error());
    }
    ++object.counts.accepted;
    object.shown.pose = pose.value();
    object.serial = serial;
    return true;
}

void SceneReader::remove(Server& server, std::uint32_t number, const Take& take)
{
    const auto known = server.objects.find(number);
    server.unconfirmed.erase(number);
    if (known != server.objects.end())
    {
        const SeenObject last = std::move(known->second);
        server.objects.erase(known);
        take(SceneNews::goes, last);
    }
}

} // namespace tactus::dds
