// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/topics.hpp"

#include "rt_core/limits.hpp"
#include "transport/content_hash.hpp"
#include "transport/edit_content.hpp"
#include "transport/refinement_state.hpp"
#include "transport/telemetry.hpp"

#include <dds/dds.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// Longest wait of a write for room in the writer.
constexpr std::int64_t kBlockingMax = DDS_MSECS(5);
/// User data of readers of refinement states, by which writers know them.
constexpr std::string_view kReadsStates = "refinement_state";
/// Silence after which a writer counts as gone (DDS liveliness), for topics with has_liveliness.
constexpr std::int64_t kLiveliness = DDS_MSECS(500);

// Each bound of transport/idl/tactus.idl must equal its constant. If a constant changes, change the
// bound, and raise the version of the protocol.
static_assert(tactus_v5_max_name_bytes == kMaxNameBytes);
static_assert(tactus_v5_max_tools == kMaxTools);
static_assert(tactus_v5_max_models == kMaxShownModels);
static_assert(tactus_v5_max_pairs == kMaxPairs);
static_assert(tactus_v5_max_shown_objects == kMaxShownObjects);
static_assert(tactus_v5_max_requests == kMaxRequests);
static_assert(tactus_v5_max_moved == kMaxMoved);
static_assert(tactus_v5_max_payload_bytes >= kPayloadBytes);
static_assert(tactus_v5_max_hull_vertices == kMaxHullVertices);
static_assert(tactus_v5_max_payload_bytes >= kMaxCodedEditBytes);
static_assert(tactus_v5_max_shape_bytes == kMaxShapeBytes);
static_assert(tactus_v5_max_state_models == kMaxModels);
static_assert(tactus_v5_max_state_pages == kMaxStatePages);
static_assert(tactus_v5_max_state_requests == kMaxStateRequests);
static_assert(tactus_v5_max_state_regions == kMaxStateRegions);
static_assert(kMaxModels <= UINT16_MAX); // Type of PieceName::model.
static_assert(sizeof(tactus_v5_Wanted::controller) == sizeof(ControllerId));
static_assert(sizeof(tactus_v5_CatalogueEntry::model_hash) == sizeof(ContentHash));

struct TopicTraits
{
    const char* name;
    const dds_topic_descriptor_t* type;
    dds_topic_filter_sample_sampleinfo_arg_fn is_honest;
    bool is_kept_for_late_joiners;
    bool has_liveliness;
    bool is_best_effort; ///< True if a lost sample is not sent again.
    std::int32_t depth;  ///< Samples kept for each instance.
};

Participants& participants_of(void* context)
{
    return *static_cast<Participants*>(context);
}

bool refuse(const dds_sample_info_t* info, void* context, Refused reason, std::uint32_t number = 0)
{
    participants_of(context).refuse(info->publication_handle, reason, number);
    return false;
}

/// True if the server that a sample names has sent it; otherwise refuses it.
template <typename Sample>
bool is_of_its_server(const Sample& sample, const dds_sample_info_t* info, void* context)
{
    return participants_of(context).is_server(info->publication_handle, sample.server_epoch) ||
           refuse(info, context, Refused::identity);
}

template <typename Sample>
bool is_of_its_controller(const Sample& sample, const dds_sample_info_t* info, void* context)
{
    const auto writer = participants_of(context).writer_of(info->publication_handle);
    const bool is_it = writer && std::memcmp(static_cast<const std::uint8_t*>(sample.controller),
                                             writer->data(), writer->size()) == 0;
    return is_it || refuse(info, context, Refused::identity);
}

/// True if the numbers of a sample can be; otherwise refuses it. `number` is that of its model or
/// object.
template <typename Sample>
bool has_sound_numbers(const Sample& sample, std::uint32_t number, const dds_sample_info_t* info,
                       void* context)
{
    const auto fault = fault_of(sample);
    return !fault || refuse(info, context, *fault, number);
}

bool is_honest_entry(const void* sample, const dds_sample_info_t* info, void* context)
{
    const auto& entry = *static_cast<const tactus_v5_CatalogueEntry*>(sample);
    return is_of_its_server(entry, info, context) &&
           has_sound_numbers(entry, entry.model, info, context);
}

bool is_honest_record(const void* sample, const dds_sample_info_t* info, void* context)
{
    const auto& record = *static_cast<const tactus_v5_ObjectRecord*>(sample);
    return is_of_its_server(record, info, context) &&
           has_sound_numbers(record, record.object, info, context);
}

