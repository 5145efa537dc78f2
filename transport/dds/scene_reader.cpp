// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/scene_reader.hpp"

#include "transport/content_hash.hpp"
#include "transport/dds/placement.hpp"
#include "transport/dds/take.hpp"
#include "transport/model_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// Samples taken in one poll; the rest waits for the next.
constexpr std::size_t kRecordsPerPoll = 1'024;
constexpr std::size_t kMotionPerPoll = 128;
/// Time after which the objects of a server count as complete, even if it announced more.
constexpr auto kCompleteMax = std::chrono::seconds(2);
/// Time in which a server announces an object's model: it does so every second.
constexpr auto kServedMax = std::chrono::seconds(2);
/// Delay after which a server's count of objects includes its earlier changes.
constexpr auto kDispute = std::chrono::milliseconds(40);
/// Silence after which a server is asked for another writer of motion; it sends every 20 ms.
constexpr auto kMotionLost = std::chrono::milliseconds(300);

} // namespace

std::uint64_t PoseCounts::refused_in_all() const noexcept
{
    return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
}

void SceneReader::poll(std::span<const std::uint64_t> hosts, const Take& take)
{
    for (auto host = hosts_.begin(); host != hosts_.end();)
    {
        if (std::ranges::find(hosts, host->first) != hosts.end())
        {
            ++host;
            continue;
        }
        while (!host->second.objects.empty())
        {
            remove(host->second, host->second.objects.begin()->first, take);
        }
        exchange_.leave_objects(host->first);
        host = hosts_.erase(host);
    }
    for (const std::uint64_t epoch : hosts)
    {
        Host& host = hosts_[epoch];
        watch(epoch, host);
        if (!host.motion.is_valid())
        {
            join(epoch, host);
            continue;
        }
        take_records(epoch, host, take);
        take_motion(epoch, host, take);
        look_at_strangers(epoch, host, take);
        if (!host.is_complete && Clock::now() - host.since > kCompleteMax)
        {
            host.is_complete = true; // Complete as far as can be known.
        }
        if (host.is_complete)
        {
            drop_unconfirmed(host, take);
            exchange_.tell_objects_are_here(epoch, host.objects.empty() ||
                                                       Clock::now() - host.heard < kMotionLost);
        }
    }
}

bool SceneReader::was_heard(std::uint64_t host_epoch) const
{
    const auto host = hosts_.find(host_epoch);
    return host != hosts_.end() && host->second.was_heard;
}

bool SceneReader::is_complete(std::uint64_t host_epoch) const
{
    const auto host = hosts_.find(host_epoch);
    return host != hosts_.end() && host->second.is_complete;
}

const std::map<std::uint32_t, SeenObject>& SceneReader::objects(std::uint64_t host_epoch) const
{
    static const std::map<std::uint32_t, SeenObject> none;
    const auto host = hosts_.find(host_epoch);
    return host == hosts_.end() ? none : host->second.objects;
}

void SceneReader::join(std::uint64_t epoch, Host& host)
{
    exchange_.ask_for_objects(epoch);
    if (!exchange_.is_let_in(epoch))
    {
        return;
    }
    auto records = make_reader(domain_, Topic::objects, host_partition(epoch));
    auto motion = make_reader(domain_, Topic::motion, host_partition(epoch));
    if (!records || !motion)
    {
        fault_ = records ? motion.error().text : records.error().text;
        return;
    }
    host.records = std::move(records).value();
    host.motion = std::move(motion).value();
    host.since = host.heard = Clock::now();
}

/// Replaces the readers when a server returns: the old ones do not report its removals in the
/// meantime.
void SceneReader::watch(std::uint64_t epoch, Host& host)
{
    const bool was_gone = std::exchange(host.is_gone, !exchange_.catalogue().has_host(epoch));
    if (!was_gone || host.is_gone || !host.motion.is_valid())
    {
        return;
    }
    host.records = {};
    host.motion = {};
    host.motion_writer = 0;
    host.disputed.clear();
    host.strangers.clear();
    host.is_complete = false;
    for (const auto& [number, object] : host.objects)
    {
        host.unconfirmed.insert(number);
    }
    exchange_.leave_objects(epoch);
}

