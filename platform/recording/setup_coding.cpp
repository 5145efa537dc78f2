// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/setup_coding.hpp"

#include "platform/recording/fixed_writer.hpp"
#include "rt_core/frame/frame.hpp"
#include "rt_core/limits.hpp"
#include "transport/base/printable.hpp"

#include <algorithm>
#include <array>

namespace tactus
{

namespace
{

using Fault = std::optional<std::string>;

/// Limit of a capacity: a slot of the smallest pool has 16 bytes, so no pool of 4 GiB has more;
/// sums of 32 bits stay far from wrapping.
constexpr std::uint32_t kMaxCapacity = 1U << 28U;

void append_name(std::vector<std::byte>& bytes, std::string_view name)
{
    const std::string_view kept = name.substr(0, kMaxRecordedNameBytes);
    append(bytes, static_cast<std::uint8_t>(kept.size()));
    append_bytes(bytes, std::as_bytes(std::span(kept)));
}

std::string read_name(ByteReader& reader)
{
    const auto bytes = reader.read_bytes(reader.read<std::uint8_t>());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// True for names that can be printed: a recording must not move the terminal's cursor.
bool is_sound(const std::string& name)
{
    return name.size() <= kMaxRecordedNameBytes && std::ranges::all_of(name, is_printable);
}

std::string up_to(std::uint32_t most)
{
    return "1 to " + std::to_string(most);
}

bool is_within(double value, double least, double most)
{
    return value >= least && value <= most; // False for NaN.
}

bool is_sound(const ToolSpec& tool)
{
    return is_within(tool.radius_m, 0.0, 1e6) && is_within(tool.stiffness_n_per_m, 0.0, 1e9) &&
           is_within(tool.force_max_n, 0.0, 1e9) && is_within(tool.speed_max_m_per_s, 0.0, 1e9) &&
           is_within(tool.torque_max_nm, 0.0, 1e9) &&
           is_within(tool.angular_stiffness_nm_per_rad, 0.0, 1e9) &&
           is_within(tool.shading_m, 0.0, 1e6);
}

// Values in a file; changing them requires a new format version (docs/recording.md).
static_assert(static_cast<int>(Prediction::local_neighbours) == 0);
static_assert(static_cast<int>(Prediction::linear) == 1);
static_assert(static_cast<int>(Prediction::quadratic) == 2);
static_assert(static_cast<int>(Prediction::distance_query) == 3);
static_assert(static_cast<int>(Prediction::automatic) == 4);

/// Flags of a model's capacities: no cache; the room for added faces follows.
constexpr std::uint32_t kCacheOff = 1;
constexpr std::uint32_t kHasEditFaces = 2;
/// Bits of a tool's two flag bytes, two bits each.
constexpr std::uint32_t kWantsContacts = 1;
constexpr std::uint32_t kWantsPairs = 2;
constexpr std::uint32_t kQueryOnly = 1;
constexpr std::uint32_t kWantsDistance = 2;

Fault parse_tools(ByteReader& reader, std::uint32_t tools, std::uint32_t models,
                  RecordedSetup& setup)
{
    for (std::uint32_t i = 0; i < tools; ++i)
    {
        ToolSpec tool;
        tool.radius_m = reader.read<double>();
        tool.stiffness_n_per_m = reader.read<double>();
        tool.force_max_n = reader.read<double>();
        tool.speed_max_m_per_s = reader.read<double>();
        const auto wants = reader.read<std::uint8_t>();
        tool.wants_contacts = (wants & kWantsContacts) != 0;
        tool.wants_pairs = (wants & kWantsPairs) != 0;
        tool.torque_max_nm = reader.read<double>();
        const auto requests = reader.read<std::uint8_t>();
        tool.query_only = (requests & kQueryOnly) != 0;
        tool.wants_distance = (requests & kWantsDistance) != 0;
        tool.angular_stiffness_nm_per_rad = reader.read<double>();
        tool.shading_m = reader.read<double>();
        const std::optional<ToolCore> core = read_core(reader, setup.hull_vertices);
        if (!core || wants > (kWantsContacts | kWantsPairs) ||
            requests > (kQueryOnly | kWantsDistance))
        {
            return "tool " + std::to_string(i) +
                   " has an unknown core, a core beyond 1e6 m, or a hull without 1 to 64 vertices";
        }
        tool.core = *core;
        const auto* mesh = std::get_if<MeshCore>(&tool.core);
        if (mesh != nullptr && mesh->model.value >= models)
        {
            return "tool " + std::to_string(i) + " refers to model " +
                   std::to_string(mesh->model.value) + ", but the model count is " +
                   std::to_string(models);
        }
        if (!is_sound(tool))
        {
            return "tool " + std::to_string(i) +
                   " has a value out of its range: 0 to 1e6 m, 0 to 1e9 N/m, 0 to 1e9 N, 0 to 1e9 "
                   "m/s, 0 to 1e9 N m, 0 to 1e9 N m/rad";
        }
        setup.tools.push_back(tool);
    }
    return std::nullopt;
}

Fault parse_objects(ByteReader& reader, std::uint32_t objects, std::uint32_t models,
                    RecordedSetup& setup)
{
    for (std::uint32_t i = 0; i < objects; ++i)
    {
        SceneChange change;
        const bool is_known = try_read(reader, change);
        if (!is_known || change.kind != SceneChangeKind::object_comes || change.number != i)
        {
            return "object " + std::to_string(i) + " is out of order";
        }
        if (change.object.model.value >= models)
        {
            return "object " + std::to_string(i) + " refers to model " +
                   std::to_string(change.object.model.value) + ", but the model count is " +
                   std::to_string(models);
        }
        if (!is_sound(change.object.material))
        {
            return "object " + std::to_string(i) +
                   " has a material out of its ranges: stiffness above 0 N/m, static friction 0 to "
                   "1000, dynamic friction 0 to the static one, damping and viscosity 0 to 1e9 N "
                   "s/m, texture height at most 1/32 of the length, texture length 0.0001 to 1 m";
        }
        if (!is_sound(change.pose))
        {
            return "object " + std::to_string(i) +
                   " has a pose without a rotation, beyond 10000 m or with a scale not within "
                   "0.001 to 1000";
        }
        setup.objects.push_back(change.object);
        setup.poses.push_back(change.pose);
    }
    return std::nullopt;
}

Fault check(const ModelCapacities& capacities, std::uint32_t base_faces)
{
    const auto [least, most] = std::minmax(
        {capacities.pages, capacities.index_pages, capacities.blocks, capacities.nodes});
    if (least < 1 || most > kMaxCapacity)
    {
        return "a pool has " + std::to_string(least < 1 ? least : most) + " slots; 1 to " +
               std::to_string(kMaxCapacity) + " are allowed";
    }
    if (capacities.faces > kMaxPoolFaces)
    {
        return "there is room for " + std::to_string(capacities.faces) + " faces; at most " +
               std::to_string(kMaxPoolFaces) + " are allowed";
    }
    if (capacities.faces < base_faces)
    {
        return "there is room for " + std::to_string(capacities.faces) +
               " faces; the base mesh alone has " + std::to_string(base_faces);
    }
    return std::nullopt;
}

/// Fault of the numbers of a setup's parts; none if they are in their ranges.
Fault check_counts(std::uint32_t tools, std::uint32_t objects, std::uint32_t models,
                   const SceneCapacities& capacities)
{
    if (tools < 1 || tools > kMaxTools || models < 1 || models > kMaxModels)
    {
        return "the setup has " + std::to_string(tools) + " tools and " + std::to_string(models) +
               " models; " + up_to(kMaxTools) + " and " + up_to(kMaxModels) + " are allowed";
    }
    if (capacities.objects < 1 || capacities.objects > kMaxObjects ||
        objects > capacities.objects || capacities.pairs < 1 || capacities.pairs > kMaxPairs)
    {
        return "the setup has " + std::to_string(objects) + " objects and room for " +
               std::to_string(capacities.objects) + " objects and " +
               std::to_string(capacities.pairs) + " pairs; the room must be " + up_to(kMaxObjects) +
               " objects and " + up_to(kMaxPairs) + " pairs, and enough for the objects";
    }
    return std::nullopt;
}

/// Fault of the rules of a setup; none if they are in their ranges.
Fault check_rules(std::uint32_t is_static, std::uint32_t prediction, std::int64_t period_ns)
{
    if (is_static > 1)
    {
        return "the static mode is " + std::to_string(is_static) + "; 0 and 1 are allowed";
    }
    if (prediction > static_cast<std::uint32_t>(Prediction::automatic))
    {
        return "the prediction is " + std::to_string(prediction) + "; 0 to " +
               std::to_string(kPredictions) + " are allowed";
    }
    if (period_ns < 1 || period_ns > 1'000'000'000)
    {
        return "the period is " + std::to_string(period_ns) + " ns; 1 to 1000000000 are allowed";
    }
    return std::nullopt;
}

} // namespace

std::vector<std::byte> code_setup(const RecordedSetup& setup)
{
    TACTUS_ASSERT(setup.poses.size() == setup.objects.size());
    std::vector<std::byte> bytes;
    append(bytes, setup.period_ns);
    append(bytes, setup.pose_age_max_ns);
    append(bytes, static_cast<std::uint8_t>(setup.static_when_it_fits));
    append(bytes, static_cast<std::uint8_t>(setup.prediction));
    append(bytes, static_cast<std::uint8_t>(setup.tools.size()));
    append(bytes, static_cast<std::uint16_t>(setup.objects.size()));
    append(bytes, static_cast<std::uint16_t>(setup.models.size()));
    append(bytes, static_cast<std::uint16_t>(setup.capacities.objects));
    append(bytes, static_cast<std::uint8_t>(setup.capacities.pairs));
    for (const ToolSpec& tool : setup.tools)
    {
        append(bytes, tool.radius_m);
        append(bytes, tool.stiffness_n_per_m);
        append(bytes, tool.force_max_n);
        append(bytes, tool.speed_max_m_per_s);
        append(bytes, static_cast<std::uint8_t>((tool.wants_contacts ? kWantsContacts : 0U) |
                                                (tool.wants_pairs ? kWantsPairs : 0U)));
        append(bytes, tool.torque_max_nm);
        append(bytes, static_cast<std::uint8_t>((tool.query_only ? kQueryOnly : 0U) |
                                                (tool.wants_distance ? kWantsDistance : 0U)));
        append(bytes, tool.angular_stiffness_nm_per_rad);
        append(bytes, tool.shading_m);
        append_core(bytes, tool.core);
    }
    for (std::size_t i = 0; i < setup.objects.size(); ++i)
    {
        std::array<std::byte, kSceneChangeBytes> coded;
        FixedWriter writer(coded);
        write_change(writer, {SceneChangeKind::object_comes, static_cast<std::uint32_t>(i), 0,
                              setup.objects[i], setup.poses[i]});
        append_bytes(bytes, std::span(coded).first(writer.size()));
    }
    append_name(bytes, setup.compiler);
    append_name(bytes, setup.architecture);
    append_name(bytes, setup.kernels);
    const ModelCapacities& streamed_models = setup.for_streamed_models;
    for (const std::uint32_t capacity :
         {streamed_models.pages, streamed_models.index_pages, streamed_models.faces,
          streamed_models.blocks, streamed_models.nodes, streamed_models.base_cells})
    {
        append(bytes, capacity);
    }
    append(bytes, setup.force_tolerance_n);
    return bytes;
}

std::vector<std::byte> code_model(const RecordedModel& model)
{
    std::vector<std::byte> bytes;
    const ModelCapacities& capacities = model.capacities;
    for (const std::uint32_t capacity : {capacities.pages, capacities.index_pages, capacities.faces,
                                         capacities.blocks, capacities.nodes})
    {
        append(bytes, capacity);
    }
    append(bytes, static_cast<std::uint8_t>((capacities.cache_off ? kCacheOff : 0U) |
                                            (capacities.edit_faces > 0 ? kHasEditFaces : 0U)));
    if (capacities.edit_faces > 0)
    {
        append(bytes, capacities.edit_faces);
    }
    append(bytes, static_cast<std::uint32_t>(model.header.size()));
    append_bytes(bytes, model.header);
    append_bytes(bytes, model.base);
    return bytes;
}

std::optional<std::string> parse_setup(std::span<const std::byte> payload, RecordedSetup& setup,
                                       std::uint32_t& models)
{
    ByteReader reader(payload);
    setup.period_ns = reader.read<std::int64_t>();
    setup.pose_age_max_ns = reader.read<std::int64_t>();
    const auto is_static = reader.read<std::uint8_t>();
    setup.static_when_it_fits = is_static != 0;
    const auto prediction = reader.read<std::uint8_t>();
    setup.prediction = static_cast<Prediction>(prediction);
    const auto tools = reader.read<std::uint8_t>();
    const auto objects = reader.read<std::uint16_t>();
    models = reader.read<std::uint16_t>();
    SceneCapacities& capacities = setup.capacities;
    capacities.objects = reader.read<std::uint16_t>();
    capacities.pairs = reader.read<std::uint8_t>();
    if (Fault fault = check_counts(tools, objects, models, capacities))
    {
        return fault;
    }
    if (Fault fault = check_rules(is_static, prediction, setup.period_ns))
    {
        return fault;
    }
    if (Fault fault = parse_tools(reader, tools, models, setup))
    {
        return fault;
    }
    if (Fault fault = parse_objects(reader, objects, models, setup))
    {
        return fault;
    }
    for (std::string* name : {&setup.compiler, &setup.architecture, &setup.kernels})
    {
        *name = read_name(reader);
        if (!is_sound(*name))
        {
            return "a name in the setup is not at most 63 printable characters";
        }
    }
    ModelCapacities& streamed_models = setup.for_streamed_models;
    for (std::uint32_t* capacity :
         {&streamed_models.pages, &streamed_models.index_pages, &streamed_models.faces,
          &streamed_models.blocks, &streamed_models.nodes, &streamed_models.base_cells})
    {
        *capacity = reader.read<std::uint32_t>();
    }
    setup.force_tolerance_n = reader.read<double>();
    if (Fault fault = unless_whole(reader, "setup"))
    {
        return fault;
    }
    if (!(setup.force_tolerance_n >= 0.0 && setup.force_tolerance_n <= kForceToleranceMax_n))
    {
        return "the force tolerance is " + std::to_string(setup.force_tolerance_n) + " N; 0 to " +
               std::to_string(kForceToleranceMax_n) + " are allowed";
    }
    if (streamed_models.base_cells == 0)
    {
        return streamed_models == ModelCapacities{}
                   ? std::nullopt
                   : Fault("there are pools for streamed models, but no base meshes");
    }
    const Fault fault = check(streamed_models, 0);
    return fault || streamed_models.base_cells <= kMaxCapacity ? fault
                                                               : Fault("too many base meshes");
}

std::optional<std::string> parse_model(std::span<const std::byte> payload, bool has_streamed_models,
                                       RecordedModel& model, ModelCounts& counts,
                                       std::size_t& bytes_left)
{
    ByteReader reader(payload);
    ModelCapacities& capacities = model.capacities;
    for (std::uint32_t* capacity : {&capacities.pages, &capacities.index_pages, &capacities.faces,
                                    &capacities.blocks, &capacities.nodes})
    {
        *capacity = reader.read<std::uint32_t>();
    }
    const auto flags = reader.read<std::uint8_t>();
    capacities.cache_off = (flags & kCacheOff) != 0;
    const bool has_edit_faces = (flags & kHasEditFaces) != 0;
    capacities.edit_faces = has_edit_faces ? reader.read<std::uint32_t>() : 0;
    const auto header = reader.read_bytes(reader.read<std::uint32_t>());
    const auto base = reader.read_bytes(reader.remaining());
    model.header.assign(header.begin(), header.end());
    model.base.assign(base.begin(), base.end());
    if (Fault fault = unless_whole(reader, "model"))
    {
        return fault;
    }
    const auto parsed = ModelHeader::parse(model.header);
    if (!parsed)
    {
        return std::string("the model's header is damaged: ") + refusal_text(parsed.error());
    }
    counts = parsed.value().counts();
    if (flags > (kCacheOff | kHasEditFaces))
    {
        return "the flags of the model are " + std::to_string(flags) + "; 0 to 3 are allowed";
    }
    if (has_edit_faces && (capacities.edit_faces < 1 || capacities.edit_faces > kMaxAddedFaces))
    {
        return "there is room for " + std::to_string(capacities.edit_faces) +
               " added faces; 1 to " + std::to_string(kMaxAddedFaces) + " are allowed";
    }
    if (has_streamed_models && model.base.empty())
    {
        return capacities == ModelCapacities{} ? std::nullopt : Fault("a streamed model has pools");
    }
    if (Fault fault = check(capacities, counts.base_faces))
    {
        return fault;
    }
    const std::size_t needed = required_bytes({&parsed.value(), 1}, {&capacities, 1});
    if (needed > bytes_left)
    {
        return "the pools of all models need more than " +
               std::to_string(kMaxRecordedPoolBytes >> 20U) + " MiB, the most allowed";
    }
    bytes_left -= needed;
    return std::nullopt;
}

std::vector<std::byte> code_name(const RecordedName& what, std::string_view name)
{
    std::vector<std::byte> bytes;
    append(bytes, static_cast<std::uint8_t>(what.kind));
    append(bytes, what.number);
    append(bytes, what.generation);
    append_name(bytes, name);
    return bytes;
}

std::optional<std::string> parse_name(std::span<const std::byte> payload, RecordedSetup& setup)
{
    ByteReader reader(payload);
    const auto kind = reader.read<std::uint8_t>();
    RecordedName what{static_cast<RecordedName::Kind>(kind)};
    what.number = reader.read<std::uint32_t>();
    what.generation = reader.read<std::uint32_t>();
    const std::string name = read_name(reader);
    if (Fault fault = unless_whole(reader, "name"))
    {
        return fault;
    }
    const bool is_model = what.kind == RecordedName::Kind::model;
    const std::size_t most = is_model ? setup.models.size() : setup.capacities.objects;
    if (kind > static_cast<std::uint8_t>(RecordedName::Kind::object) || what.number >= most ||
        (is_model && what.generation != 0))
    {
        return "a name belongs to no model or object of the recording";
    }
    if (name.size() > kMaxRecordedNameBytes || name != printable_line(name))
    {
        return "a name is not at most 63 bytes of printable characters";
    }
    return setup.names.try_emplace(what, name).second
               ? std::nullopt
               : Fault("a model or an object of one generation has two names");
}

std::optional<std::string> unless_whole(const ByteReader& reader, const char* section)
{
    return reader.failed() || !reader.at_end()
               ? Fault(std::string("the ") + section +
                       " section has a size that differs from its content")
               : std::nullopt;
}

} // namespace tactus
