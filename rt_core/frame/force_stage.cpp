// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/force_stage.hpp"

#include "rt_core/frame/frame_parts.hpp"
#include "rt_core/frame/narrow_phase.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

ToolOutput step(FrameParts& parts, std::uint32_t tool, double clear_m, std::uint32_t& planes,
                WorkBudget& work) noexcept
{
    work.spend(Tool::is_held_as_rigid(parts.tools[tool].spec()) ? WorkCost::rigid_step : 0);
    StaticVector<PlacedSurface, kMaxNear> near;
    for (Pair* pair : parts.pairs.of(tool))
    {
        if (pair->is_joined())
        {
            near.push_back(pair->placed());
        }
    }
    return parts.tools[tool].step(near.view(), clear_m, planes);
}

ToolOutput respond(FrameParts& parts, std::uint32_t index, NarrowPhase& narrow,
                   FrameAccount& account) noexcept
{
    Tool& tool = parts.tools[index];
    WorkCounters& work = account.work;
    const double clear_m = parts.tools.status(index).clear_m;
    double clear_left_m = clear_m;
    const std::uint32_t planes =
        std::min(walk_left(account.budgets.planes, work.planes_looked_at), account.shares.planes());
    std::uint32_t planes_left = planes;
    ToolOutput output = step(parts, index, clear_m, planes_left, work.budget);
    for (std::uint32_t i = 1; i < RigidProxy::kStepsPerFrame; ++i)
    {
        if (output.over_constrained || !tool.try_go_on(clear_left_m) ||
            !narrow.try_again(parts, index, account))
        {
            break;
        }
        const ToolOutput next = step(parts, index, clear_left_m, planes_left, work.budget);
        if (next.halted)
        {
            break; // The force of the step before stays, as its place is known.
        }
        output = next;
    }
    work.planes_looked_at += planes - planes_left;
    work.budget.spend((planes - planes_left) * WorkCost::plane);
    return tool.finish(output, clear_m);
}

/// True if the tool stops short of its goal because of an object without a pair, or a model that
/// isn't resident.
bool is_walled(const FrameParts& parts, std::uint32_t tool, const ToolOutput& output) noexcept
{
    return (output.halted || output.under_way) &&
           (parts.tools.status(tool).exceeds_capacity ||
            std::ranges::any_of(parts.pairs.of(tool),
                                [](const Pair* pair) { return pair->is_wall(); }));
}

} // namespace

void render_forces(FrameParts& parts, NarrowPhase& narrow, FrameAccount& account) noexcept
{
    for (std::uint32_t i = 0; i < parts.tools.size(); ++i)
    {
        const ToolStatus& status = parts.tools.status(i);
        ToolOutput& output = parts.tools.outputs()[i];
        if (!status.is_resident)
        {
            output = ToolOutput{};
            output.is_gone = true;
            continue;
        }
        if (!status.rests)
        {
            output = respond(parts, i, narrow, account);
        }
        account.faults |= frame_faults(output);
        account.scene.walled_tools += is_walled(parts, i, output) ? 1U : 0U;
    }
}

} // namespace tactus
