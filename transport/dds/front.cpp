// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/front.hpp"

#include "transport/base/printable.hpp"
#include "transport/dds/newest.hpp"
#include "transport/dds/placement.hpp"
#include "transport/dds/take.hpp"
#include "transport/model_name.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// Budgets in the order of the wire.
constexpr std::array kBudgetOrder{&Budgets::splits,   &Budgets::merges,    &Budgets::scanned,
                                  &Budgets::nodes,    &Budgets::triangles, &Budgets::pages,
                                  &Budgets::requests, &Budgets::regions,   &Budgets::work};
static_assert(std::size(tactus_v5_RefinementState{}.budgets) == kBudgetOrder.size());
// `planes`, the budget of proxies, is the only member that is not sent.
static_assert(sizeof(Budgets) == (kBudgetOrder.size() + 1) * sizeof(std::uint32_t));
static_assert(std::size(tactus_v5_RefinementState{}.times) == kFrontTimes);

template <typename From, typename To>
void copy_head(const From& from, To& to)
{
    to.frame = from.frame;
    to.time_ns = from.time_ns;
    to.sweep_begin = from.sweep_begin;
    to.sweep_end = from.sweep_end;
    to.slots_left_out = from.slots_left_out;
    to.regions_left_out = from.regions_left_out;
    for (std::size_t i = 0; i < kFrontTimes; ++i)
    {
        to.times[i] = {from.times[i].mean_ns, from.times[i].max_ns};
    }
}

bool is_amount(double x)
{
    return std::isfinite(x) && x >= 0.0;
}

std::optional<RefinementStateTool> tool_from(const tactus_v5_RefinementStateTool& wire)
{
    const std::string_view shape = text_of(wire.shape);
    constexpr std::uint32_t known = (1U << kForceOffs) - 1;
    if (wire.state >= kSafetyStates || (wire.causes & ~known) != 0 || !is_amount(wire.radius_m) ||
        !is_printable_line(shape))
    {
        return std::nullopt;
    }
    return RefinementStateTool{static_cast<SafetyState>(wire.state),
                               static_cast<ForceOff>(wire.causes), std::string(shape),
                               wire.radius_m, wire.begins_inside};
}

std::optional<RefinementStateObject> object_from(const tactus_v5_RefinementStateObject& wire,
                                                 std::uint32_t models)
{
    // An object's frame may be farther away than kPoseReachMax_m, since the origin of its model is
    // added.
    const Pose told = from_wire(wire.pose);
    const auto pose = checked_pose(told);
    const bool is_sound = pose || pose.error() == PoseRefusal::translation;
    if (wire.model >= models || wire.number >= kMaxObjects || !is_sound)
    {
        return std::nullopt;
    }
    return RefinementStateObject{wire.server_epoch, wire.object, wire.number, wire.model,
                                 pose ? pose.value() : told};
}

/// True if the model may have this chunk and its number is above `last`, none at first.
template <typename Last>
bool is_next_chunk(ChunkId chunk, const Last& last)
{
    return chunk.value <= kMaxRecords >> kRecordsPerChunkLog2 && (!last || chunk > *last);
}

/// Models with their pages and requests; none if counts do not add up or chunks do not ascend.
std::optional<std::vector<RefinementStateModel>>
models_from(const tactus_v5_RefinementState& sample)
{
    std::vector<RefinementStateModel> models;
    std::uint32_t next = 0;
    std::uint32_t next_request = 0;
    for (std::uint32_t i = 0; i < sample.models._length; ++i)
    {
        const tactus_v5_RefinementStateModel& wire = sample.models._buffer[i];
        RefinementStateModel& model = models.emplace_back();
        std::memcpy(model.hash.data(), wire.hash, model.hash.size());
        if (wire.pages > sample.chunks._length - next ||
            wire.requested > sample.requested._length - next_request)
        {
            return std::nullopt;
        }
        for (const std::uint32_t end = next + wire.pages; next < end; ++next)
        {
            const ChunkId chunk{sample.chunks._buffer[next]};
            if (!is_next_chunk(chunk, model.pages.empty()
                                          ? std::nullopt
                                          : std::optional(model.pages.back().chunk)))
            {
                return std::nullopt;
            }
            model.pages.push_back({chunk, sample.refined._buffer[next]});
        }
        for (const std::uint32_t end = next_request + wire.requested; next_request < end;
             ++next_request)
        {
            const ChunkId chunk{sample.requested._buffer[next_request]};
            if (!is_next_chunk(chunk, model.requested.empty()
                                          ? std::nullopt
                                          : std::optional(model.requested.back())))
            {
                return std::nullopt;
            }
            model.requested.push_back(chunk);
        }
    }
    return next == sample.chunks._length && next_request == sample.requested._length
               ? std::optional(std::move(models))
               : std::nullopt;
}

