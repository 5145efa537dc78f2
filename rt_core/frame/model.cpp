// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/model.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

std::uint32_t wish_capacity(const ModelCapacities& capacities) noexcept
{
    return capacities.pages + capacities.index_pages;
}

/// Share of the memory that goes to pages, with what linking keeps of each, unless the caller says
/// how much, in percent: a page is mostly prefetched, an active face costs two thirds of a record.
constexpr std::size_t kPageShare = 70;
/// Index pages beyond the least number get this part of the memory at most.
constexpr std::size_t kIndexPageShare = 64;
/// Fewer pages are not worth starting with unless the caller says so.
constexpr std::uint32_t kMinPages = 16;
/// The least number of active faces beyond the base mesh that is worth starting with.
constexpr std::uint32_t kMinFaces = 256;

/// From the arrival of chunks to a certified surface, after a jump at 1.1 M faces some frames: what
/// is asked for has to be here this much before the tool is.
constexpr double kRefineTime_s = 0.008;
/// No hand can be predicted for longer.
constexpr double kLongestLead_s = 0.15;

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
    const Model model(arena, header, slots, capacities, portable_kernels());
    return arena.used();
}

ModelCapacities plan_capacities(const ModelHeader& header, std::size_t bytes,
                                std::size_t cache_bytes) noexcept
{
    const ModelCounts counts = header.counts();
    ModelCapacities capacities;
    const auto index_pages_max = std::max<std::size_t>(kLeastResidentIndexPages,
                                                       bytes / kIndexPageShare / sizeof(IndexPage));
    capacities.index_pages = static_cast<std::uint32_t>(
        std::clamp<std::size_t>(counts.index_pages(), 1, index_pages_max));
    const std::size_t fitting =
        cache_bytes > 0 ? cache_bytes / sizeof(Page)
                        : bytes / 100 * kPageShare / (sizeof(Page) + Linker::bytes_per_page());
    capacities.pages =
        static_cast<std::uint32_t>(std::min<std::size_t>(std::max(counts.chunks(), 1U), fitting));
    // Faces beyond the whole model are of no use; below the base mesh there is no model.
    const std::uint32_t all_faces = std::max(counts.face_ids(), kMinFaces);
    const std::uint32_t least_faces = counts.base_faces + kMinFaces;
    const auto leaves_too_little = [&]
    { return required_bytes(header, with_faces(capacities, least_faces)) > bytes; };
    while (cache_bytes == 0 && capacities.pages > kMinPages && leaves_too_little())
    {
        --capacities.pages;
    }
    if (capacities.pages == 0 || leaves_too_little())
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
             const ModelCapacities& model_capacities, const Kernels& kernels) noexcept
    : header(model_header)
    , capacities(model_capacities)
    , slots(model_slots)
    , inbox(arena, capacities.pages, capacities.index_pages, wish_capacity(capacities))
    , linker(arena, header, slots)
    , pages(arena, slots)
    , cache(arena, header, slots, pages, inbox)
    , tree(arena, {capacities.faces, capacities.blocks, capacities.nodes}, header.quantum_m(),
           kernels)
    , forest(arena, header.counts(), slots, pages, tree, capacities.faces)
    , refiner(arena, forest, pages, tree, header.quantum_m())
{
}

double Model::lead_s(std::int64_t period_ns) const noexcept
{
    const double latency_s = cache.latency().most_frames() * static_cast<double>(period_ns) * 1e-9;
    return std::min(latency_s + kRefineTime_s, kLongestLead_s);
}

DoorTake Model::load(ModelId id, const RegionRanking& ranking, const Budgets& budgets,
                     std::uint32_t frame, FrameFault& faults) noexcept
{
    work = WorkCounters{};
    cache.adopt_arrivals(budgets.pages, frame, work);
    pages_used_max = std::max(pages_used_max, pages.used());
    if (residence == Residence::complete)
    {
        return cache.taken();
    }
    RegionRanking regions;
    for (const RankedRegion& region : ranking)
    {
        if (region.model == id && may_ask_for(region))
        {
            regions.push_back(region);
        }
    }
    cache.request_missing(regions.view(), budgets, frame, work, faults);
    if (residence == Residence::filling)
    {
        cache.request_everything(budgets, work, faults);
    }
    return cache.taken();
}

bool Model::may_ask_for(const RankedRegion& region) const noexcept
{
    return !capacities.cache_off || (region.lead_ns == 0 && !is_refined);
}

bool Model::fits() const noexcept
{
    const ModelCounts counts = header.counts();
    return capacities.pages >= counts.chunks() && capacities.index_pages >= counts.index_pages() &&
           capacities.faces >= counts.face_ids();
}

void Model::refine(std::span<const RefineQuestion> questions, const Budgets& budgets,
                   std::uint32_t frame, FrameFault& faults) noexcept
{
    if (residence == Residence::complete)
    {
        return;
    }
    Budgets own = budgets;
    own.scanned = residence == Residence::filling ? 0 : budgets.scanned;
    FrameFault found = FrameFault::none;
    refiner.run(questions, own, frame, work, found);
    if (residence == Residence::filling)
    {
        switch (refiner.refine_everything(header.counts().records, questions, budgets, frame, work,
                                          found))
        {
        case Refiner::Progress::complete:
            residence = Residence::complete;
            break;
        case Refiner::Progress::full:
            residence = Residence::partial;
            break;
        case Refiner::Progress::under_way:
            break;
        }
    }
    faults |= found;
    is_refined = found == FrameFault::none;
    if (capacities.cache_off && is_refined)
    {
        cache.evict_unpinned(work);
    }
}

ModelOutput Model::output() const noexcept
{
    const AbTree::Capacities& own = tree.capacities();
    const std::uint32_t index_pages = cache.index_pages_used();
    return {{pages.used(), pages_used_max, pages.capacity()},
            {index_pages, index_pages, capacities.index_pages},
            {forest.active_faces(), forest.active_faces_max(), forest.capacity()},
            {tree.blocks_used(), tree.blocks_used_max(), own.blocks},
            {tree.nodes_used(), tree.nodes_used_max(), own.nodes},
            forest.refined_records(),
            forest.state_hash(),
            is_complete()};
}

void Model::refit(FrameFault& faults) noexcept
{
    tree.offer_unplaced([&](PrimId prim) { return forest.describe(prim); });
    const AbTree::RefitWork refitted = tree.refit();
    work.blocks_refitted += refitted.blocks;
    work.nodes_refitted += refitted.nodes;
    faults |= tree.is_complete() ? FrameFault::none : FrameFault::tree_full;
}

} // namespace tactus
