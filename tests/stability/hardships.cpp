// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/hardships.hpp"

#include "tests/stability/trial_terms.hpp"

#include <cstdlib>

namespace tactus::test
{

namespace
{

/// Ample for a model of some thousand faces, and for the neighbourhood of a tool on any other.
constexpr std::size_t kAmple = std::size_t{8} << 20U;

Budgets with_splits(std::uint32_t splits)
{
    Budgets budgets;
    budgets.splits = splits;
    budgets.merges = splits;
    return budgets;
}

/// Third of the work of a frame at 4 kHz.
Budgets with_little_work()
{
    Budgets budgets;
    budgets.work = Budgets::work_of(125'000, 1) / 3;
    return budgets;
}

LoopbackFaults lossy_link()
{
    LoopbackFaults faults;
    faults.loss = 0.2;
    faults.duplicates = 0.1;
    faults.damage = 0.05;
    faults.mix_ups = 0.05;
    faults.delay_polls_min = 20;
    faults.delay_polls_max = 200;
    return faults;
}

LoopbackFaults late_link()
{
    LoopbackFaults faults;
    faults.delay_polls_min = 40;
    faults.delay_polls_max = 400;
    return faults;
}

RigOptions with_pools(std::size_t pool_bytes, std::size_t pages = 0)
{
    RigOptions options;
    options.pool_bytes = pool_bytes;
    options.cache_bytes = pages * sizeof(Page);
    return options;
}

RigOptions with_link(const LoopbackFaults& faults)
{
    RigOptions options = with_pools(kAmple);
    options.faults = faults;
    return options;
}

RigOptions without_cache()
{
    RigOptions options = with_pools(kAmple);
    options.cache_off = true;
    return options;
}

RigOptions kept_whole()
{
    RigOptions options = with_pools(4 * kAmple);
    options.static_when_it_fits = true;
    return options;
}

/// Pools for little more than the base mesh and some pages.
std::size_t least_pools(const TestModel& model)
{
    return (std::size_t{512} << 10U) + model.faces.size() / 4 + 400 * std::size_t{model.base_faces};
}

} // namespace

std::vector<Hardship> hardships(const TestModel& model)
{
    const Budgets starved{4, 4, 8, 12, 60, 1, 2, 1};
    const Budgets usual;
    return {{"usual", usual, with_pools(kAmple), 0.01, true},
            {"point", usual, with_pools(kAmple), 0.0},
            {"K-1", with_splits(1), with_pools(kAmple)},
            {"K-4", with_splits(4), with_pools(kAmple)},
            {"starved", starved, with_pools(kAmple)},
            {"small-pools", usual, with_pools(least_pools(model))},
            {"few-pages", usual, with_pools(kAmple, 5)},
            {"no-cache", usual, without_cache()},
            {"lossy-link", usual, with_link(lossy_link())},
            {"late-link", usual, with_link(late_link())},
            {"in-the-tool", usual, with_pools(kAmple, 12), 2.0},
            {"static", usual, kept_whole()},
            {"little-work", with_little_work(), with_pools(kAmple)}};
}

Hardship hardship_named(const TestModel& model, std::string_view name)
{
    for (const Hardship& hardship : hardships(model))
    {
        if (hardship.name == name)
        {
            return hardship;
        }
    }
    std::abort();
}

RigOptions with_tool(RigOptions options, double radius_m)
{
    options.tools = {{radius_m, kWall_n_per_m, kForceMax_n, 1.0}};
    return options;
}

} // namespace tactus::test
