// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/telemetry.hpp"

#include "transport/base/printable.hpp"
#include "transport/dds/take.hpp"
#include "transport/dds/wire_values.hpp"
#include "transport/model_name.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// Bits of ToolTelemetry::state.
constexpr unsigned kInContact = 1;
constexpr unsigned kHalted = 2;
constexpr unsigned kOverConstrained = 4;
constexpr unsigned kDataLimited = 8;
constexpr unsigned kHasGripper = 16;
/// Bits of ModelTelemetry::state.
constexpr unsigned kServerGone = 1;
constexpr unsigned kStatic = 2;
constexpr unsigned kFollowsPoses = 4;
/// First bit of the stage (ModelStage). `resident` is sent as 0, the value from senders without
/// stages.
constexpr unsigned kStageShift = 3;

/// Wire code of a stage: its difference from `resident`, modulo the number of stages.
constexpr unsigned stage_code(ModelStage stage)
{
    return (static_cast<unsigned>(stage) + kModelStages -
            static_cast<unsigned>(ModelStage::resident)) %
           kModelStages;
}
constexpr ModelStage stage_of(unsigned code)
{
    return static_cast<ModelStage>((code + static_cast<unsigned>(ModelStage::resident)) %
                                   kModelStages);
}
static_assert(stage_of(0) == ModelStage::resident && stage_code(ModelStage::leaving) == 1);

constexpr unsigned bit_when(bool is_so, unsigned bit)
{
    return is_so ? bit : 0U;
}

tactus_v5_ToolTelemetry to_wire(const ToolTelemetry& tool)
{
    tactus_v5_ToolTelemetry wire = {};
    std::ranges::copy(tool.position_m, std::begin(wire.position_m));
    std::ranges::copy(tool.rotation, std::begin(wire.rotation));
    std::ranges::copy(tool.proxy_m, std::begin(wire.proxy_m));
    std::ranges::copy(tool.proxy_rotation, std::begin(wire.proxy_rotation));
    std::ranges::copy(tool.force_n, std::begin(wire.force_n));
    std::ranges::copy(tool.torque_nm, std::begin(wire.torque_nm));
    wire.state = static_cast<std::uint8_t>(
        bit_when(tool.in_contact, kInContact) | bit_when(tool.halted, kHalted) |
        bit_when(tool.over_constrained, kOverConstrained) |
        bit_when(tool.data_limited, kDataLimited) | bit_when(tool.has_gripper, kHasGripper));
    wire.gripper_m = tool.gripper_m;
    wire.buttons = tool.buttons;
    return wire;
}

ToolTelemetry from_wire(const tactus_v5_ToolTelemetry& wire)
{
    ToolTelemetry tool;
    std::ranges::copy(wire.position_m, tool.position_m.begin());
    std::ranges::copy(wire.rotation, tool.rotation.begin());
    std::ranges::copy(wire.proxy_m, tool.proxy_m.begin());
    std::ranges::copy(wire.proxy_rotation, tool.proxy_rotation.begin());
    std::ranges::copy(wire.force_n, tool.force_n.begin());
    std::ranges::copy(wire.torque_nm, tool.torque_nm.begin());
    tool.in_contact = (wire.state & kInContact) != 0;
    tool.halted = (wire.state & kHalted) != 0;
    tool.over_constrained = (wire.state & kOverConstrained) != 0;
    tool.data_limited = (wire.state & kDataLimited) != 0;
    tool.has_gripper = (wire.state & kHasGripper) != 0;
    tool.gripper_m = wire.gripper_m;
    tool.buttons = wire.buttons;
    return tool;
}

tactus_v5_PairTelemetry to_wire(const PairTelemetry& pair)
{
    tactus_v5_PairTelemetry wire = {};
    wire.server_epoch = pair.server_epoch;
    wire.object = pair.object;
    wire.tool = pair.tool;
    wire.kind = static_cast<std::uint8_t>(pair.kind);
    wire.lower_m = pair.lower_m;
    wire.upper_m = pair.upper_m;
    std::ranges::copy(pair.point_m, std::begin(wire.point_m));
    std::ranges::copy(pair.force_n, std::begin(wire.force_n));
    return wire;
}

PairTelemetry from_wire(const tactus_v5_PairTelemetry& wire)
{
    PairTelemetry pair{
        wire.server_epoch, wire.object,  wire.tool, static_cast<AnswerKind>(wire.kind),
        wire.lower_m,      wire.upper_m, {},        {}};
    std::ranges::copy(wire.point_m, pair.point_m.begin());
    std::ranges::copy(wire.force_n, pair.force_n.begin());
    return pair;
}

