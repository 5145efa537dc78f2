// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/model.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Room for a frame's splits and merges and, at the start, for the base mesh.
std::uint32_t change_capacity(const ModelCounts& counts) noexcept
{
    const std::uint32_t per_frame = kMaxStarFaces * (kMaxSplitsPerFrame + kMaxMergesPerFrame);
    return std::max(per_frame, counts.base_faces);
}

std::uint32_t wish_capacity(const ModelCapacities& capacities) noexcept
{
    return capacities.pages + capacities.index_pages;
}

/// Share of the memory that goes to pages unless the caller says how much, in percent: a page is
/// mostly prefetched, an active face costs a tenth of a record's page.
constexpr std::size_t kPageShare = 62;
/// The least number of active faces beyond the base mesh that is worth starting with.
constexpr std::uint32_t kMinFaces = 256;

/// Blocks are about two thirds full, so 11 faces; twice that many for thin cuts.
std::uint32_t blocks_for(std::uint32_t faces) noexcept
{
    return faces / 8 + 2 * AbTree::kReserve;
}

/// With faces given, the other sizes of the tree follow.
ModelCapacities with_faces(ModelCapacities capacities, std::uint32_t faces) noexcept
{
    capacities.faces = faces;
    capacities.blocks = blocks_for(faces);
    capacities.nodes = capacities.blocks / 2 + 2 * AbTree::kReserve;
    return capacities;
}

} // namespace

std::size_t required_bytes(const ModelHeader& header, const ModelCapacities& capacities) noexcept
{
    Arena arena = Arena::measuring();
    const PageSlots slots =
        PageSlots::take(arena, header.counts(), capacities.pages, capacities.index_pages);
    const Model model(arena, header, slots, capacities);
    return arena.used();
}

ModelCapacities plan_capacities(const ModelHeader& header, std::size_t bytes,
                                std::size_t cache_bytes) noexcept
{
    const ModelCounts counts = header.counts();
    ModelCapacities capacities;
    capacities.index_pages = std::clamp(counts.index_pages(), 1U, kMaxResidentIndexPages);
    const std::size_t page_share = cache_bytes > 0 ? cache_bytes : bytes / 100 * kPageShare;
    capacities.pages = static_cast<std::uint32_t>(
        std::min<std::size_t>(std::max(counts.chunks(), 1U), page_share / sizeof(Page)));
    // Faces beyond the whole model are of no use; below the base mesh there is no model.
    const std::uint32_t all_faces = std::max(counts.face_ids(), kMinFaces);
    const std::uint32_t least_faces = counts.base_faces + kMinFaces;
    if (capacities.pages == 0 ||
        required_bytes(header, with_faces(capacities, least_faces)) > bytes)
    {
        return {};
    }
    std::uint32_t fits = least_faces;
    for (std::uint32_t too_many = all_faces + least_faces; too_many - fits > 1;)
    {
        const std::uint32_t middle = fits + (too_many - fits) / 2;
        (required_bytes(header, with_faces(capacities, middle)) <= bytes ? fits : too_many) =
            middle;
    }
    return with_faces(capacities, fits);
}

Model::Model(Arena& arena, const ModelHeader& model_header, PageSlots model_slots,
             const ModelCapacities& model_capacities) noexcept
    : header(model_header)
    , capacities(model_capacities)
    , slots(model_slots)
    , inbox(arena, capacities.pages, capacities.index_pages, wish_capacity(capacities))
    , linker(arena, header.counts(), slots)
    , pages(arena, slots)
    , cache(arena, header, slots, pages, inbox)
    , forest(arena, header.counts(), slots, pages, capacities.faces,
             change_capacity(header.counts()))
    , tree(arena, {capacities.faces, capacities.blocks, capacities.nodes}, header.quantum_m())
    , refiner(arena, forest, pages, tree, header.quantum_m())
{
}

void Model::refit(WorkCounters& work, FrameFault& faults) noexcept
{
    // Backwards: a face that finds its place leaves the list.
    for (std::size_t i = tree.unplaced().size(); i-- > 0;)
    {
        if (const PrimId prim = tree.unplaced()[i]; !forest.is_changed(prim))
        {
            tree.apply(forest.describe(prim));
        }
    }
    for (const PrimId prim : forest.changed_prims())
    {
        tree.apply(forest.describe(prim));
    }
    forest.clear_changes();
    const AbTree::RefitWork refitted = tree.refit();
    work.blocks_refitted += refitted.blocks;
    work.nodes_refitted += refitted.nodes;
    faults |= tree.is_complete() ? FrameFault::none : FrameFault::tree_full;
}

} // namespace tactus
