// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/assert.hpp"
#include "transport/base/printable.hpp"
#include "transport/dds/take.hpp"
#include "transport/dds/wire_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

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

std::optional<RefinementState> state_from(const tactus_v5_RefinementState& wire)
{
    const bool is_in_bounds =
        wire.tools._length <= kMaxTools && wire.models._length <= kMaxModels &&
        wire.chunks._length <= kMaxStatePages && wire.refined._length == wire.chunks._length &&
        wire.requested._length <= kMaxStateRequests && wire.regions._length <= kMaxStateRegions;
    if (!is_in_bounds)
    {
        return std::nullopt;
    }
    RefinementState state;
    copy_head(wire, state);
    for (std::size_t i = 0; i < kBudgetOrder.size(); ++i)
    {
        state.budgets.*kBudgetOrder[i] = wire.budgets[i];
    }
    auto models = models_from(wire);
    const auto is_sound = [](const FrontTimes& t)
    { return is_amount(t.mean_ns) && is_amount(t.max_ns); };
    if (!models || !std::ranges::all_of(state.times, is_sound))
    {
        return std::nullopt;
    }
    state.models = *std::move(models);
    for (std::uint32_t i = 0; i < wire.tools._length; ++i)
    {
        auto tool = tool_from(wire.tools._buffer[i]);
        if (!tool)
        {
            return std::nullopt;
        }
        state.tools.push_back(*std::move(tool));
    }
    for (std::uint32_t i = 0; i < wire.regions._length; ++i)
    {
        const auto region = region_from(wire.regions._buffer[i], wire.models._length);
        if (!region)
        {
            return std::nullopt;
        }
        state.regions.push_back(*region);
    }
    return state;
}

void with_wire_state(const RefinementState& state,
                     const std::function<void(tactus_v5_RefinementState&)>& use)
{
    TACTUS_ASSERT(state.tools.size() <= kMaxTools);
    TACTUS_ASSERT(state.models.size() <= kMaxModels);
    TACTUS_ASSERT(state.regions.size() <= kMaxStateRegions);
    std::vector<tactus_v5_RefinementStateTool> tools;
    std::vector<tactus_v5_RefinementStateModel> models;
    std::vector<std::uint32_t> chunks;
    std::vector<std::uint64_t> refined;
    std::vector<std::uint32_t> requested;
    std::vector<tactus_v5_RefinementStateRegion> regions;
    for (const RefinementStateTool& tool : state.tools)
    {
        tools.push_back(to_wire(tool));
    }
    for (const RefinementStateModel& model : state.models)
    {
        tactus_v5_RefinementStateModel& told = models.emplace_back();
        std::memcpy(told.hash, model.hash.data(), model.hash.size());
        told.pages = static_cast<std::uint32_t>(model.pages.size());
        for (const RefinementStatePage& page : model.pages)
        {
            chunks.push_back(page.chunk.value);
            refined.push_back(page.refined);
        }
        told.requested = static_cast<std::uint32_t>(model.requested.size());
        std::ranges::transform(model.requested, std::back_inserter(requested), &ChunkId::value);
    }
    TACTUS_ASSERT(chunks.size() <= kMaxStatePages);
    TACTUS_ASSERT(requested.size() <= kMaxStateRequests);
    for (const RefinementStateRegion& region : state.regions)
    {
        TACTUS_ASSERT(region.model < state.models.size());
        regions.push_back(to_wire(region));
    }
    tactus_v5_RefinementState part = {};
    copy_head(state, part);
    for (std::size_t i = 0; i < kBudgetOrder.size(); ++i)
    {
        part.budgets[i] = state.budgets.*kBudgetOrder[i];
    }
    part.tools = sequence_of<decltype(part.tools)>(tools);
    part.models = sequence_of<decltype(part.models)>(models);
    part.chunks = sequence_of<decltype(part.chunks)>(chunks);
    part.refined = sequence_of<decltype(part.refined)>(refined);
    part.requested = sequence_of<decltype(part.requested)>(requested);
    part.regions = sequence_of<decltype(part.regions)>(regions);
    use(part);
}

} // namespace tactus::dds
