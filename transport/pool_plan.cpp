// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/pool_plan.hpp"

#include "rt_core/base/arena.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/frame/frame.hpp"
#include "transport/chunk_loader.hpp"

#include <algorithm>
#include <vector>

namespace tactus
{

namespace
{

constexpr std::size_t kStep = std::size_t{64} << 10U;
/// Share of pages in the memory of streamed models beyond the minimum, in percent.
constexpr std::size_t kPagesOfStreamedModels = 60;
/// Index pages of streamed models get 1 / kIndexShare of all memory, as those of resident models
/// do.
constexpr std::size_t kIndexShare = 64;
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
    // The ChunkLoader's memory depends on the number of pages, which depends on the memory left
    // beside the ChunkLoader. If the first estimate does not fit, a bisection finds the least value
    // that does.
    std::size_t too_little = 0;
    std::size_t too_much = bytes - common;
    std::size_t chunk_loader = 0;
    for (;;)
    {
        if (try_plan(headers, bytes - common - chunk_loader, cache_bytes, capacities))
        {
            const ModelCapacities sum = sum_of(capacities);
            const std::size_t needed = ChunkLoader::required_bytes(sum.pages, sum.index_pages);
            if (needed <= chunk_loader)
            {
                return true;
            }
            too_little = chunk_loader;
            chunk_loader = std::min(needed, too_much);
        }
        else
        {
            too_much = chunk_loader;
        }
        if (too_much - too_little <= 1)
        {
            return false;
        }
        if (chunk_loader == too_much)
        {
            chunk_loader = too_little + (too_much - too_little) / 2;
        }
    }
}

bool try_plan_streamed_models(const FrameSetup& setup, std::span<const ModelHeader> headers,
                              std::size_t bytes, std::size_t cache_bytes, ModelCapacities& room)
{
    std::uint32_t largest = 0;
    std::uint64_t sum = 0;
    for (const ModelHeader& header : headers)
    {
        const std::uint32_t cells = BaseMesh::cells_of(header.counts());
        largest = std::max(largest, cells);
        sum += cells;
    }
    const auto count = static_cast<std::uint32_t>(headers.size());
    const auto mean = static_cast<std::uint32_t>((sum + count - 1) / count);
    const auto index_pages = std::max<std::uint32_t>(
        kLeastResidentIndexPages,
        static_cast<std::uint32_t>(bytes / kIndexShare / sizeof(IndexPage)));
    const auto needed_for = [&](std::uint32_t meshes, std::uint32_t pages)
    {
        room = streamed_model_room(meshes, std::max(largest, meshes * mean), pages, index_pages);
        FrameSetup with_room = setup;
        with_room.for_streamed_models = room;
        return Frame::required_bytes(with_room) + ChunkLoader::required_bytes(pages, index_pages);
    };
    const std::size_t least = needed_for(1, 1);
    if (least > bytes)
    {
        return false;
    }
    const std::size_t a_page = needed_for(1, 2) - std::min(needed_for(1, 1), needed_for(1, 2));
    const std::size_t for_pages = cache_bytes > 0 ? cache_bytes / sizeof(Page) * a_page
                                                  : (bytes - least) / 100 * kPagesOfStreamedModels;
    const auto pages = static_cast<std::uint32_t>(1 + std::min(for_pages, bytes - least) /
                                                          std::max<std::size_t>(a_page, 1));
    std::uint32_t fits = 0;
    std::uint32_t too_many = count + 1;
    while (too_many - fits > 1)
    {
        const std::uint32_t middle = fits + (too_many - fits) / 2;
        (needed_for(middle, pages) <= bytes ? fits : too_many) = middle;
    }
    return fits > 0 && needed_for(fits, pages) <= bytes;
}

std::size_t least_pool_bytes(const FrameSetup& setup, std::span<const ModelHeader> headers,
                             std::size_t cache_bytes, std::span<const std::uint32_t> edit_faces)
{
    TACTUS_ASSERT(edit_faces.empty() || edit_faces.size() == headers.size());
    const auto does_fit = [&](std::size_t steps)
    {
        std::vector<ModelCapacities> capacities(headers.size());
        for (std::size_t i = 0; i < edit_faces.size(); ++i)
        {
            capacities[i].edit_faces = edit_faces[i];
        }
        return try_plan_pools(setup, headers, steps * kStep, cache_bytes, capacities);
    };
    std::size_t too_small = 0;
    std::size_t enough = 1;
    while (!does_fit(enough))
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
        (does_fit(middle) ? enough : too_small) = middle;
    }
    return enough * kStep;
}

} // namespace tactus
