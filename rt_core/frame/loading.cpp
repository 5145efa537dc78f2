// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/loading.hpp"

#include "rt_core/frame/frame_parts.hpp"

namespace tactus
{

namespace
{

/// Marks the models of all pairs as having a pair in this frame.
void wake_models(FrameParts& parts, WorkCounters& work) noexcept
{
    ModelSet& models = parts.models;
    for (const Pair* pair : parts.pairs.all())
    {
        models.wake(pair->parts().model.id, parts.rules.frame);
        if (pair->parts().tool_model.model != nullptr)
        {
            models.wake(pair->parts().tool_model.id, parts.rules.frame);
        }
    }
    work.skipped.add(Skip::models,
                     models.size() - static_cast<std::uint32_t>(models.busy().size()));
}

} // namespace

Loading::Loading(const FrameSetup& setup) noexcept
{
    if (setup.for_streamed_models.base_cells > 0)
    {
        life_.emplace(setup.period_ns);
    }
}

void Loading::run(FrameParts& parts, FrameAccount& account) noexcept
{
    auto& [budgets, shares, work, faults, scene] = account;
    ModelSet& models = parts.models;
    const std::uint32_t frame = parts.rules.frame;
    wake_models(parts, work);
    rank(parts.pairs.by_priority());
    faults |= ranking_.lacks_present ? FrameFault::ranking_full : FrameFault::none;
    parts.pools.cache.adopt_arrivals(budgets.pages, frame, work);
    if (life_)
    {
        life_->advance(models, parts.pairs.by_priority(), frame, work);
    }
    for (std::uint32_t i = 0; i < models.busy().size(); ++i)
    {
        const ModelId id = models.in_turn(i, frame);
        models[id].load(id, ranking_, budgets, frame, work, faults);
    }
}

void Loading::rank(std::span<Pair* const> order) noexcept
{
    ranking_.clear();
    ranking_.lacks_present = false;
    for (Pair* pair : order)
    {
        pair->rank(ranking_);
    }
    for (const Pair* pair : order)
    {
        pair->rank_distance(ranking_);
    }
}

} // namespace tactus
