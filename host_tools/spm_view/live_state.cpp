// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/live_state.hpp"

#include "transport/content_hash.hpp"

#include <algorithm>
#include <utility>

namespace tactus::view
{

namespace
{

std::size_t bytes_of(const RefinementState& state)
{
    std::size_t bytes = sizeof(dds::SeenState) + state.tools.size() * sizeof(RefinementStateTool) +
                        state.regions.size() * sizeof(RefinementStateRegion);
    for (const RefinementStateModel& model : state.models)
    {
        bytes += sizeof(model) + model.pages.size() * sizeof(RefinementStatePage) +
                 model.requested.size() * sizeof(ChunkId);
    }
    return bytes;
}

} // namespace

RefinementStateModel model_in(const RefinementState& state, const ContentHash& hash)
{
    const auto found = std::ranges::find(state.models, hash, &RefinementStateModel::hash);
    return found == state.models.end() ? RefinementStateModel{hash, {}, {}} : *found;
}

std::string id_text(const dds::ControllerId& id)
{
    return hash_text(id);
}

const LiveController* Snapshot::find(const std::string& id) const
{
    const auto found = std::ranges::find_if(controllers, [&](const LiveController& each)
                                            { return id.empty() || id_text(each.told.id) == id; });
    return found == controllers.end() ? nullptr : &*found;
}

void LiveState::publish(const std::vector<dds::WatchedController>& told)
{
    const std::lock_guard lock(mutex_);
    const auto is_known = [](const LiveController& live, const dds::WatchedController& now)
    { return live.told.id == now.id && live.told.serial == now.serial; };
    if (std::ranges::equal(snapshot_->controllers, told, is_known))
    {
        return;
    }
    auto next = std::make_shared<Snapshot>();
    next->serial = snapshot_->serial + 1;
    std::erase_if(
        kept_, [&](const auto& each)
        { return std::ranges::find(told, each.first, &dds::WatchedController::id) == told.end(); });
    for (const dds::WatchedController& controller : told)
    {
        keep(controller);
        LiveController& live = next->controllers.emplace_back();
        live.told = controller;
        for (const auto& [number, object] : kept_[controller.id].objects)
        {
            live.objects.push_back(object);
        }
    }
    snapshot_ = std::move(next);
    news_.notify_all();
}

/// Stores a new refinement state, and updates the stored objects. Objects with numbers in the range
/// that the telemetry lists in full, but which it lacks, were removed.
void LiveState::keep(const dds::WatchedController& controller)
{
    Kept& kept = kept_[controller.id];
    kept.objects.erase(kept.objects.lower_bound(controller.objects.sweep_begin),
                       kept.objects.lower_bound(controller.objects.sweep_end));
    for (const ObjectTelemetry& object : controller.objects.objects)
    {
        kept.objects.insert_or_assign(object.number, object);
    }
    if (controller.state == nullptr ||
        (!kept.states.empty() && kept.states.back()->serial == controller.state->serial))
    {
        return;
    }
    kept.states.push_back(controller.state);
    kept.bytes += bytes_of(controller.state->state);
    const std::size_t share = kStateBytes / kept_.size();
    while (kept.states.size() > kStates || (kept.bytes > share && kept.states.size() > 1))
    {
        kept.bytes -= bytes_of(kept.states.front()->state);
        kept.states.pop_front();
    }
}

std::shared_ptr<const Snapshot> LiveState::newest() const
{
    const std::lock_guard lock(mutex_);
    return snapshot_;
}

std::shared_ptr<const Snapshot> LiveState::wait_newer(std::uint64_t seen,
                                                      std::chrono::milliseconds patience) const
{
    std::unique_lock lock(mutex_);
    news_.wait_for(lock, patience, [&] { return snapshot_->serial > seen; });
    return snapshot_;
}

StatePointer LiveState::state(const std::string& controller, std::uint64_t serial) const
{
    const std::lock_guard lock(mutex_);
    for (const auto& [id, kept] : kept_)
    {
        if (id_text(id) != controller)
        {
            continue;
        }
        const auto found = std::ranges::find(kept.states, serial, &dds::SeenState::serial);
        return found == kept.states.end() ? nullptr : *found;
    }
    return nullptr;
}

} // namespace tactus::view
