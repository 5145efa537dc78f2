// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/narrow_phase.hpp"

#include "rt_core/frame/frame_parts.hpp"

#include <algorithm>

namespace tactus
{

NarrowPhase::NarrowPhase(Arena& arena, const FrameSetup& setup) noexcept
{
    const std::size_t triangles =
        kMaxLocalTriangles * std::min<std::size_t>(capacities_of(setup).pairs, kLocalSurfaces);
    room_ = {arena.take<LocalTriangle>(triangles), arena.take<double>(triangles)};
}

void NarrowPhase::run(FrameParts& parts, FrameAccount& account) noexcept
{
    WorkCounters& work = account.work;
    walked_ = {};
    room_left_ = room_;
    query_work_.fill(0);
    const std::span<Pair* const> order = parts.pairs.by_priority();
    for (std::size_t i = 0; i < order.size(); ++i)
    {
        Pair* const pair = order[i];
        if (parts.tools.status(pair->tool()).rests)
        {
            continue;
        }
        const Walked before = walked_in(work);
        const std::uint32_t used = work.budget.used();
        account.shares.begin_query(static_cast<std::uint32_t>(order.size() - 1 - i));
        room_left_ = pair->query(room_left_, left_of(account.budgets), work, account.faults);
        if (!pair->is_of_mesh())
        {
            count(before, work);
        }
        query_work_[pair->tool()] += work.budget.used() - used;
    }
}

bool NarrowPhase::try_again(FrameParts& parts, std::uint32_t tool, FrameAccount& account) noexcept
{
    const Budgets& whole = account.budgets;
    if (account.work.budget.left() < query_work_[tool])
    {
        return false;
    }
    for (Pair* pair : parts.pairs.of(tool))
    {
        const Budgets left = pair->is_of_mesh() ? whole : left_of(whole);
        if (left.nodes < whole.nodes || left.triangles < whole.triangles)
        {
            return false;
        }
        const Walked before = walked_in(account.work);
        room_left_ = pair->query_again(room_left_, left, account.work, account.faults);
        if (!pair->is_of_mesh())
        {
            count(before, account.work);
        }
    }
    return true;
}

void NarrowPhase::warm_caches(const FrameParts& parts, const FrameAccount& account) const noexcept
{
    WorkBudget work = account.shares.for_warming();
    for (const Pair* pair : parts.pairs.all())
    {
        pair->warm_caches(room_, account.budgets, work);
    }
}

NarrowPhase::Walked NarrowPhase::walked_in(const WorkCounters& work) noexcept
{
    return {work.nodes_visited, work.triangles_tested};
}

Budgets NarrowPhase::left_of(const Budgets& budgets) const noexcept
{
    Budgets left = budgets;
    left.nodes = walk_left(budgets.nodes, walked_.nodes);
    left.triangles = walk_left(budgets.triangles, walked_.triangles);
    return left;
}

void NarrowPhase::count(const Walked& before, const WorkCounters& now) noexcept
{
    walked_.nodes += now.nodes_visited - before.nodes;
    walked_.triangles += now.triangles_tested - before.triangles;
}

} // namespace tactus