std::optional<RefinementStateRegion> region_from(const tactus_v5_RefinementStateRegion& wire,
                                                 std::uint32_t models)
{
    RefinementStateRegion region{wire.model, wire.is_predicted, {}, wire.radius_m};
    std::ranges::copy(wire.center_m, region.center_m.begin());
    const bool is_sound =
        wire.model < models && is_amount(static_cast<double>(region.radius_m)) &&
        std::ranges::all_of(region.center_m, [](float x) { return std::isfinite(x); });
    return is_sound ? std::optional(region) : std::nullopt;
}

tactus_v5_RefinementStateTool to_wire(const RefinementStateTool& tool)
{
    tactus_v5_RefinementStateTool wire = {};
    wire.state = static_cast<std::uint8_t>(tool.state);
    wire.causes = static_cast<std::uint32_t>(tool.causes);
    tool.shape.copy(static_cast<char*>(wire.shape), kMaxShapeBytes);
    wire.radius_m = tool.radius_m;
    wire.begins_inside = tool.begins_inside;
    return wire;
}

tactus_v5_RefinementStateObject to_wire(const RefinementStateObject& object)
{
    tactus_v5_RefinementStateObject wire = {};
    wire.server_epoch = object.server_epoch;
    wire.object = object.object;
    wire.number = object.number;
    wire.model = static_cast<std::uint16_t>(object.model);
    wire.pose = dds::to_wire(object.pose);
    return wire;
}

tactus_v5_RefinementStateRegion to_wire(const RefinementStateRegion& region)
{
    tactus_v5_RefinementStateRegion wire = {};
    wire.model = static_cast<std::uint16_t>(region.model);
    wire.is_predicted = region.is_predicted;
    std::ranges::copy(region.center_m, std::begin(wire.center_m));
    wire.radius_m = region.radius_m;
    return wire;
}

template <typename Sequence, typename Element>
Sequence sequence_of(std::vector<Element>& elements)
{
    const auto count = static_cast<std::uint32_t>(elements.size());
    return {count, count, elements.data(), false};
}

} // namespace

std::optional<SeenFront> front_from(const tactus_v5_RefinementState& sample)
{
    const bool is_in_bounds =
        sample.tools._length <= kMaxTools && sample.models._length <= kMaxModels &&
        sample.objects._length <= kMaxStateObjects && sample.chunks._length <= kMaxStatePages &&
        sample.refined._length == sample.chunks._length &&
        sample.requested._length <= kMaxStateRequests &&
        sample.regions._length <= kMaxStateRegions && sample.sweep_begin <= sample.sweep_end &&
        sample.sweep_end <= kMaxObjects;
    if (!is_in_bounds || !is_valid_name(std::string(text_of(sample.controller_name))))
    {
        return std::nullopt;
    }
    SeenFront seen{controller_of(sample), sample.serial, {}};
    RefinementState& front = seen.front;
    copy_head(sample, front);
    for (std::size_t i = 0; i < kBudgetOrder.size(); ++i)
    {
        front.budgets.*kBudgetOrder[i] = sample.budgets[i];
    }
    auto models = models_from(sample);
    const auto is_sound = [](const FrontTimes& t)
    { return is_amount(t.mean_ns) && is_amount(t.max_ns); };
    if (!models || !std::ranges::all_of(front.times, is_sound))
    {
        return std::nullopt;
    }
    front.models = *std::move(models);
    for (std::uint32_t i = 0; i < sample.tools._length; ++i)
    {
        auto tool = tool_from(sample.tools._buffer[i]);
        if (!tool)
        {
            return std::nullopt;
        }
        front.tools.push_back(*std::move(tool));
    }
    for (std::uint32_t i = 0; i < sample.objects._length; ++i)
    {
        const auto object = object_from(sample.objects._buffer[i], sample.models._length);
        if (!object)
        {
            return std::nullopt;
        }
        front.objects.push_back(*object);
    }
    for (std::uint32_t i = 0; i < sample.regions._length; ++i)
    {
        const auto region = region_from(sample.regions._buffer[i], sample.models._length);
        if (!region)
        {
            return std::nullopt;
        }
        front.regions.push_back(*region);
    }
    return seen;
}

