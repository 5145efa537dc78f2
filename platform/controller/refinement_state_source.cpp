// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/refinement_state_source.hpp"

#include "platform/controller/controller.hpp"
#include "rt_core/cache/slot_queues.hpp"
#include "rt_core/scene/object_table.hpp"
#include "transport/base/printable.hpp"
#include "transport/chunk_loader.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace tactus::hrtc
{

namespace
{

/// Mean over the frames since the copy `before`, and maximum over all frames.
FrontTimes times_since(const RefinementStateCopy::Times& now,
                       const RefinementStateCopy::Times& before)
{
    const std::uint64_t frames = now.count - before.count;
    const double sum_ns = now.mean_ns * static_cast<double>(now.count) -
                          before.mean_ns * static_cast<double>(before.count);
    const double mean_ns = frames > 0 ? sum_ns / static_cast<double>(frames) : 0.0;
    return {std::max(mean_ns, 0.0), static_cast<double>(now.max.ns)}; // Rounding may go below 0.
}

static_assert(SlotQueues::kOpenRequests <= kMaxStateRequests);

/// Chunks with open requests, sorted, one list a model.
std::vector<std::vector<ChunkId>> requested_of(const Controller& controller)
{
    std::vector<std::vector<ChunkId>> requested(controller.models().size());
    for (std::uint32_t model = 0; model < requested.size(); ++model)
    {
        controller.chunk_loader().add_requested_chunks(model, requested[model]);
        std::ranges::sort(requested[model]);
    }
    return requested;
}

/// Adds the models of which the copy has pages or regions, or of which chunks are requested.
/// Returns the index in RefinementState::models of each; only valid for these models.
std::vector<std::uint32_t> add_models(const RefinementStateCopy& copy, const Controller& controller,
                                      RefinementState& front)
{
    std::vector<std::uint32_t> places(controller.models().size(), 0);
    for (const ShownPage& slot : copy.slots)
    {
        places[slot.owner] |= slot.chunk.is_none() ? 0U : 1U;
    }
    for (const RefinementStateRegion& region : copy.regions)
    {
        places[region.model] = 1;
    }
    std::vector<std::vector<ChunkId>> requested = requested_of(controller);
    for (std::size_t model = 0; model < places.size(); ++model)
    {
        if (places[model] != 0 || !requested[model].empty())
        {
            places[model] = static_cast<std::uint32_t>(front.models.size());
            front.models.push_back(
                {controller.models()[model].hash, {}, std::move(requested[model])});
        }
    }
    for (const ShownPage& slot : copy.slots)
    {
        if (!slot.chunk.is_none())
        {
            front.models[places[slot.owner]].pages.push_back({slot.chunk, slot.refined});
        }
    }
    for (RefinementStateModel& model : front.models)
    {
        std::ranges::sort(model.pages, {}, &RefinementStatePage::chunk);
    }
    return places;
}

} // namespace

RefinementState refinement_state_of(const RefinementStateCopy& copy,
                                    const RefinementStateCopy::AllTimes& before,
                                    const Controller& controller)
{
    RefinementState front;
    front.frame = copy.frame;
    front.budgets = copy.budgets;
    front.slots_left_out = copy.slots_left_out;
    front.regions_left_out = copy.regions_left_out;
    std::ranges::transform(copy.times, before, front.times.begin(), times_since);
    for (std::size_t i = 0; i < copy.tools.size(); ++i)
    {
        const ToolSetup& setup = controller.tools()[i];
        front.tools.push_back({copy.tools[i].state, copy.tools[i].causes,
                               printable(setup.shape, kMaxShapeBytes), setup.spec.radius_m});
    }
    const std::vector<std::uint32_t> places = add_models(copy, controller, front);
    for (const RefinementStateRegion& region : copy.regions)
    {
        front.regions.push_back(region);
        front.regions.back().model = places[region.model];
    }
    return front;
}

std::optional<RefinementState> RefinementStateSource::take(MonotonicTime now,
                                                           const dds::TelemetryWriter& writer)
{
    const RefinementStateCopy* copy = now - last_ < kPeriod ? nullptr : tap_->take();
    if (copy == nullptr)
    {
        return std::nullopt;
    }
    last_ = now;
    if (!writer.wants_states())
    {
        is_old_ = true;
        return std::nullopt;
    }
    std::optional<RefinementState> state;
    if (!is_old_)
    {
        state = refinement_state_of(*copy, last_times_, controller_);
        const std::uint32_t inside = begin_inside_.load(std::memory_order_relaxed);
        for (std::size_t tool = 0; tool < state->tools.size(); ++tool)
        {
            state->tools[tool].begins_inside = (inside >> tool & 1U) != 0;
        }
    }
    is_old_ = false;
    last_times_ = copy->times;
    tap_->give_back();
    return state;
}

} // namespace tactus::hrtc
