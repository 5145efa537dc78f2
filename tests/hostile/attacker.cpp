// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// attacker DOMAIN SECONDS ATTACK: a stranger on a domain where a host and a controller are. It
/// needs no rights and nothing of ours but the topics' types. Waits until it has seen both, then
/// does one thing again and again for so long, and tells how often. Exits 2 when it saw nobody.

#include "transport/dds/participants.hpp"

#include <dds/dds.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <thread>

#include "tactus.h"

namespace
{

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kPatience = 10s;

std::int32_t checked(std::int32_t handle)
{
    if (handle < 0)
    {
        std::fprintf(stderr, "attacker: %s\n", dds_strretcode(-handle));
        std::exit(2);
    }
    return handle;
}

class Attacker
{
public:
    explicit Attacker(std::uint32_t domain)
        : participant_(checked(dds_create_participant(domain, nullptr, nullptr)))
        , catalogue_(reader("tactus/v2/catalogue", tactus_v2_CatalogueEntry_desc))
        , wanted_(reader("tactus/v2/wanted", tactus_v2_Wanted_desc))
    {
        dds_guid_t guid = {};
        dds_get_guid(participant_, &guid);
        std::memcpy(own_.data(), static_cast<const std::uint8_t*>(guid.v), own_.size());
    }
    ~Attacker() { dds_delete(participant_); }
    Attacker(const Attacker&) = delete;
    Attacker& operator=(const Attacker&) = delete;

    /// Whether a host and a controller that speaks to it were seen.
    bool sees_both()
    {
        const auto end = Clock::now() + kPatience;
        while (Clock::now() < end && (host.host_epoch == 0 || victim.host_epoch == 0))
        {
            take(catalogue_, host);
            take(wanted_, victim);
            std::this_thread::sleep_for(5ms);
        }
        return host.host_epoch != 0 && victim.host_epoch != 0;
    }

    /// As the honest ones are, so that all readers match.
    [[nodiscard]] std::int32_t writer(const char* topic, const dds_topic_descriptor_t& type,
                                      const std::string& partition, bool best_effort = false) const
    {
        dds_qos_t* qos = dds_create_qos();
        const char* name = partition.c_str();
        dds_qset_partition(qos, 1, &name);
        const auto publisher = checked(dds_create_publisher(participant_, qos, nullptr));
        dds_reset_qos(qos);
        dds_qset_reliability(qos,
                             best_effort ? DDS_RELIABILITY_BEST_EFFORT : DDS_RELIABILITY_RELIABLE,
                             DDS_MSECS(5));
        dds_qset_durability(qos,
                            best_effort ? DDS_DURABILITY_VOLATILE : DDS_DURABILITY_TRANSIENT_LOCAL);
        dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 16);
        const auto of = checked(dds_create_topic(participant_, &type, topic, nullptr, nullptr));
        const auto made = checked(dds_create_writer(publisher, of, qos, nullptr));
        dds_delete_qos(qos);
        std::this_thread::sleep_for(200ms); // Until it is known.
        return made;
    }
    [[nodiscard]] std::string host_partition() const
    {
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "host.%016llx",
                      static_cast<unsigned long long>(host.host_epoch));
        return text.data();
    }
    [[nodiscard]] std::string victim_name() const
    {
        return static_cast<const char*>(victim.controller_name);
    }
    /// Under which the others' filters believe us to be a host.
    [[nodiscard]] std::uint64_t own_epoch() const { return tactus::dds::host_epoch_of(own_); }
    [[nodiscard]] const std::array<std::uint8_t, 16>& own() const { return own_; }

    tactus_v2_CatalogueEntry host{}; ///< What was seen.
    tactus_v2_Wanted victim{};

