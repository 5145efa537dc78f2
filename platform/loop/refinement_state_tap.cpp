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
    copy_.budgets = shown.budgets;
    copy_.tools.clear();
    for (const ToolForce& force : shown.forces)
    {
        copy_.tools.push_back({force.state, force.causes});
    }
    copy_times(statistics);
    pages_.update_copy(copy_.slots);
    copy_regions(shown.regions);
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

void RefinementStateTap::copy_regions(std::span<const RankedRegion> regions) noexcept
{
    const std::size_t shown = std::min(regions.size(), kMaxStateRegions);
    copy_.regions.clear();
    for (const RankedRegion& region : regions.first(shown))
    {
        copy_.regions.push_back(shown_region_of(region));
    }
    copy_.regions_left_out = static_cast<std::uint32_t>(regions.size() - shown);
}

} // namespace tactus::hrtc
