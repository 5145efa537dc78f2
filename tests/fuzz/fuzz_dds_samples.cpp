// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// The input is a sample as Cyclone hands it over: the number of its kind, then its bytes, as
/// sample_script.hpp describes them. It goes through the checks of that topic's reader. There is no
/// network. What is accepted is within the ranges that the types state.
#include "rt_core/limits.hpp"
#include "tests/fuzz/law.hpp"
#include "tests/fuzz/sample_script.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/dds/catalogue.hpp"
#include "transport/dds/edit_publisher.hpp"
#include "transport/dds/edit_reader.hpp"
#include "transport/dds/piece_frame.hpp"
#include "transport/dds/scene_reader.hpp"
#include "transport/dds/telemetry.hpp"
#include "transport/dds/topics.hpp"
#include "transport/dds/wire_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace tactus::fuzz
{

namespace
{

/// Reach of the poses in reports, which are finite.
constexpr double kAnyReach_m = std::numeric_limits<double>::max();

const ModelHeader& known_header()
{
    static const test::TinyModel model = test::make_tiny_model({});
    static const ModelHeader header = ModelHeader::parse(model.header).value();
    return header;
}

/// True for a number of at most `most` in both directions; false for NaN.
bool is_within(double value, double most)
{
    return value >= -most && value <= most;
}

template <typename Numbers>
void require_finite(const Numbers& numbers)
{
    require(std::ranges::all_of(numbers, [](auto number) { return std::isfinite(number); }),
            "accepted numbers are finite");
}

void require_name(const std::string& name)
{
    require(!name.empty() && name.size() <= kMaxNameBytes && is_one_clear_line(name) &&
                name.find_first_of(" /@*\"'\\,;:") == std::string::npos,
            "an accepted name is short and has no separators");
}

/// `reach_m`: maximum of its coordinates.
void require_pose(const Pose& pose, double reach_m = kPoseReachMax_m)
{
    const auto& q = pose.rotation;
    const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    require(std::abs(square - 1.0) < 3.0 * kPoseUnitTolerance, "an accepted rotation has length 1");
    require(std::ranges::all_of(pose.translation_m,
                                [&](double at_m) { return is_within(at_m, reach_m); }),
            "an accepted pose is in reach");
    require(pose.scale >= kPoseScaleMin && pose.scale <= kPoseScaleMax,
            "an accepted scale is in its range");
}

/// Checks a pose that its reader passes to checked_pose(); true if it is accepted.
bool take_pose(const tactus_v5_Placement& wire)
{
    const auto pose = checked_pose(dds::from_wire(wire));
    if (pose)
    {
        require_pose(pose.value());
        const auto& q = pose.value().rotation;
        require(std::abs(std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3])) - 1.0) < 1e-12,
                "a checked rotation has length 1");
    }
    return static_cast<bool>(pose);
}

bool take(const tactus_v5_CatalogueEntry& entry)
{
    const auto offer = dds::offer_from(entry);
    if (dds::fault_of(entry) || !offer)
    {
        return false;
    }
    require(offer->model < kMaxModels, "an offer has a possible number");
    require_name(offer->name);
    if (!offer->scene.empty())
    {
        require_name(offer->scene);
    }
    require(offer->edit_room <= kMaxAddedFaces, "the room for added faces is bounded");
    return true;
}

bool take(const tactus_v5_ObjectRecord& record)
{
    const auto object = dds::object_from(record);
    const bool has_pose = take_pose(record.pose);
    if (dds::fault_of(record) || !object || !has_pose)
    {
        return false;
    }
    require(object.value().number < kMaxObjects, "an object has a possible number");
    require_name(object.value().shown.name);
    const Material& material = object.value().shown.material;
    require(material.stiffness_n_per_m > 0.0, "an accepted stiffness is positive");
    require(material.dynamic_friction >= 0.0 &&
                material.static_friction >= material.dynamic_friction &&
                material.static_friction <= kFrictionMax,
            "accepted friction is in its range");
    for (const double damping : {material.damping_n_s_per_m, material.viscosity_n_s_per_m})
    {
        require(damping >= 0.0 && damping <= kDampingMax_n_s_per_m,
                "accepted damping is in its range");
    }
    require(material.texture_length_m >= 0.0 && material.texture_length_m <= kTextureLengthMax_m &&
                material.texture_height_m >= 0.0 &&
                material.texture_height_m <= kTextureSteepest * material.texture_length_m,
            "an accepted texture is in its ranges");
    return true;
}

