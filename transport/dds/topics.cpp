// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/topics.hpp"

#include "rt_core/limits.hpp"
#include "transport/content_hash.hpp"

#include <dds/dds.h>
#include <fmt/format.h>

#include <memory>
#include <random>
#include <vector>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// A writer's call may wait this long for room before it gives up.
constexpr std::int64_t kBlockingMax = DDS_MSECS(5);
/// Who says nothing for this long is gone: catalogue (hosts) and wishes (controllers).
constexpr std::int64_t kLiveliness = DDS_MSECS(500);

// The bounds of transport/idl/tactus.idl. When a constant on the right grows, the wire changes with
// it: raise the bound there and the protocol's version.
static_assert(tactus_v1_max_name_bytes == kMaxNameBytes);
static_assert(tactus_v1_max_tools == kMaxTools);
static_assert(tactus_v1_max_objects == kMaxObjects);
static_assert(tactus_v1_max_wishes == kMaxWishes);
static_assert(tactus_v1_max_payload_bytes >= kPayloadBytes);
static_assert(sizeof(tactus_v1_Wanted::controller) == sizeof(ControllerId));
static_assert(sizeof(tactus_v1_Wanted::model_hash) == sizeof(ContentHash));

struct TopicTraits
{
    const char* name;
    const dds_topic_descriptor_t* type;
    bool is_kept_for_late_joiners;
    bool has_liveliness;
    bool is_best_effort; ///< Only the newest counts: what is lost isn't sent again.
    std::int32_t depth;  ///< Samples per instance.
    std::int32_t instances;
};

const TopicTraits& traits_of(Topic topic)
{
    // The depths of wishes and pieces are hardly ever reached: wishes are few and bounded by their
    // kind, pieces are under credit. What one stuck writer of several holds back while the others'
    // counts go on is bounded by its depth alone: what is pushed out of it is asked for again. All
    // are keep-last, so that no writer ever waits for a reader.
    static const std::array<TopicTraits, 6> traits{{
        {"tactus/v1/catalogue", &tactus_v1_CatalogueEntry_desc, true, true, false, 1, 4096},
        {"tactus/v1/model", &tactus_v1_ModelStart_desc, true, false, false, 1, 16},
        {"tactus/v1/wanted", &tactus_v1_Wanted_desc, false, true, false, 16, 4096},
        {"tactus/v1/chunks", &tactus_v1_Pieces_desc, false, false, false, 4 * kCreditPieces, 1},
        {"tactus/v1/poses", &tactus_v1_ObjectPose_desc, false, false, true, 1, 4096},
        {"tactus/v1/telemetry", &tactus_v1_Telemetry_desc, false, true, true, 1, 256},
    }};
    return traits[static_cast<std::size_t>(topic)];
}

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

Qos make_qos()
{
    return {dds_create_qos(), &dds_delete_qos};
}

Qos endpoint_qos(const TopicTraits& traits)
{
    Qos qos = make_qos();
    dds_qset_reliability(
        qos.get(), traits.is_best_effort ? DDS_RELIABILITY_BEST_EFFORT : DDS_RELIABILITY_RELIABLE,
        kBlockingMax);
    dds_qset_durability(qos.get(), traits.is_kept_for_late_joiners ? DDS_DURABILITY_TRANSIENT_LOCAL
                                                                   : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, traits.depth);
    const std::int32_t samples = traits.depth * traits.instances;
    dds_qset_resource_limits(qos.get(), samples, traits.instances, traits.depth);
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, traits.depth, samples,
                                traits.instances, traits.depth);
    return qos;
}

std::int32_t find_or_create_topic(const Domain& domain, const TopicTraits& traits)
{
    return dds_create_topic(domain.participant(), traits.type, traits.name, nullptr, nullptr);
}

Refusal refused(const TopicTraits& traits, std::int32_t code)
{
    return {fmt::format("DDS topic {} cannot be used: {}", traits.name, dds_strretcode(code))};
}

Qos partition_qos(std::span<const std::string> partitions)
{
    Qos qos = make_qos();
    std::vector<const char*> names;
    for (const std::string& partition : partitions)
    {
        names.push_back(partition.c_str());
    }
    dds_qset_partition(qos.get(), static_cast<std::uint32_t>(names.size()), names.data());
    return qos;
}

} // namespace

Result<Endpoint, Refusal> make_writer(const Domain& domain, Topic topic,
                                      const std::string& partition)
{
    const TopicTraits& traits = traits_of(topic);
    const Entity type(find_or_create_topic(domain, traits)); // The writer keeps it in use.
    if (!type.is_valid())
    {
        return refused(traits, type.get());
    }
    const Qos parent_qos = partition_qos({&partition, 1});
    const Qos qos = endpoint_qos(traits);
    if (traits.has_liveliness)
    {
        dds_qset_liveliness(qos.get(), DDS_LIVELINESS_AUTOMATIC, kLiveliness);
    }
    Endpoint writer;
    writer.parent = Entity(dds_create_publisher(domain.participant(), parent_qos.get(), nullptr));
    writer.handle = dds_create_writer(writer.parent.get(), type.get(), qos.get(), nullptr);
    if (!writer.is_valid())
    {
        return refused(traits, writer.handle);
    }
    return writer;
}

Result<Endpoint, Refusal> make_reader(const Domain& domain, Topic topic,
                                      std::span<const std::string> partitions)
{
    const TopicTraits& traits = traits_of(topic);
    const Entity type(find_or_create_topic(domain, traits));
    if (!type.is_valid())
    {
        return refused(traits, type.get());
    }
    const Qos parent_qos = partition_qos(partitions);
    const Qos qos = endpoint_qos(traits);
    Endpoint reader;
    reader.parent = Entity(dds_create_subscriber(domain.participant(), parent_qos.get(), nullptr));
    reader.handle = dds_create_reader(reader.parent.get(), type.get(), qos.get(), nullptr);
    if (!reader.is_valid())
    {
        return refused(traits, reader.handle);
    }
    return reader;
}

std::string model_partition(const ContentHash& model)
{
    return hash_text(model);
}

std::string controller_partition(const ControllerId& controller, const ContentHash& model)
{
    return hash_text(controller) + "." + hash_text(model);
}

std::uint64_t random_bits()
{
    std::random_device system;
    return (std::uint64_t{system()} << 32U) | system();
}

ControllerId random_controller()
{
    const std::array<std::uint64_t, 2> bits{random_bits(), random_bits()};
    ControllerId id{};
    std::memcpy(id.data(), bits.data(), id.size());
    return id;
}

bool is_matched(const Endpoint& writer)
{
    dds_publication_matched_status_t status = {};
    return dds_get_publication_matched_status(writer.handle, &status) == DDS_RETCODE_OK &&
           status.current_count > 0;
}

bool has_publisher(const Endpoint& reader)
{
    dds_subscription_matched_status_t status = {};
    return dds_get_subscription_matched_status(reader.handle, &status) == DDS_RETCODE_OK &&
           status.current_count > 0;
}

} // namespace tactus::dds