tactus_v5_ModelTelemetry to_wire(const ModelIdentity& identity, const ModelTelemetry& model)
{
    const auto pool = [](const PoolTelemetry& use) {
        return tactus_v5_PoolTelemetry{use.used, use.capacity};
    };
    tactus_v5_ModelTelemetry wire = {};
    identity.name.copy(static_cast<char*>(wire.name), kMaxNameBytes);
    std::memcpy(wire.hash, identity.hash.data(), identity.hash.size());
    wire.revision = identity.revision;
    wire.state = static_cast<std::uint8_t>(
        bit_when(model.server_gone, kServerGone) | bit_when(model.is_static, kStatic) |
        bit_when(model.follows_poses, kFollowsPoses) | stage_code(model.stage) << kStageShift);
    wire.pages = pool(model.pages);
    wire.faces = pool(model.faces);
    wire.blocks = pool(model.blocks);
    wire.nodes = pool(model.nodes);
    wire.pose_age_ns = model.pose_age_ns;
    wire.poses_refused = model.poses_refused;
    wire.pieces = model.pieces;
    wire.piece_wait_ns = model.piece_wait_ns;
    return wire;
}

ModelTelemetry from_wire(const tactus_v5_ModelTelemetry& wire)
{
    const auto pool = [](const tactus_v5_PoolTelemetry& use) {
        return PoolTelemetry{use.used, use.capacity};
    };
    ModelTelemetry model;
    model.pages = pool(wire.pages);
    model.faces = pool(wire.faces);
    model.blocks = pool(wire.blocks);
    model.nodes = pool(wire.nodes);
    model.server_gone = (wire.state & kServerGone) != 0;
    model.is_static = (wire.state & kStatic) != 0;
    model.follows_poses = (wire.state & kFollowsPoses) != 0;
    model.stage = stage_of(wire.state >> kStageShift);
    model.pose_age_ns = wire.pose_age_ns;
    model.poses_refused = wire.poses_refused;
    model.pieces = wire.pieces;
    model.piece_wait_ns = wire.piece_wait_ns;
    return model;
}

tactus_v5_ObjectTelemetry to_wire(const ObjectTelemetry& object)
{
    tactus_v5_ObjectTelemetry wire = {};
    wire.server_epoch = object.server_epoch;
    wire.object = object.object;
    wire.number = object.number;
    object.name.copy(static_cast<char*>(wire.name), kMaxNameBytes);
    std::memcpy(wire.model_hash, object.model.data(), object.model.size());
    wire.pose = dds::to_wire(object.pose);
    return wire;
}

/// Object in a sample; none if its name, number or pose is invalid.
std::optional<ObjectTelemetry> from_wire(const tactus_v5_ObjectTelemetry& wire)
{
    const Pose told = dds::from_wire(wire.pose);
    const auto pose = checked_pose(told);
    // Rounding may place an object just beyond kPoseReachMax_m.
    const bool is_sound = pose || pose.error() == PoseRefusal::translation;
    const std::string_view name = text_of(wire.name);
    if (!is_sound || wire.number >= kMaxObjects || !is_printable_line(name))
    {
        return std::nullopt;
    }
    ObjectTelemetry object{wire.server_epoch, wire.object, wire.number,
                           std::string(name), {},          pose ? pose.value() : told};
    std::memcpy(object.model.data(), wire.model_hash, object.model.size());
    return object;
}

bool all_finite(std::span<const double> numbers)
{
    return std::ranges::all_of(numbers, [](double value) { return std::isfinite(value); });
}

bool is_sound(const ToolTelemetry& tool)
{
    return all_finite(tool.position_m) && all_finite(tool.rotation) && all_finite(tool.proxy_m) &&
           all_finite(tool.proxy_rotation) && all_finite(tool.force_n) &&
           all_finite(tool.torque_nm) && std::isfinite(tool.gripper_m);
}

/// True if the values of a pair are valid; upper_m may be infinite.
bool is_sound(const PairTelemetry& pair, std::uint32_t tools)
{
    return pair.tool < tools && pair.kind <= AnswerKind::within_tolerance &&
           pair.lower_m <= pair.upper_m && all_finite(pair.point_m) && all_finite(pair.force_n);
}

ModelIdentity identity_of(const tactus_v5_ModelTelemetry& wire)
{
    ModelIdentity identity{std::string(text_of(wire.name)), {}, wire.revision};
    std::memcpy(identity.hash.data(), wire.hash, identity.hash.size());
    return identity;
}