bool take(const tactus_v5_Motion& motion)
{
    bool has_all = true;
    for (const tactus_v5_MovedObject& moved : std::span(motion.moved._buffer, motion.moved._length))
    {
        has_all = take_pose(moved.pose) && has_all;
    }
    return has_all;
}

/// The accepted pieces, framed again, are the payload's beginning.
bool take(const tactus_v5_Pieces& pieces)
{
    const auto payload = std::as_bytes(std::span(pieces.payload._buffer, pieces.payload._length));
    dds::PieceReader reader(payload);
    std::vector<std::byte> again;
    for (auto piece = reader.next(); piece; piece = reader.next())
    {
        dds::append_piece(again, piece->key, piece->bytes);
    }
    require(again.size() <= payload.size() &&
                std::equal(again.begin(), again.end(), payload.begin()),
            "pieces are the bytes of the payload");
    require(reader.is_broken() || again.size() == payload.size(),
            "no byte of a sound payload is left");
    require(!reader.next(), "the end of the pieces remains the end");
    return !reader.is_broken();
}

void check(const RefinementStateModel& model)
{
    for (std::size_t i = 0; i < model.pages.size(); ++i)
    {
        require(model.pages[i].chunk.value <= kMaxRecords / kRecordsPerChunk &&
                    (i == 0 || model.pages[i - 1].chunk < model.pages[i].chunk),
                "pages are possible and ascend");
    }
    for (std::size_t i = 0; i < model.requested.size(); ++i)
    {
        require(model.requested[i].value <= kMaxRecords / kRecordsPerChunk &&
                    (i == 0 || model.requested[i - 1] < model.requested[i]),
                "requests are possible and ascend");
    }
}

void check(const RefinementState& state, const tactus_v5_RefinementState& part)
{
    for (const FrontTimes& times : state.times)
    {
        require(std::isfinite(times.mean_ns) && times.mean_ns >= 0.0 &&
                    std::isfinite(times.max_ns) && times.max_ns >= 0.0,
                "times are amounts");
    }
    require(state.tools.size() <= kMaxTools && state.models.size() <= kMaxModels &&
                state.regions.size() <= kMaxStateRegions,
            "counts fit their bounds");
    for (const RefinementStateTool& tool : state.tools)
    {
        require(static_cast<std::size_t>(tool.state) < kSafetyStates &&
                    static_cast<std::uint32_t>(tool.causes) < 1U << kForceOffs,
                "a tool has a known state");
        require(std::isfinite(tool.radius_m) && tool.radius_m >= 0.0, "a radius is an amount");
        require(tool.shape.size() <= kMaxShapeBytes &&
                    (tool.shape.empty() || is_one_clear_line(tool.shape)),
                "a shape is one clear line");
    }
    std::size_t pages = 0;
    std::size_t requests = 0;
    for (const RefinementStateModel& model : state.models)
    {
        check(model);
        pages += model.pages.size();
        requests += model.requested.size();
    }
    require(pages == part.chunks._length && requests == part.requested._length,
            "each page and each request belongs to a model");
    for (const RefinementStateRegion& region : state.regions)
    {
        require(region.model < state.models.size(), "a region has a model");
        require(std::isfinite(region.radius_m) && region.radius_m >= 0.0F, "a radius is an amount");
        require_finite(region.center_m);
    }
}

bool take(const tactus_v5_Telemetry& sample)
{
    const auto news = dds::watched_from(sample);
    if (!news)
    {
        return false;
    }
    require_name(news->name);
    const Telemetry& telemetry = news->telemetry;
    require(telemetry.tool_count <= kMaxTools && telemetry.pair_count <= kMaxPairs &&
                telemetry.model_count <= kMaxShownModels &&
                telemetry.model_count == news->models.size(),
            "counts fit their arrays");
    for (const ToolTelemetry& tool : std::span(telemetry.tools).first(telemetry.tool_count))
    {
        for (const auto& numbers : {tool.position_m, tool.proxy_m, tool.force_n, tool.torque_nm})
        {
            require_finite(numbers);
        }
        require_finite(tool.rotation);
        require_finite(tool.proxy_rotation);
        require(std::isfinite(tool.gripper_m), "an accepted gripper is finite");
    }
    for (const PairTelemetry& pair : std::span(telemetry.pairs).first(telemetry.pair_count))
    {
        require(pair.tool < telemetry.tool_count, "a pair has a tool");
        require(static_cast<unsigned>(pair.kind) <= 4U, "an answer has a known kind");
        require(pair.lower_m <= pair.upper_m, "the bounds of a distance are in order");
        require_finite(pair.point_m);
        require_finite(pair.force_n);
    }
    for (const ModelTelemetry& model : std::span(telemetry.models).first(telemetry.model_count))
    {
        require(static_cast<unsigned>(model.stage) < kModelStages, "a model has a known stage");
    }
    for (const ModelIdentity& model : news->models)
    {
        require_name(model.name);
    }
    require(news->objects.sweep_begin <= news->objects.sweep_end &&
                news->objects.sweep_end <= kMaxObjects &&
                news->objects.objects.size() <= kMaxShownObjects,
            "the listed objects are in their range");
    for (const ObjectTelemetry& object : news->objects.objects)
    {
        require(object.number < kMaxObjects, "an object has a possible number");
        require(object.name.size() <= kMaxNameBytes &&
                    (object.name.empty() || is_one_clear_line(object.name)),
                "the name of an object is one clear line");
        require_pose(object.pose, kAnyReach_m);
    }
    require((news->state != nullptr) == (sample.refinement_state._length == 1),
            "an accepted sample keeps its state");
    if (news->state != nullptr)
    {
        require(news->state->serial == news->serial, "a state has the serial of its sample");
        check(news->state->state, sample.refinement_state._buffer[0]);
    }
    return true;
}

