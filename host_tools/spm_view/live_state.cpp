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

std::size_t bytes_of(const RefinementState& front)
{
    std::size_t bytes = sizeof(dds::SeenFront) +
                        front.objects.size() * sizeof(RefinementStateObject) +
                        front.tools.size() * sizeof(RefinementStateTool) +
                        front.regions.size() * sizeof(RefinementStateRegion);
    for (const RefinementStateModel& model : front.models)
    {
        bytes += sizeof(model) + model.pages.size() * sizeof(RefinementStatePage) +
                 model.requested.size() * sizeof(ChunkId);
    }
    return bytes;
}

} // namespace

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

void LiveState::publish(const std::vector<dds::WatchedController>& told,
                        const std::vector<dds::SeenFront>& fronts)
{
    const std::lock_guard lock(mutex_);
    if (!is_news(told, fronts))
    {
        return;
    }
    auto next = std::make_shared<Snapshot>();
    next->serial = snapshot_->serial + 1;
    std::erase_if(
        kept_, [&](const auto& each)
        { return std::ranges::find(fronts, each.first, &dds::SeenFront::id) == fronts.end(); });
    std::erase_if(
        shown_, [&](const auto& each)
        { return std::ranges::find(told, each.first, &dds::WatchedController::id) == told.end(); });
    for (const dds::SeenFront& front : fronts)
    {
        keep(front);
    }
    for (const dds::WatchedController& controller : told)
    {
        LiveController& live = next->controllers.emplace_back();
        live.told = controller;
        auto& shown = shown_[controller.id];
        shown.erase(shown.lower_bound(controller.objects.sweep_begin),
                    shown.lower_bound(controller.objects.sweep_end));
        for (const ObjectTelemetry& object : controller.objects.objects)
        {
            shown.insert_or_assign(object.number, object);
        }
        for (const auto& [number, object] : shown)
        {
            live.shown.push_back(object);
        }
        if (const auto kept = kept_.find(controller.id); kept != kept_.end())
        {
            live.front = kept->second.fronts.back();
            for (const auto& [number, object] : kept->second.objects)
            {
                live.objects.push_back(object);
            }
        }
    }
    snapshot_ = std::move(next);
    news_.notify_all();
}

bool LiveState::is_news(const std::vector<dds::WatchedController>& told,
                        const std::vector<dds::SeenFront>& fronts) const
{
    const auto is_known = [](const LiveController& live, const dds::WatchedController& now)
    { return live.told.id == now.id && live.told.serial == now.serial; };
    const auto is_kept = [this](const dds::SeenFront& front)
    {
        const auto kept = kept_.find(front.id);
        return kept != kept_.end() && kept->second.fronts.back()->serial == front.serial;
    };
    return !std::ranges::equal(snapshot_->controllers, told, is_known) ||
           kept_.size() != fronts.size() || !std::ranges::all_of(fronts, is_kept);
}

void LiveState::keep(const dds::SeenFront& front)
{
    Kept& kept = kept_[front.id];
    if (!kept.fronts.empty() && kept.fronts.back()->serial == front.serial)
    {
        return;
    }
    kept.fronts.push_back(std::make_shared<const dds::SeenFront>(front));
    kept.bytes += bytes_of(front.front);
    const std::size_t share = kFrontBytes / kept_.size();
    while (kept.fronts.size() > kFronts || (kept.bytes > share && kept.fronts.size() > 1))
    {
        kept.bytes -= bytes_of(kept.fronts.front()->front);
        kept.fronts.pop_front();
    }
    add_objects(kept, front.front);
}

/// Updates the stored objects. Objects with numbers in the range that `front` lists in full, but
/// which it lacks, were removed.
void LiveState::add_objects(Kept& kept, const RefinementState& front)
{
    kept.objects.erase(kept.objects.lower_bound(front.sweep_begin),
                       kept.objects.lower_bound(front.sweep_end));
    for (const RefinementStateObject& object : front.objects)
    {
        kept.objects[object.number] = {object, front.models[object.model].hash};
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

FrontPointer LiveState::front(const std::string& controller, std::uint64_t serial) const
{
    const std::lock_guard lock(mutex_);
    for (const auto& [id, kept] : kept_)
    {
        if (id_text(id) != controller)
        {
            continue;
        }
        const auto found = std::ranges::find(kept.fronts, serial, &dds::SeenFront::serial);
        return found == kept.fronts.end() ? nullptr : *found;
    }
    return nullptr;
}

} // namespace tactus::view