private:
    std::int32_t reader(const char* topic, const dds_topic_descriptor_t& type) const
    {
        dds_qos_t* qos = dds_create_qos();
        const char* everywhere = "*";
        dds_qset_partition(qos, 1, &everywhere);
        const auto subscriber = checked(dds_create_subscriber(participant_, qos, nullptr));
        dds_reset_qos(qos);
        dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(5));
        const auto of = checked(dds_create_topic(participant_, &type, topic, nullptr, nullptr));
        const auto made = checked(dds_create_reader(subscriber, of, qos, nullptr));
        dds_delete_qos(qos);
        return made;
    }
    /// Without what is behind pointers.
    template <typename Sample>
    static void take(std::int32_t reader, Sample& out)
    {
        void* sample = nullptr;
        dds_sample_info_t info = {};
        while (dds_take(reader, &sample, &info, 1, 1) == 1)
        {
            out = info.valid_data ? *static_cast<const Sample*>(sample) : out;
            dds_return_loan(reader, &sample, 1);
            sample = nullptr;
        }
    }

    std::int32_t participant_;
    std::int32_t catalogue_;
    std::int32_t wanted_;
    std::array<std::uint8_t, 16> own_{};
};

/// Returns what is done again and again.
using Attack = std::function<std::function<void(std::uint64_t turn)>(Attacker&)>;

tactus_v2_Placement placement(double x_m)
{
    tactus_v2_Placement place = {};
    place.rotation[3] = 1.0;
    place.translation_m[0] = x_m;
    place.scale = 1.0;
    return place;
}

/// The first object stands where it stood, or farther along x by `x_m` every other time.
Attack move_object(std::uint64_t serial, double x_m)
{
    return [=](Attacker& self)
    {
        const auto motion =
            self.writer("tactus/v2/motion", tactus_v2_Motion_desc, self.host_partition(), true);
        const auto records =
            self.writer("tactus/v2/objects", tactus_v2_ObjectRecord_desc, self.host_partition());
        return [=, &self](std::uint64_t turn)
        {
            tactus_v2_MovedObject moved{0, 1, placement(turn % 2 == 0 ? x_m : 0.0)};
            tactus_v2_Motion sample = {};
            sample.host_epoch = self.host.host_epoch;
            sample.serial = serial == 0 ? 1'000'000 + turn : serial;
            sample.host_time_ns = static_cast<std::int64_t>(turn) * 4'000'000;
            sample.objects = 1;
            sample.moved = {1, 1, &moved, false};
            dds_write(motion, &sample);
            tactus_v2_ObjectRecord record = {};
            record.host_epoch = self.host.host_epoch;
            record.generation = 1;
            record.serial = sample.serial;
            std::strcpy(static_cast<char*>(record.name), "false");
            std::memcpy(record.model_hash, self.host.model_hash, sizeof(record.model_hash));
            record.pose = moved.pose;
            dds_write(records, &record);
        };
    };
}

Attack dispose_catalogue()
{
    return [](Attacker& self)
    {
        const auto writer = self.writer("tactus/v2/catalogue", tactus_v2_CatalogueEntry_desc, "");
        return [=, &self](std::uint64_t) { dds_dispose(writer, &self.host); };
    };
}

/// The host's entry with another hash.
Attack forge_catalogue()
{
    return [](Attacker& self)
    {
        const auto writer = self.writer("tactus/v2/catalogue", tactus_v2_CatalogueEntry_desc, "");
        return [=, &self](std::uint64_t)
        {
            tactus_v2_CatalogueEntry entry = self.host;
            entry.model_hash[0] ^= 1U;
            dds_write(writer, &entry);
        };
    };
}

/// Models of many names, under the host's epoch and our own.
Attack spam_catalogue()
{
    return [](Attacker& self)
    {
        const auto writer = self.writer("tactus/v2/catalogue", tactus_v2_CatalogueEntry_desc, "");
        return [=, &self](std::uint64_t turn)
        {
            tactus_v2_CatalogueEntry entry = self.host;
            std::snprintf(static_cast<char*>(entry.name), sizeof(entry.name), "bogus-%llu",
                          static_cast<unsigned long long>(turn));
            entry.model = static_cast<std::uint32_t>(turn);
            dds_write(writer, &entry);
            entry.host_epoch = self.own_epoch();
            dds_write(writer, &entry);
        };
    };
}