Result<std::unique_ptr<RefinementStateWriter>, Refusal>
RefinementStateWriter::create(const Domain& domain, std::string controller_name)
{
    auto endpoint = make_writer(domain, Topic::front, controller_name);
    if (!endpoint)
    {
        return endpoint.error();
    }
    std::unique_ptr<RefinementStateWriter> writer(
        new RefinementStateWriter(domain.participants().own(), std::move(controller_name)));
    writer->writer_ = std::move(endpoint).value();
    return writer;
}

RefinementStateWriter::RefinementStateWriter(const ControllerId& controller,
                                             std::string controller_name)
    : controller_(controller), controller_name_(std::move(controller_name))
{
    TACTUS_ASSERT(is_valid_name(controller_name_));
}

void RefinementStateWriter::write(const RefinementState& front)
{
    TACTUS_ASSERT(front.tools.size() <= kMaxTools);
    TACTUS_ASSERT(front.models.size() <= kMaxModels);
    TACTUS_ASSERT(front.objects.size() <= kMaxStateObjects);
    TACTUS_ASSERT(front.regions.size() <= kMaxStateRegions);
    std::vector<tactus_v5_RefinementStateTool> tools;
    std::vector<tactus_v5_RefinementStateModel> models;
    std::vector<tactus_v5_RefinementStateObject> objects;
    std::vector<std::uint32_t> chunks;
    std::vector<std::uint64_t> refined;
    std::vector<std::uint32_t> requested;
    std::vector<tactus_v5_RefinementStateRegion> regions;
    for (const RefinementStateTool& tool : front.tools)
    {
        tools.push_back(to_wire(tool));
    }
    for (const RefinementStateModel& model : front.models)
    {
        tactus_v5_RefinementStateModel& wire = models.emplace_back();
        std::memcpy(wire.hash, model.hash.data(), model.hash.size());
        wire.pages = static_cast<std::uint32_t>(model.pages.size());
        for (const RefinementStatePage& page : model.pages)
        {
            chunks.push_back(page.chunk.value);
            refined.push_back(page.refined);
        }
        wire.requested = static_cast<std::uint32_t>(model.requested.size());
        std::ranges::transform(model.requested, std::back_inserter(requested), &ChunkId::value);
    }
    TACTUS_ASSERT(chunks.size() <= kMaxStatePages);
    TACTUS_ASSERT(requested.size() <= kMaxStateRequests);
    for (const RefinementStateObject& object : front.objects)
    {
        TACTUS_ASSERT(object.model < front.models.size());
        objects.push_back(to_wire(object));
    }
    for (const RefinementStateRegion& region : front.regions)
    {
        TACTUS_ASSERT(region.model < front.models.size());
        regions.push_back(to_wire(region));
    }
    tactus_v5_RefinementState sample = {};
    std::memcpy(sample.controller, controller_.data(), controller_.size());
    controller_name_.copy(static_cast<char*>(sample.controller_name), kMaxNameBytes);
    sample.serial = ++sent_;
    copy_head(front, sample);
    for (std::size_t i = 0; i < kBudgetOrder.size(); ++i)
    {
        sample.budgets[i] = front.budgets.*kBudgetOrder[i];
    }
    sample.tools = sequence_of<decltype(sample.tools)>(tools);
    sample.models = sequence_of<decltype(sample.models)>(models);
    sample.objects = sequence_of<decltype(sample.objects)>(objects);
    sample.chunks = sequence_of<decltype(sample.chunks)>(chunks);
    sample.refined = sequence_of<decltype(sample.refined)>(refined);
    sample.requested = sequence_of<decltype(sample.requested)>(requested);
    sample.regions = sequence_of<decltype(sample.regions)>(regions);
    // A failed write counts as a lost sample; the next one replaces it.
    dds_write(writer_.handle, &sample);
}

Result<std::unique_ptr<RefinementStateReader>, Refusal>
RefinementStateReader::create(const Domain& domain)
{
    auto reader = make_reader(domain, Topic::front, kAnyPartition);
    if (!reader)
    {
        return reader.error();
    }
    return std::unique_ptr<RefinementStateReader>(
        new RefinementStateReader(domain.participants(), std::move(reader).value()));
}

RefinementStateReader::RefinementStateReader(Participants& participants, Endpoint reader)
    : participants_(participants), reader_(std::move(reader))
{
}

void RefinementStateReader::poll()
{
    refused_ += take_newest<tactus_v5_RefinementState>(reader_, participants_, kMaxSeen, fronts_,
                                                       front_from);
}

} // namespace tactus::dds
