// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/pool_plan.hpp"

#include "rt_core/base/arena.hpp"
#include "rt_core/frame/frame.hpp"
#include "transport/courier.hpp"

#include <algorithm>
#include <vector>

namespace tactus
{

namespace
{

constexpr std::size_t kStep = std::size_t{64} << 10U;
constexpr std::size_t kMostSteps = (std::size_t{1} << 40U) / kStep;

} // namespace

bool try_plan_pools(const FrameSetup& setup, std::span<const ModelHeader> headers,
                    std::size_t bytes, std::size_t cache_bytes,
                    std::span<ModelCapacities> capacities)
{
    std::size_t common = Frame::required_bytes(setup);
    for (const ModelHeader& header : headers)
    {
        common += Arena::round_up(header.fields().header_bytes);
    }
    if (common >= bytes)
    {
        return false;
    }
    // What the courier needs follows from the number of pages, and that from what is left beside
    // it: mostly the first guess does, and else halving finds the least that does.
    std::size_t too_little = 0;
    std::size_t too_much = bytes - common;
    std::size_t courier = 0;
    for (;;)
    {
        if (try_plan(headers, bytes - common - courier, cache_bytes, capacities))
        {
            const ModelCapacities sum = sum_of(capacities);
            const std::size_t needed = Courier::required_bytes(sum.pages, sum.index_pages);
            if (needed <= courier)
            {
                return true;
            }
            too_little = courier;
            courier = std::min(needed, too_much);
        }
        else
        {
            too_much = courier;
        }
        if (too_much - too_little <= 1)
        {
            return false;
        }
        if (courier == too_much)
        {
            courier = too_little + (too_much - too_little) / 2;
        }
    }
}

std::size_t least_pool_bytes(const FrameSetup& setup, std::span<const ModelHeader> headers,
                             std::size_t cache_bytes)
{
    std::vector<ModelCapacities> capacities(headers.size());
    std::size_t too_small = 0;
    std::size_t enough = 1;
    while (!try_plan_pools(setup, headers, enough * kStep, cache_bytes, capacities))
    {
        if (enough >= kMostSteps)
        {
            return 0;
        }
        too_small = enough;
        enough *= 2;
    }
    while (enough - too_small > 1)
    {
        const std::size_t middle = too_small + (enough - too_small) / 2;
        const bool fits = try_plan_pools(setup, headers, middle * kStep, cache_bytes, capacities);
        (fits ? enough : too_small) = middle;
    }
    return enough * kStep;
}

} // namespace tactus
