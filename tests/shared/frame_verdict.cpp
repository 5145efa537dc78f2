// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/frame_verdict.hpp"

#include <array>
#include <span>

namespace tactus::test
{

namespace
{

/// Models share their pools: one may exceed its share while another is below.
Verdict overfull(std::span<const ModelOutput> models, PoolUse ModelOutput::*pool)
{
    std::uint64_t used = 0;
    std::uint64_t capacity = 0;
    for (const ModelOutput& model : models)
    {
        const PoolUse& use = model.*pool;
        if (use.used > use.used_max || (models.size() == 1 && use.used_max > use.capacity))
        {
            return "a pool of " + std::to_string(use.capacity) + " had " +
                   std::to_string(use.used) + " in use, at most " + std::to_string(use.used_max);
        }
        used += use.used;
        capacity += use.capacity;
    }
    if (used > capacity)
    {
        return "pools of " + std::to_string(capacity) + " had " + std::to_string(used) + " in use";
    }
    return std::nullopt;
}

} // namespace

Verdict broken_budget(const FrameOutput& output, const Budgets& budgets)
{
    struct Count
    {
        const char* name;
        std::uint32_t value;
        std::uint32_t most;
    };
    const WorkCounters& work = output.work;
    // A second query of the frame has an allowance of its own, as for other tools.
    constexpr std::uint32_t kOfMesh = 4 * kMeshRefineFactor + 2 * kMeshBudgetFactor + 2;
    const std::uint32_t walks = 2 * kFrameWalks + (output.pairs[0].mesh != nullptr ? kOfMesh : 0);
    const std::array<Count, 10> counts{{
        {"splits", work.splits, budgets.splits},
        {"merges", work.merges, budgets.merges},
        {"scanned", work.scanned, budgets.scanned},
        {"nodes visited", work.nodes_visited, walks * budgets.nodes},
        {"triangles tested", work.triangles_tested, walks * budgets.triangles},
        {"planes looked at", work.planes_looked_at, kFrameWalks * budgets.planes},
        {"pages adopted", work.pages_adopted, budgets.pages},
        {"requests", work.requests, budgets.requests + budgets.regions}, // Includes index pages.
        {"regions searched", work.regions_searched, budgets.regions},
        {"work", work.budget.used(), WorkBudget::most_of(budgets.work)},
    }};
    for (const Count& count : counts)
    {
        if (count.value > count.most)
        {
            return std::string(count.name) + ": " + std::to_string(count.value) + ", allowed are " +
                   std::to_string(count.most);
        }
    }
    for (PoolUse ModelOutput::*const pool :
         {&ModelOutput::pages, &ModelOutput::index_pages, &ModelOutput::faces, &ModelOutput::blocks,
          &ModelOutput::nodes})
    {
        if (const Verdict verdict = overfull(output.models, pool))
        {
            return verdict;
        }
    }
    return std::nullopt;
}

Verdict unexplained(const FrameOutput& output)
{
    constexpr FrameFault kReasons = FrameFault::split_budget_spent | FrameFault::forest_full |
                                    FrameFault::tree_full | FrameFault::chunk_late |
                                    FrameFault::cache_full | FrameFault::node_budget_spent |
                                    FrameFault::refine_heap_full;
    if (has_fault(output.faults, FrameFault::model_inconsistent))
    {
        return "a record is said to contradict the mesh";
    }
    const PairOutput& pair = output.pairs[0];
    if (pair.kind != AnswerKind::bounded || has_fault(output.faults, kReasons))
    {
        return std::nullopt;
    }
    return "a bounded answer, and nothing is said to have run out: L " +
           std::to_string(pair.lower_m) + ", U " + std::to_string(pair.upper_m) +
           ", certified to " + std::to_string(pair.certified_radius_m) + ", faults " +
           std::to_string(static_cast<std::uint32_t>(output.faults)) + ", splits " +
           std::to_string(output.work.splits) + ", nodes " +
           std::to_string(output.work.nodes_visited) + ", triangles " +
           std::to_string(output.work.triangles_tested);
}

} // namespace tactus::test