bool is_honest_motion(const void* sample, const dds_sample_info_t* info, void* context)
{
    return is_of_its_server(*static_cast<const tactus_v5_Motion*>(sample), info, context);
}

/// Accepts only requests to this process's own server; others would take room in the reader.
bool is_honest_request(const void* sample, const dds_sample_info_t* info, void* context)
{
    const auto& wanted = *static_cast<const tactus_v5_Wanted*>(sample);
    return wanted.server_epoch == participants_of(context).own_epoch() &&
           is_of_its_controller(wanted, info, context);
}

bool is_honest_pieces(const void* sample, const dds_sample_info_t* info, void* context)
{
    return is_of_its_server(*static_cast<const tactus_v5_Pieces*>(sample), info, context);
}

bool is_honest_telemetry(const void* sample, const dds_sample_info_t* info, void* context)
{
    return is_of_its_controller(*static_cast<const tactus_v5_Telemetry*>(sample), info, context);
}

bool is_honest_edit(const void* sample, const dds_sample_info_t* info, void* context)
{
    const auto& edit = *static_cast<const tactus_v5_Edits*>(sample);
    return is_of_its_server(edit, info, context) &&
           has_sound_numbers(edit, edit.model, info, context);
}

bool is_honest_edit_request(const void* sample, const dds_sample_info_t* info, void* context)
{
    const auto& request = *static_cast<const tactus_v5_EditRequests*>(sample);
    return request.server_epoch == participants_of(context).own_epoch() &&
           is_of_its_controller(request, info, context);
}

const TopicTraits& traits_of(Topic topic)
{
    // All topics are keep-last, so that no writer waits for a reader. The depths of `wanted` and
    // `chunks` are rarely reached, since requests are few and credit limits pieces. They bound the
    // samples that one stuck writer of several holds back; dropped pieces are requested again.
    // Readers have no other limits, since a full reader would block all reception of its process;
    // the filters bound their instances.
    static const std::array<TopicTraits, 9> traits{{
        {"tactus/v5/catalogue", &tactus_v5_CatalogueEntry_desc, is_honest_entry, true, true, false,
         1},
        {"tactus/v5/objects", &tactus_v5_ObjectRecord_desc, is_honest_record, true, false, false,
         1},
        {"tactus/v5/motion", &tactus_v5_Motion_desc, is_honest_motion, false, false, true, 128},
        {"tactus/v5/wanted", &tactus_v5_Wanted_desc, is_honest_request, false, true, false, 16},
        {"tactus/v5/chunks", &tactus_v5_Pieces_desc, is_honest_pieces, false, false, false,
         4 * kCreditPieces},
        {"tactus/v5/telemetry", &tactus_v5_Telemetry_desc, is_honest_telemetry, false, true, true,
         1},
        {"tactus/v5/telemetry", &tactus_v5_Telemetry_desc, is_honest_telemetry, false, true, true,
         kStateDepth},
        {"tactus/v5/edits", &tactus_v5_Edits_desc, is_honest_edit, true, false, false, 1},
        {"tactus/v5/edit_requests", &tactus_v5_EditRequests_desc, is_honest_edit_request, false,
         false, false, 64},
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
    constexpr std::int32_t unlimited = DDS_LENGTH_UNLIMITED;
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, traits.depth, unlimited,
                                unlimited, unlimited);
    return qos;
}

std::int32_t make_topic(const Domain& domain, const TopicTraits& traits)
{
    return dds_create_topic(domain.participant(), traits.type, traits.name, nullptr, nullptr);
}

Refusal refused(const TopicTraits& traits, std::int32_t code)
{
    return {fmt::format("DDS topic {} cannot be used: {}", traits.name, dds_strretcode(code))};
}

Qos partition_qos(const std::string& partition)
{
    Qos qos = make_qos();
    const char* name = partition.c_str();
    dds_qset_partition(qos.get(), 1, &name);
    return qos;
}

} // namespace