/// Copies all fields except tools, pairs and models, in either direction.
template <typename From, typename To>
void copy_counts(const From& from, To& to)
{
    to.frame = from.frame;
    to.period_ns = from.period_ns;
    to.time_ns = from.time_ns;
    to.exact = from.exact;
    to.separated = from.separated;
    to.bounded = from.bounded;
    to.stale = from.stale;
    to.within_tolerance = from.within_tolerance;
    to.missed = from.missed;
    to.overruns = from.overruns;
    to.latency_misses = from.latency_misses;
    to.faults_now = from.faults_now;
    to.faults_seen = from.faults_seen;
}

} // namespace

std::optional<WatchedController> watched_from(const tactus_v5_Telemetry& sample)
{
    WatchedController news;
    news.id = controller_of(sample);
    news.name = text_of(sample.controller_name);
    news.serial = sample.serial;
    const bool is_in_bounds =
        sample.tools._length <= kMaxTools && sample.pairs._length <= kMaxPairs &&
        sample.models._length <= kMaxShownModels && sample.objects._length <= kMaxShownObjects &&
        sample.sweep_begin <= sample.sweep_end && sample.sweep_end <= kMaxObjects;
    if (!is_valid_name(news.name) || !is_in_bounds)
    {
        return std::nullopt;
    }
    copy_counts(sample, news.telemetry);
    news.telemetry.tool_count = sample.tools._length;
    news.telemetry.pair_count = sample.pairs._length;
    news.telemetry.model_count = sample.models._length;
    for (std::uint32_t i = 0; i < sample.tools._length; ++i)
    {
        news.telemetry.tools[i] = from_wire(sample.tools._buffer[i]);
        if (!is_sound(news.telemetry.tools[i]))
        {
            return std::nullopt;
        }
    }
    for (std::uint32_t i = 0; i < sample.pairs._length; ++i)
    {
        news.telemetry.pairs[i] = from_wire(sample.pairs._buffer[i]);
        if (!is_sound(news.telemetry.pairs[i], sample.tools._length))
        {
            return std::nullopt;
        }
    }
    for (std::uint32_t i = 0; i < sample.models._length; ++i)
    {
        news.models.push_back(identity_of(sample.models._buffer[i]));
        news.telemetry.models[i] = from_wire(sample.models._buffer[i]);
        const bool has_stage = sample.models._buffer[i].state >> kStageShift < kModelStages;
        if (!is_valid_name(news.models.back().name) || !has_stage)
        {
            return std::nullopt;
        }
    }
    news.objects.sweep_begin = sample.sweep_begin;
    news.objects.sweep_end = sample.sweep_end;
    for (std::uint32_t i = 0; i < sample.objects._length; ++i)
    {
        auto object = from_wire(sample.objects._buffer[i]);
        if (!object)
        {
            return std::nullopt;
        }
        news.objects.objects.push_back(*std::move(object));
    }
    if (sample.refinement_state._length > 0)
    {
        auto state = state_from(sample.refinement_state._buffer[0]);
        if (!state)
        {
            return std::nullopt;
        }
        news.state = std::make_shared<const SeenState>(SeenState{sample.serial, *std::move(state)});
    }
    return news;
}

Result<std::unique_ptr<TelemetryWriter>, Refusal>
TelemetryWriter::create(const Domain& domain, std::string controller_name,
                        std::vector<ModelIdentity> models)
{
    auto endpoint = make_writer(domain, Topic::telemetry, controller_name);
    if (!endpoint)
    {
        return endpoint.error();
    }
    std::unique_ptr<TelemetryWriter> writer(new TelemetryWriter(
        domain.participants().own(), std::move(controller_name), std::move(models)));
    writer->writer_ = std::move(endpoint).value();
    return writer;
}

TelemetryWriter::TelemetryWriter(const ControllerId& controller, std::string controller_name,
                                 std::vector<ModelIdentity> models)
    : controller_(controller)
    , controller_name_(std::move(controller_name))
    , models_(std::move(models))
{
    TACTUS_ASSERT(is_valid_name(controller_name_));
    TACTUS_ASSERT(models_.size() <= kMaxShownModels);
}