void SceneReader::drop_unconfirmed(Host& host, const Take& take)
{
    for (const std::uint32_t number : std::exchange(host.unconfirmed, {}))
    {
        remove(host, number, take);
    }
}

void SceneReader::take_records(std::uint64_t epoch, Host& host, const Take& take)
{
    std::map<std::uint64_t, bool> writers; // Result by writer, to query each one once a call.
    const auto is_there = [&](std::uint64_t writer)
    {
        const auto [known, is_new] = writers.try_emplace(writer, false);
        known->second = is_new ? domain_.participants().is_writing(writer) : known->second;
        return known->second;
    };
    take_each<tactus_v5_ObjectRecord>(
        host.records.handle, kRecordsPerPoll,
        [&](const tactus_v5_ObjectRecord& record, const dds_sample_info_t& info)
        {
            if (info.valid_data)
            {
                if (const auto refused = take_record(host, record, take))
                {
                    domain_.participants().refuse(info.publication_handle, *refused, record.object);
                }
            }
            if (info.instance_state == DDS_ALIVE_INSTANCE_STATE)
            {
                host.disputed.erase(record.object);
            }
            else if (!tells_end(info))
            {
                host.disputed.emplace(record.object, Clock::now());
            }
            else if (domain_.participants().is_host(info.publication_handle, epoch))
            {
                if (!is_there(info.publication_handle))
                {
                    return; // The writer is gone, not the object.
                }
                host.disputed.erase(record.object);
                host.strangers.erase(record.object);
                remove(host, record.object, take);
            }
            else
            {
                domain_.participants().refuse(info.publication_handle, Refused::identity);
            }
        });
}

/// Processes one record; returns the reason of a refusal, or none.
std::optional<Refused> SceneReader::take_record(Host& host, const tactus_v5_ObjectRecord& record,
                                                const Take& take)
{
    SeenObject news;
    news.host_epoch = record.host_epoch;
    news.number = record.object;
    news.generation = record.generation;
    news.shown.name = text_of(record.name);
    std::memcpy(news.shown.model.data(), record.model_hash, news.shown.model.size());
    news.shown.material = material_of(record);
    if (!is_valid_name(news.shown.name))
    {
        return Refused::object_name;
    }
    if (!is_sound(news.shown.material))
    {
        return Refused::object_material;
    }
    host.unconfirmed.erase(record.object);
    const auto known = host.objects.find(record.object);
    if (known != host.objects.end() && known->second.generation == record.generation)
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
    remove(host, record.object, take);
    if (exchange_.catalogue().find(news.shown.model, news.host_epoch) == nullptr)
    {
        Stranger& stranger = host.strangers[record.object];
        const bool is_new = stranger.object.generation != news.generation;
        stranger = is_new ? Stranger{news, Clock::now()}
                          : Stranger{news, stranger.since, stranger.is_told};
        return is_new ? std::optional(Refused::not_served) : std::nullopt;
    }
    host.strangers.erase(record.object);
    take(SceneNews::comes, host.objects.emplace(record.object, std::move(news)).first->second);
    return std::nullopt;
}

/// Restarts the serial numbers for another writer: a packet in the last one's name may have raised
/// them.
void SceneReader::begin_with(Host& host, std::uint64_t writer)
{
    if (host.motion_writer == 0 || host.motion_writer == writer)
    {
        return;
    }
    host.motion_serial = 0;
    for (auto& [number, object] : host.objects)
    {
        object.serial = 0;
    }
}