/// Controllers of many ids: of the host's epoch, or of another one.
Attack spam_wanted(bool right_epoch)
{
    return [=](Attacker& self)
    {
        const auto writer = self.writer("tactus/v2/wanted", tactus_v2_Wanted_desc, "stranger");
        return [=, &self](std::uint64_t turn)
        {
            tactus_v2_Wanted wanted = {};
            std::memcpy(wanted.controller, self.own().data(), self.own().size());
            std::memcpy(wanted.controller, &turn, sizeof(turn));
            wanted.host_epoch = self.host.host_epoch + (right_epoch ? 0 : 1 + turn);
            wanted.granted = 128;
            std::strcpy(static_cast<char*>(wanted.controller_name), "stranger");
            dds_write(writer, &wanted);
        };
    };
}

/// Wishes in the victim's name, with credit without end.
Attack forge_wanted()
{
    return [](Attacker& self)
    {
        const auto writer =
            self.writer("tactus/v2/wanted", tactus_v2_Wanted_desc, self.victim_name());
        return [=, &self](std::uint64_t turn)
        {
            std::array<tactus_v2_PieceName, 200> names{};
            for (std::uint32_t i = 0; i < names.size(); ++i)
            {
                names.at(i) = {0, 2, i};
            }
            tactus_v2_Wanted wanted = self.victim;
            wanted.generation = static_cast<std::uint32_t>(1'000'000 + turn);
            wanted.seen = wanted.received = 0;
            wanted.granted = UINT64_MAX;
            wanted.pieces = {200, 200, names.data(), false};
            dds_write(writer, &wanted);
        };
    };
}

Attack dispose_wanted()
{
    return [](Attacker& self)
    {
        const auto writer =
            self.writer("tactus/v2/wanted", tactus_v2_Wanted_desc, self.victim_name());
        return [=, &self](std::uint64_t)
        {
            tactus_v2_Wanted wanted = self.victim;
            wanted.pieces = {};
            dds_dispose(writer, &wanted);
        };
    };
}

struct Habit
{
    Attack attack;
    std::chrono::microseconds every;
};

const std::map<std::string, Habit>& habits()
{
    static const std::map<std::string, Habit> all{
        {"pose_lock", {move_object(UINT64_MAX, 0.0), 100ms}},
        {"pose_swing", {move_object(0, 0.005), 4ms}},
        {"catalogue_disposed", {dispose_catalogue(), 50ms}},
        {"catalogue_forged", {forge_catalogue(), 50ms}},
        {"catalogue_flooded", {spam_catalogue(), 200us}},
        {"wanted_flooded", {spam_wanted(true), 200us}},
        {"wanted_flooded_epochs", {spam_wanted(false), 200us}},
        {"wanted_forged", {forge_wanted(), 5ms}},
        {"wanted_disposed", {dispose_wanted(), 50ms}},
    };
    return all;
}

} // namespace

int main(int argc, char** argv)
{
    const auto habit = argc == 4 ? habits().find(argv[3]) : habits().end();
    if (habit == habits().end())
    {
        std::fprintf(stderr, "attacker DOMAIN SECONDS ATTACK; attacks:");
        for (const auto& [name, unused] : habits())
        {
            std::fprintf(stderr, " %s", name.c_str());
        }
        std::fprintf(stderr, "\n");
        return 3;
    }
    Attacker attacker(static_cast<std::uint32_t>(std::atoi(argv[1])));
    if (!attacker.sees_both())
    {
        std::fprintf(stderr, "attacker: saw no host and controller\n");
        return 2;
    }
    const auto act = habit->second.attack(attacker);
    const auto end = Clock::now() + std::chrono::seconds(std::atoi(argv[2]));
    std::uint64_t turn = 0;
    for (; Clock::now() < end; ++turn)
    {
        act(turn);
        std::this_thread::sleep_for(habit->second.every);
    }
    std::printf("done %llu times\n", static_cast<unsigned long long>(turn));
    return 0;
}