void TelemetryWriter::write(const Telemetry& telemetry, const ObjectsTelemetry& objects,
                            const RefinementState* state)
{
    TACTUS_ASSERT(telemetry.tool_count <= kMaxTools);
    TACTUS_ASSERT(telemetry.pair_count <= kMaxPairs);
    TACTUS_ASSERT(telemetry.model_count == models_.size());
    TACTUS_ASSERT(objects.objects.size() <= kMaxShownObjects);
    std::array<tactus_v5_PairTelemetry, kMaxPairs> pairs{};
    std::array<tactus_v5_ToolTelemetry, kMaxTools> tools{};
    std::array<tactus_v5_ModelTelemetry, kMaxShownModels> models{};
    for (std::uint32_t i = 0; i < telemetry.tool_count; ++i)
    {
        tools[i] = to_wire(telemetry.tools[i]);
    }
    for (std::uint32_t i = 0; i < telemetry.pair_count; ++i)
    {
        pairs[i] = to_wire(telemetry.pairs[i]);
    }
    for (std::uint32_t i = 0; i < telemetry.model_count; ++i)
    {
        models[i] = to_wire(models_[i], telemetry.models[i]);
    }
    std::vector<tactus_v5_ObjectTelemetry> shown;
    for (const ObjectTelemetry& object : objects.objects)
    {
        shown.push_back(to_wire(object));
    }
    tactus_v5_Telemetry sample = {};
    std::memcpy(sample.controller, controller_.data(), controller_.size());
    controller_name_.copy(static_cast<char*>(sample.controller_name), kMaxNameBytes);
    sample.serial = ++sent_;
    copy_counts(telemetry, sample);
    sample.tools = {telemetry.tool_count, telemetry.tool_count, tools.data(), false};
    sample.pairs = {telemetry.pair_count, telemetry.pair_count, pairs.data(), false};
    sample.models = {telemetry.model_count, telemetry.model_count, models.data(), false};
    sample.sweep_begin = objects.sweep_begin;
    sample.sweep_end = objects.sweep_end;
    const auto count = static_cast<std::uint32_t>(shown.size());
    sample.objects = {count, count, shown.data(), false};
    // A failed write counts as a lost sample; the next one replaces it.
    if (state == nullptr)
    {
        dds_write(writer_.handle, &sample);
        return;
    }
    ++states_sent_;
    with_wire_state(*state,
                    [&](tactus_v5_RefinementState& part)
                    {
                        sample.refinement_state = {1, 1, &part, false};
                        dds_write(writer_.handle, &sample);
                    });
}

Result<std::unique_ptr<TelemetryReader>, Refusal> TelemetryReader::create(const Domain& domain,
                                                                          bool wants_states)
{
    auto reader =
        make_reader(domain, wants_states ? Topic::states : Topic::telemetry, kAnyPartition);
    if (!reader)
    {
        return reader.error();
    }
    return std::unique_ptr<TelemetryReader>(
        new TelemetryReader(domain.participants(), std::move(reader).value()));
}

TelemetryReader::TelemetryReader(Participants& participants, Endpoint reader)
    : participants_(participants), reader_(std::move(reader))
{
}

void TelemetryReader::poll()
{
    take_each<tactus_v5_Telemetry>(
        reader_.handle, kMaxWatched * kStateDepth,
        [this](const tactus_v5_Telemetry& sample, const dds_sample_info_t& info)
        {
            if (tells_end(info))
            {
                end(controller_of(sample), info.publication_handle);
            }
            else if (!try_take(sample, info))
            {
                ++refused_;
                participants_.refuse(info.publication_handle, Refused::telemetry);
            }
        });
    std::erase_if(controllers_, [&](const WatchedController& each)
                  { return each.is_disputed && !participants_.is_writing(each.writer); });
}

bool TelemetryReader::try_take(const tactus_v5_Telemetry& sample, const dds_sample_info_t& info)
{
    std::optional<WatchedController> news = watched_from(sample);
    const auto known =
        std::ranges::find(controllers_, controller_of(sample), &WatchedController::id);
    if (!news || (known == controllers_.end() && controllers_.size() == kMaxWatched))
    {
        return false;
    }
    news->writer = info.publication_handle;
    news->is_disputed = info.instance_state != DDS_ALIVE_INSTANCE_STATE;
    if (known == controllers_.end())
    {
        controllers_.push_back(*std::move(news));
        return true;
    }
    if (news->state == nullptr)
    {
        news->state = std::move(known->state);
    }
    *known = *std::move(news);
    return true;
}

/// Removes a controller if its own participant ended it; others cannot.
void TelemetryReader::end(const ControllerId& controller, std::uint64_t writer)
{
    const auto who = participants_.writer_of(writer);
    if (who && *who != controller)
    {
        participants_.refuse(writer, Refused::identity);
        return;
    }
    std::erase_if(controllers_,
                  [&](const WatchedController& each) { return each.id == controller; });
}

} // namespace tactus::dds