Result<Endpoint, Refusal> make_writer(const Domain& domain, Topic topic,
                                      const std::string& partition)
{
    const TopicTraits& traits = traits_of(topic);
    const Entity type(make_topic(domain, traits)); // DDS keeps the topic as long as the writer.
    if (!type.is_valid())
    {
        return refused(traits, type.get());
    }
    const Qos parent_qos = partition_qos(partition);
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
                                      const std::string& partition)
{
    const TopicTraits& traits = traits_of(topic);
    // A topic of its own, since the filter applies to this reader only.
    const Entity type(make_topic(domain, traits));
    if (!type.is_valid())
    {
        return refused(traits, type.get());
    }
    dds_topic_filter filter = {};
    filter.mode = DDS_TOPIC_FILTER_SAMPLE_SAMPLEINFO_ARG;
    filter.f.sample_sampleinfo_arg = traits.is_honest;
    filter.arg = &domain.participants();
    if (const auto code = dds_set_topic_filter_extended(type.get(), &filter);
        code != DDS_RETCODE_OK)
    {
        return refused(traits, code);
    }
    const Qos parent_qos = partition_qos(partition);
    const Qos qos = endpoint_qos(traits);
    if (topic == Topic::states)
    {
        dds_qset_userdata(qos.get(), kReadsStates.data(), kReadsStates.size());
    }
    Endpoint reader;
    reader.parent = Entity(dds_create_subscriber(domain.participant(), parent_qos.get(), nullptr));
    reader.handle = dds_create_reader(reader.parent.get(), type.get(), qos.get(), nullptr);
    if (!reader.is_valid())
    {
        return refused(traits, reader.handle);
    }
    return reader;
}

std::optional<Refused> fault_of(const tactus_v5_CatalogueEntry& entry) noexcept
{
    return entry.model < kMaxModels ? std::nullopt : std::optional(Refused::model_number);
}

std::optional<Refused> fault_of(const tactus_v5_ObjectRecord& record) noexcept
{
    return record.object < kMaxObjects ? std::nullopt : std::optional(Refused::object_number);
}

std::optional<Refused> fault_of(const tactus_v5_Edits& edit) noexcept
{
    if (edit.model >= kMaxModels)
    {
        return Refused::model_number;
    }
    const bool is_in_ranges = edit.part < edit.parts && edit.parts <= kMaxSumParts;
    const bool is_single = edit.index < kKeptEdits && edit.parts == 1 && edit.to == edit.from + 1 &&
                           edit.to != 0 && edit.index == edit.to % kKeptEdits;
    const bool is_sum = edit.from == 0 && edit.index == kKeptEdits + edit.part;
    return is_in_ranges && (is_single || is_sum) ? std::nullopt : std::optional(Refused::edit);
}

std::string server_partition(std::uint64_t server_epoch)
{
    return fmt::format("server.{:016x}", server_epoch);
}

std::string controller_partition(const std::string& name, const ControllerId& id)
{
    return name + "." + hash_text(id);
}

std::uint32_t readers_of(const Endpoint& writer)
{
    dds_publication_matched_status_t status = {};
    return dds_get_publication_matched_status(writer.handle, &status) == DDS_RETCODE_OK
               ? status.current_count
               : 0;
}

bool is_matched(const Endpoint& writer)
{
    return readers_of(writer) > 0;
}

bool has_reader_of_states(const Endpoint& writer)
{
    std::vector<dds_instance_handle_t> readers(readers_of(writer));
    const std::int32_t count =
        dds_get_matched_subscriptions(writer.handle, readers.data(), readers.size());
    readers.resize(std::min(readers.size(), static_cast<std::size_t>(std::max(count, 0))));
    return std::ranges::any_of(
        readers,
        [&](dds_instance_handle_t reader)
        {
            const std::unique_ptr<dds_builtintopic_endpoint_t,
                                  decltype(&dds_builtintopic_free_endpoint)>
                endpoint(dds_get_matched_subscription_data(writer.handle, reader),
                         &dds_builtintopic_free_endpoint);
            void* data = nullptr;
            std::size_t size = 0;
            const bool has_data =
                endpoint != nullptr && dds_qget_userdata(endpoint->qos, &data, &size);
            const std::unique_ptr<void, decltype(&dds_free)> owned(data, &dds_free);
            return has_data && size == kReadsStates.size() &&
                   std::memcmp(data, kReadsStates.data(), size) == 0;
        });
}

bool has_publisher(const Endpoint& reader)
{
    dds_subscription_matched_status_t status = {};
    return dds_get_subscription_matched_status(reader.handle, &status) == DDS_RETCODE_OK &&
           status.current_count > 0;
}

} // namespace tactus::dds
