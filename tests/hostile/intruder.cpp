// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// intruder DOMAIN KEYS LIBRARY read|write PARTITION SECONDS: opens a reader, or a writer, of each
/// topic in that partition, and prints for each a line
///
///     TOPIC matched PEERS samples COUNT      or      TOPIC refused
///
/// KEYS is an unchecked folder of tactus-keys, or "-" for none. LIBRARY is the plugin of access
/// control, or "-" for Cyclone's. Exits with 2 if the domain can't be joined.

#include "rt_core/limits.hpp"
#include "transport/dds/key_folder.hpp"
#include "transport/dds/topics.hpp"

#include <dds/dds.h>
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "tactus.h"

namespace
{

using namespace tactus;

struct Spied
{
    const char* name;
    const dds_topic_descriptor_t* type;
    dds_entity_t endpoint{0};
    std::size_t samples{0};
};

std::array<Spied, 6> topics{{{"catalogue", &tactus_v5_CatalogueEntry_desc},
                             {"objects", &tactus_v5_ObjectRecord_desc},
                             {"motion", &tactus_v5_Motion_desc},
                             {"wanted", &tactus_v5_Wanted_desc},
                             {"chunks", &tactus_v5_Pieces_desc},
                             {"telemetry", &tactus_v5_Telemetry_desc}}};

dds_entity_t join(std::uint32_t domain, const std::string& keys, const std::string& library)
{
    dds_qos_t* qos = dds_create_qos();
    if (keys != "-")
    {
        dds::protect(qos, {keys, {}, {}});
    }
    if (library != "-")
    {
        dds_qset_prop(qos, "dds.sec.access.library.path", library.c_str());
    }
    const dds_entity_t participant = dds_create_participant(domain, qos, nullptr);
    dds_delete_qos(qos);
    return participant;
}

/// The reader requests the least QoS, the writer offers the most.
void open(Spied& topic, dds_entity_t participant, dds_entity_t parent, bool writes)
{
    const std::string name = fmt::format("tactus/v{}/{}", dds::kProtocolVersion, topic.name);
    const dds_entity_t type =
        dds_create_topic(participant, topic.type, name.c_str(), nullptr, nullptr);
    dds_qos_t* qos = dds_create_qos();
    if (writes)
    {
        dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(5));
        dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
        dds_qset_liveliness(qos, DDS_LIVELINESS_AUTOMATIC, DDS_MSECS(500));
    }
    topic.endpoint = writes ? dds_create_writer(parent, type, qos, nullptr)
                            : dds_create_reader(parent, type, qos, nullptr);
    dds_delete_qos(qos);
}

void take(Spied& topic)
{
    constexpr std::uint32_t kMost = 64;
    std::array<void*, kMost> samples{};
    std::array<dds_sample_info_t, kMost> infos{};
    const dds_return_t count = dds_take(topic.endpoint, samples.data(), infos.data(), kMost, kMost);
    for (dds_return_t i = 0; i < count; ++i)
    {
        topic.samples += infos[static_cast<std::size_t>(i)].valid_data ? 1U : 0U;
    }
    if (count > 0)
    {
        dds_return_loan(topic.endpoint, samples.data(), count);
    }
}

std::uint32_t peers_of(const Spied& topic, bool writes)
{
    dds_publication_matched_status_t read{};
    dds_subscription_matched_status_t written{};
    if (writes)
    {
        dds_get_publication_matched_status(topic.endpoint, &read);
        return read.total_count;
    }
    dds_get_subscription_matched_status(topic.endpoint, &written);
    return written.total_count;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 7)
    {
        return 3;
    }
    const dds_entity_t participant =
        join(static_cast<std::uint32_t>(std::atoi(argv[1])), argv[2], argv[3]);
    if (participant < 0)
    {
        std::fprintf(stderr, "intruder: %s\n", dds_strretcode(participant));
        return 2;
    }
    const bool writes = std::string(argv[4]) == "write";
    dds_qos_t* qos = dds_create_qos();
    const char* partition = argv[5];
    dds_qset_partition(qos, 1, &partition);
    const dds_entity_t parent = writes ? dds_create_publisher(participant, qos, nullptr)
                                       : dds_create_subscriber(participant, qos, nullptr);
    for (Spied& topic : topics)
    {
        open(topic, participant, parent, writes);
    }
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(std::atoi(argv[6]));
    while (std::chrono::steady_clock::now() < end)
    {
        for (Spied& topic : topics)
        {
            if (!writes && topic.endpoint > 0)
            {
                take(topic);
            }
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    for (const Spied& topic : topics)
    {
        fmt::print("{}", topic.endpoint < 0 ? fmt::format("{} refused\n", topic.name)
                                            : fmt::format("{} matched {} samples {}\n", topic.name,
                                                          peers_of(topic, writes), topic.samples));
    }
    dds_delete(participant);
    return 0;
}
