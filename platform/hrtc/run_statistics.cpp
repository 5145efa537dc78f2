// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/run_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::hrtc
{

namespace
{

/// How bad an answer is; a frame is as bad as its worst pair.
int badness(AnswerKind kind) noexcept
{
    switch (kind)
    {
    case AnswerKind::decided:
        return 0;
    case AnswerKind::exact:
        return 1;
    case AnswerKind::bracket:
        return 2;
    case AnswerKind::stale:
        return 3;
    }
    return 3;
}

} // namespace

void AnswerCounts::add(AnswerKind kind, double width_m) noexcept
{
    const bool is_inexact = kind == AnswerKind::bracket || kind == AnswerKind::stale;
    exact += kind == AnswerKind::exact ? 1 : 0;
    decided += kind == AnswerKind::decided ? 1 : 0;
    bracket += kind == AnswerKind::bracket ? 1 : 0;
    stale += kind == AnswerKind::stale ? 1 : 0;
    inexact_run_ = is_inexact ? inexact_run_ + 1 : 0;
    longest_inexact_run = std::max(longest_inexact_run, inexact_run_);
    width_max_m = is_inexact ? std::max(width_max_m, width_m) : width_max_m;
}

void ForceCounts::add(const ToolOutput& output, const ToolForce& force) noexcept
{
    max_n = std::max(max_n, force.sent_n.norm());
    max_step_n = std::max(max_step_n, (force.sent_n - last_n_).norm());
    last_n_ = force.sent_n;
    contact_frames += output.in_contact ? 1 : 0;
    frozen_frames += output.frozen ? 1 : 0;
    held_back_frames += output.held_back ? 1 : 0;
    surplus_max_j = std::max(surplus_max_j, force.conditioned.surplus_j);
    for (std::size_t bit = 0; bit < kForceActions; ++bit)
    {
        const auto action = static_cast<ForceAction>(1U << bit);
        conditioned[bit] += has_action(force.conditioned.actions, action) ? 1U : 0U;
    }
}

void BudgetRange::add(std::uint32_t budget, bool is_first) noexcept
{
    min = is_first ? budget : std::min(min, budget);
    max = std::max(max, budget);
    sum += budget;
}

RunStatistics::RunStatistics(std::size_t tool_count, std::size_t pair_count,
                             std::size_t model_count, Duration period)
    : deadlines(period), pairs(pair_count), tools(tool_count), models(model_count)
{
}

void RunStatistics::add(const FrameOutput& output, std::span<const ToolForce> forces,
                        const CycleMeasures& measures) noexcept
{
    const std::uint64_t index = frames++;
    for (std::size_t i = 0; i < kStages; ++i)
    {
        stages[i].record(measures.stage[i]);
    }
    frame.record(measures.frame);
    cpu.record(measures.cpu);
    wake.record(measures.cycle.wake_lateness);
    add_answers(output);
    add_work(output);
    add_budgets(measures);
    deadlines.add(index, measures, is_over_budget(output.work, measures.budgets));
    bool any_contact = false;
    for (std::size_t i = 0; i < tools.size(); ++i)
    {
        tools[i].add(output.tools[i], forces[i]);
        any_contact = any_contact || output.tools[i].in_contact;
    }
    contact_frames += any_contact ? 1 : 0;
    std::copy(output.models.begin(), output.models.end(), models.begin());
}

void RunStatistics::add_answers(const FrameOutput& output) noexcept
{
    AnswerKind worst = AnswerKind::decided;
    double widest_m = 0.0;
    for (std::size_t i = 0; i < pairs.size(); ++i)
    {
        const PairOutput& pair = output.pairs[i];
        const double width_m = pair.upper_m - pair.lower_m;
        pairs[i].add(pair.kind, width_m);
        if (badness(pair.kind) > badness(worst))
        {
            worst = pair.kind;
        }
        if (badness(pair.kind) > badness(AnswerKind::exact))
        {
            widest_m = std::max(widest_m, width_m);
        }
    }
    answers.add(worst, widest_m);
}

void RunStatistics::add_work(const FrameOutput& output) noexcept
{
    splits += output.work.splits;
    merges += output.work.merges;
    nodes_visited += output.work.nodes_visited;
    pages_adopted += output.work.pages_adopted;
    cache_hits += output.work.cache_hits;
    cache_misses += output.work.cache_misses;
    evictions += output.work.evictions;
    for (std::size_t bit = 0; bit < faults.size(); ++bit)
    {
        faults[bit] += (static_cast<std::uint32_t>(output.faults) >> bit) & 1U;
    }
}

void RunStatistics::add_budgets(const CycleMeasures& measures) noexcept
{
    for (std::size_t i = 0; i < budgets.size(); ++i)
    {
        budgets[i].add(measures.budgets.*kGovernedBudgets[i], frames == 1);
    }
    budgets_at_floor += measures.budgets_at_floor ? 1 : 0;
}

bool RunStatistics::is_over_budget(const WorkCounters& work, const Budgets& limits) const noexcept
{
    const auto models_count = static_cast<std::uint32_t>(models.size());
    // Each pair is walked twice: to refine and to answer.
    const auto walks = static_cast<std::uint32_t>(2 * pairs.size());
    return work.splits > models_count * limits.splits ||
           work.merges > models_count * limits.merges ||
           work.scanned > models_count * limits.scanned ||
           work.nodes_visited > walks * limits.nodes ||
           work.triangles_tested > walks * limits.triangles ||
           work.pages_adopted > models_count * limits.pages ||
           work.requests > models_count * (limits.requests + limits.regions) ||
           work.regions_searched > models_count * limits.regions;
}

} // namespace tactus::hrtc