/// The content of an edit is the matter of fuzz_edit.cpp.
bool take(const tactus_v5_Edits& sample)
{
    const auto fault = dds::fault_of(sample);
    const auto edit = dds::edit_from(sample, known_header());
    if (!edit)
    {
        require(is_one_clear_line(edit.error().text), "a refused edit is one clear line");
    }
    if (fault || !edit)
    {
        return false;
    }
    require(sample.model < kMaxModels && sample.part < sample.parts &&
                sample.parts <= dds::kMaxSumParts,
            "an accepted edit has possible numbers");
    const bool is_single = sample.index < dds::kKeptEdits;
    require(!is_single || (sample.to == sample.from + 1 && edit.value().revision == sample.to),
            "a single edit follows the one before");
    require(is_single || (sample.from == 0 && edit.value().revision == sample.part + 1),
            "the parts of a sum are numbered");
    return true;
}

bool take(const tactus_v5_EditRequests& sample)
{
    const auto request = dds::request_from(sample);
    if (!request)
    {
        return false;
    }
    require(static_cast<unsigned>(request->kind) < kEditKinds, "a request has a known kind");
    require(request->radius_m >= 0.0 && request->radius_m <= kPoseReachMax_m,
            "a radius is in its range");
    require(is_within(request->amount_m, kPoseReachMax_m) &&
                (request->amount_m == 0.0 || request->kind == EditKind::displace),
            "only a displacement has an amount");
    require(request->hull_m.size() <= kMaxHullVertices, "a hull is bounded");
    for (const auto& vertex : request->hull_m)
    {
        require(
            std::ranges::all_of(vertex, [](double at) { return is_within(at, kPoseReachMax_m); }),
            "a hull is in reach");
    }
    require(std::ranges::all_of(request->half_axis_m,
                                [](double at) { return is_within(at, kPoseReachMax_m); }),
            "an axis is in reach");
    require(request->hull_m.empty() || request->half_axis_m == std::array<double, 3>{},
            "a core is of one kind");
    require(request->radius_m > 0.0 || request->hull_m.size() >= 4, "a core has a size");
    for (const Pose& pose : {request->from, request->to})
    {
        require_pose(pose);
    }
    return true;
}

bool take(SampleKind kind, SampleReader& reader)
{
    switch (kind)
    {
    case SampleKind::catalogue_entry:
        return take(reader.read_sample<tactus_v5_CatalogueEntry>());
    case SampleKind::object_record:
        return take(reader.read_sample<tactus_v5_ObjectRecord>());
    case SampleKind::motion:
        return take(reader.read_sample<tactus_v5_Motion>());
    case SampleKind::pieces:
        return take(reader.read_sample<tactus_v5_Pieces>());
    case SampleKind::telemetry:
        return take(reader.read_sample<tactus_v5_Telemetry>());
    case SampleKind::edits:
        return take(reader.read_sample<tactus_v5_Edits>());
    case SampleKind::edit_requests:
        return take(reader.read_sample<tactus_v5_EditRequests>());
    }
    return false;
}

} // namespace

} // namespace tactus::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace tactus::fuzz;
    SampleReader reader(std::as_bytes(std::span(data, size)));
    const auto kind = static_cast<SampleKind>(reader.read<std::uint8_t>() % kSampleKinds);
    accepted_inputs += take(kind, reader) ? 1U : 0U;
    return 0;
}
