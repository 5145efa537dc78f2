// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/frame.hpp"

#include "rt_core/frame/force_stage.hpp"

#include <algorithm>

namespace tactus
{

Result<Done, FrameRefusal> Frame::start(std::optional<Frame>& frame, Arena& arena,
                                        const FrameSetup& setup) noexcept
{
    if (const std::optional<FrameRefusal> refusal = find_refusal(setup))
    {
        return *refusal;
    }
    if (!arena.is_measuring() && arena.left() < required_bytes(setup))
    {
        return FrameRefusal::memory_too_small;
    }
    frame.emplace(PassKey{}, arena, setup);
    if (frame->model_count() != setup.models.size())
    {
        frame.reset();
        return FrameRefusal::base_refused;
    }
    return Done{};
}

std::size_t Frame::required_bytes(const FrameSetup& setup) noexcept
{
    Arena arena = Arena::measuring();
    const Frame measured(PassKey{}, arena, setup);
    return arena.used();
}

Frame::Frame(PassKey /*key*/, Arena& arena, const FrameSetup& setup) noexcept
    : parts_(arena, setup)
    , changes_(arena, setup)
    , neighbours_(arena, setup)
    , loading_(setup)
    , refinement_(std::ranges::any_of(setup.tools, &is_mesh))
    , narrow_(arena, setup)
{
    // If a model is missing, start() refuses this frame.
    if (!arena.is_measuring() && parts_.models.size() == setup.models.size())
    {
        SceneChanges::place_first(setup, parts_, neighbours_);
    }
}

FrameOutput Frame::run(const FrameInput& input, StageMark mark) noexcept
{
    begin(input);
    changes_.make(input.changes, parts_, neighbours_, account_.scene);
    if (!input.edits.empty())
    {
        edits_.apply(input.edits, parts_, account_);
    }
    account_.faults |= parts_.tools.begin(input.tools, parts_.pairs, parts_.rules.period_ns);
    const bool is_same_scene = input.changes.empty() && input.edits.empty();
    if (is_same_scene && resting_.try_rest(parts_, account_))
    {
        // Arrivals are adopted even so: slots must not wait in the queue until a tool moves. Every
        // stage ends, so that the caller has times of all.
        parts_.pools.cache.adopt_arrivals(input.budgets.pages, parts_.rules.frame, account_.work);
        for (const Stage stage :
             {Stage::load, Stage::refine, Stage::refit, Stage::query, Stage::force})
        {
            mark(stage);
        }
        return output();
    }
    neighbours_.find(parts_, account_);
    place_pairs();
    account_.shares.begin_loading();
    loading_.run(parts_, account_);
    mark(Stage::load);
    account_.shares.begin_refining();
    const std::uint32_t refused = refinement_.run(parts_, account_);
    shedding_.learn(std::min(refused, parts_.pools.cache.refused_class()));
    mark(Stage::refine);
    parts_.models.refit(!parts_.rules.variant.refits_changed_only, account_.work, account_.faults);
    mark(Stage::refit);
    account_.shares.begin_queries();
    Resting::find_tools(parts_, account_);
    narrow_.run(parts_, account_);
    mark(Stage::query);
    account_.shares.begin_forces();
    render_forces(parts_, narrow_, account_);
    account_.shares.end();
    parts_.pairs.report();
    parts_.models.report();
    resting_.end_frame(parts_);
    mark(Stage::force);
    return output();
}

void Frame::warm_caches() noexcept
{
    narrow_.warm_caches(parts_, account_);
}

void Frame::begin(const FrameInput& input) noexcept
{
    account_.begin(input.budgets);
    ++parts_.rules.frame;
    parts_.rules.now_ns = input.now_ns;
    parts_.rules.work = &account_.work.budget;
    parts_.pools.cache.forget_taken();
}

/// Updates each pair for this frame's poses, and orders the pairs by priority.
void Frame::place_pairs() noexcept
{
    for (Pair* pair : parts_.pairs.all())
    {
        pair->place(account_.budgets);
    }
    edits_.notify_pairs(parts_);
    parts_.pairs.order();
    const bool is_shed = shedding_.shed(parts_.pairs.by_priority());
    account_.faults |= is_shed ? FrameFault::pair_shed : FrameFault::none;
}

FrameOutput Frame::output() const noexcept
{
    return {parts_.tools.outputs(), parts_.pairs.outputs(), parts_.models.outputs(),
            account_.work,          account_.faults,        parts_.pools.cache.taken(),
            account_.scene};
}

} // namespace tactus
