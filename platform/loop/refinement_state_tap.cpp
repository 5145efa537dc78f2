// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/refinement_state_tap.hpp"

#include "rt_core/frame/frame.hpp"
#include "rt_core/scene/object_table.hpp"

#include <algorithm>

namespace tactus::hrtc
{

RefinementStateTap::RefinementStateTap(PagePool& pages, std::size_t most_slots) : pages_(pages)
{
    const std::span<const PageMeta> shown =
        pages.metas.first(std::min(pages.metas.size(), most_slots));
    // Converts each slot to the part that viewers get.
    copy_.slots.assign(shown.begin(), shown.end());
    copy_.slots_left_out = static_cast<std::uint32_t>(pages.metas.size() - shown.size());
}

void RefinementStateTap::copy(const ShownFront& shown, const RunStatistics& statistics) noexcept
{
    copy_.frame = shown.frame + 1;
    copy_.start = shown.start;
    copy_.budgets = shown.budgets;
    copy_.tools.clear();
    for (const ToolForce& force : shown.forces)
    {
        copy_.tools.push_back({force.state, force.causes});
    }
    copy_times(statistics);
    pages_.update_copy(copy_.slots);
    copy_objects(shown);
    copy_regions(shown.made.regions());
}

void RefinementStateTap::copy_times(const RunStatistics& statistics) noexcept
{
    const auto copied = [](const LatencyHistogram& times) {
        return RefinementStateCopy::Times{times.count(), times.mean_ns(), times.max()};
    };
    std::ranges::transform(statistics.stages, copy_.times.begin(), copied);
    copy_.times[kStages] = copied(statistics.frame);
    copy_.times[kStages + 1] = copied(statistics.cpu);
}

/// Copies the next kFrontSweep object numbers in turn, and the objects of awake pairs.
void RefinementStateTap::copy_objects(const ShownFront& shown) noexcept
{
    const ObjectTable& objects = shown.made.objects();
    copy_.sweep_begin = copy_.sweep_end < objects.capacity() ? copy_.sweep_end : 0;
    copy_.sweep_end = std::min(copy_.sweep_begin + kFrontSweep, objects.capacity());
    copy_.objects.clear();
    for (std::uint32_t number = copy_.sweep_begin; number < copy_.sweep_end; ++number)
    {
        copy_object(objects, number);
    }
    for (const PairOutput& pair : shown.output.pairs)
    {
        const bool is_there =
            std::ranges::find(copy_.objects.view(), pair.object,
                              &RefinementStateCopy::Object::number) != copy_.objects.view().end();
        if (!is_there && !copy_.objects.full())
        {
            copy_object(objects, pair.object);
        }
    }
}

void RefinementStateTap::copy_regions(std::span<const RankedRegion> regions) noexcept
{
    const std::size_t shown = std::min(regions.size(), kMaxStateRegions);
    copy_.regions.clear();
    for (const RankedRegion& region : regions.first(shown))
    {
        copy_.regions.push_back(front_region_of(region));
    }
    copy_.regions_left_out = static_cast<std::uint32_t>(regions.size() - shown);
}

void RefinementStateTap::copy_object(const ObjectTable& objects, std::uint32_t number) noexcept
{
    const Object& object = objects[number];
    if (object.is_resident)
    {
        copy_.objects.push_back({number, object.spec.model.value, object.pose});
    }
}

} // namespace tactus::hrtc