/// Records that motion was heard. A packet in a writer's name with a much later sample number makes
/// Cyclone drop all others of that writer.
void SceneReader::hear(std::uint64_t epoch, Host& host, std::uint64_t writer)
{
    const auto now = Clock::now();
    const auto silent = std::chrono::duration_cast<std::chrono::milliseconds>(now - host.heard);
    const bool is_other = host.motion_writer != 0 && host.motion_writer != writer;
    if (is_other && silent >= kMotionLost)
    {
        ++motion_regained_;
        log_.write(fmt::format("motion of host {:016x} was lost for {} ms though it was there, by "
                               "a forged packet or a long stall; another writer tells of it",
                               epoch, silent.count()));
    }
    host.heard = now;
    host.motion_writer = writer;
    host.was_heard = true;
}

void SceneReader::take_motion(std::uint64_t epoch, Host& host, const Take& take)
{
    host.was_heard = false;
    take_each<tactus_v5_Motion>(
        host.motion.handle, kMotionPerPoll,
        [&](const tactus_v5_Motion& motion, const dds_sample_info_t& info)
        {
            if (!info.valid_data)
            {
                return;
            }
            begin_with(host, info.publication_handle);
            bool is_news = motion.serial > host.motion_serial;
            for (std::uint32_t i = 0; i < motion.moved._length; ++i)
            {
                const tactus_v5_MovedObject& moved = motion.moved._buffer[i];
                const auto known = host.objects.find(moved.object);
                if (known == host.objects.end() || known->second.generation != moved.generation)
                {
                    // The object's record is still in transit, or the object is gone or a stranger.
                    continue;
                }
                SeenObject& object = known->second;
                is_news = is_news && motion.serial > object.serial;
                if (try_move(object, motion.serial, moved.pose))
                {
                    object.host_time_ns = motion.host_time_ns;
                    take(SceneNews::moves, object);
                }
            }
            // Samples that are ignored as old count as silence: eventually another writer is
            // requested.
            if (is_news)
            {
                host.motion_serial = motion.serial;
                hear(epoch, host, info.publication_handle);
            }
            settle_disputed(host, motion.objects, take);
            host.is_complete = host.is_complete || host.known() >= motion.objects;
        });
}

/// Removes disputed objects if the server's count of objects confirms it.
void SceneReader::settle_disputed(Host& host, std::uint32_t objects, const Take& take)
{
    const auto now = Clock::now();
    for (auto at = host.disputed.begin(); at != host.disputed.end();)
    {
        const auto [number, since] = *at;
        if (now - since < kDispute)
        {
            ++at;
            continue;
        }
        at = host.disputed.erase(at);
        if (host.objects.size() + host.strangers.size() > objects)
        {
            host.strangers.erase(number);
            remove(host, number, take);
        }
    }
}

/// Adds strangers whose model has become available, and logs each of the others once.
void SceneReader::look_at_strangers(std::uint64_t epoch, Host& host, const Take& take)
{
    const auto now = Clock::now();
    const Catalogue& catalogue = exchange_.catalogue();
    const bool has_news =
        std::exchange(host.seen_catalogue, catalogue.version()) != catalogue.version();
    for (auto at = host.strangers.begin(); at != host.strangers.end();)
    {
        Stranger& stranger = at->second;
        if (has_news && catalogue.find(stranger.object.shown.model, epoch) != nullptr)
        {
            take(SceneNews::comes,
                 host.objects.emplace(at->first, std::move(stranger.object)).first->second);
            at = host.strangers.erase(at);
            continue;
        }
        if (!stranger.is_told && now - stranger.since > kServedMax)
        {
            stranger.is_told = true;
            log_.write(fmt::format("object '{}' is refused: it shows model {}, which its host "
                                   "doesn't serve",
                                   stranger.object.shown.name,
                                   hash_text(stranger.object.shown.model)));
        }
        ++at;
    }
}

/// Applies a pose; true if accepted. Counts it either way.
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

void SceneReader::remove(Host& host, std::uint32_t number, const Take& take)
{
    const auto known = host.objects.find(number);
    host.unconfirmed.erase(number);
    if (known != host.objects.end())
    {
        const SeenObject last = std::move(known->second);
        host.objects.erase(known);
        take(SceneNews::goes, last);
    }
}

} // namespace tactus::dds
