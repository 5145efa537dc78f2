// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/resting.hpp"

#include "rt_core/frame/frame_parts.hpp"

#include <algorithm>

namespace tactus
{

bool Resting::try_rest(const FrameParts& parts, FrameAccount& account) const noexcept
{
    if (!may_rest_ || !parts.rules.variant.lets_frames_rest)
    {
        return false;
    }
    const ToolSet& tools = parts.tools;
    for (std::uint32_t i = 0; i < tools.size(); ++i)
    {
        if (tools.status(i).is_resident && !tools[i].is_settled())
        {
            return false;
        }
    }
    for (std::uint32_t i = 0; i < tools.size(); ++i)
    {
        account.faults |= frame_faults(tools.outputs()[i]);
        account.faults |=
            tools.status(i).exceeds_capacity ? FrameFault::scene_over_capacity : FrameFault::none;
    }
    account.work.skipped.add(Skip::frames);
    return true;
}

void Resting::find_tools(FrameParts& parts, FrameAccount& account) noexcept
{
    const ToolSet& tools = parts.tools;
    for (std::uint32_t i = 0; i < tools.size(); ++i)
    {
        ToolStatus& status = parts.tools.status(i);
        status.rests = status.is_resident && parts.rules.variant.lets_tools_rest &&
                       tools[i].is_settled() &&
                       std::max(status.clear_m, 0.0) == tools.outputs()[i].clear_m &&
                       std::ranges::all_of(parts.pairs.of(i),
                                           [](const Pair* pair) { return pair->is_unchanged(); });
        account.work.skipped.add(Skip::tools, status.rests ? 1 : 0);
    }
}

void Resting::end_frame(FrameParts& parts) noexcept
{
    may_rest_ = true;
    for (std::uint32_t i = 0; i < parts.tools.size(); ++i)
    {
        const ToolStatus& status = parts.tools.status(i);
        may_rest_ = may_rest_ && (status.rests || !status.is_resident);
    }
    for (const ModelId id : parts.models.busy())
    {
        may_rest_ = may_rest_ && parts.models[id].is_complete();
    }
    if (parts.rules.variant.asks_near_models_only)
    {
        parts.models.let_rest(parts.rules.frame);
    }
}

} // namespace tactus
