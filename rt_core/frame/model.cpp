// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/model.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Default share of the memory for pages and their link data, in percent. Most pages are
/// prefetched; an active face costs two thirds of a record.
constexpr std::size_t kPageShare = 72;
/// Index pages beyond the least number get at most 1 / kIndexPageShare of the memory.
constexpr std::size_t kIndexPageShare = 64;
/// Least number of active faces, besides those of base meshes, for a useful plan.
constexpr std::uint32_t kMinFaces = 256;

/// Time from the arrival of chunks to a certified surface: a few frames after a jump at 1.1 M
/// faces. Chunks must arrive this long before the tool.
constexpr double kRefineTime_s = 0.008;
/// Longest time for which a user's motion is predicted.
constexpr double kLongestHorizon_s = 0.15;

/// Number of blocks for `faces` faces: blocks are about two thirds full, so 11 faces, and thin cuts
/// need twice as many blocks.
std::uint32_t blocks_for(std::uint32_t faces) noexcept
{
    return faces / 8 + 2 * AbTree::kReserve;
}

/// Returns `capacities` with this number of faces, and the blocks and nodes that follow from it.
ModelCapacities with_faces(ModelCapacities capacities, std::uint32_t faces) noexcept
{
    capacities.faces = faces;
    capacities.blocks = blocks_for(faces + capacities.edit_faces);
    capacities.nodes = capacities.blocks / 2 + 2 * AbTree::kReserve;
    return capacities;
}

TreeCapacities tree_part(const ModelCapacities& capacities) noexcept
{
    return {capacities.faces + capacities.edit_faces, capacities.blocks, capacities.nodes};
}

/// Divisor of a model's capacity beyond its base mesh that gives its reserved part, unless the
/// whole model fits.
constexpr std::uint32_t kKeptPart = 4;

bool brings_all(const ModelCounts& counts, const ModelCapacities& capacities) noexcept
{
    return capacities.pages >= counts.chunks() && capacities.index_pages >= counts.index_pages() &&
           capacities.faces >= counts.face_ids();
}

/// Part of a model's capacities that is reserved for it.
ModelCapacities kept_for(const ModelHeader& header, const ModelCapacities& capacities) noexcept
{
    const ModelCounts counts = header.counts();
    if (capacities.faces == 0)
    {
        return {}; // A streamed model's memory is reserved when it is wanted.
    }
    if (brings_all(counts, capacities))
    {
        return capacities;
    }
    const std::uint32_t more = capacities.faces - std::min(counts.base_faces, capacities.faces);
    ModelCapacities kept = with_faces(capacities, counts.base_faces + more / kKeptPart);
    kept.pages = capacities.pages / kKeptPart;
    kept.index_pages = capacities.index_pages / kKeptPart;
    return kept;
}

/// Adds `all` units to `part` of the models evenly, up to `most_of(i)` for each; what one model
/// does not need goes to the others. Returns the rest.
template <typename MostOf>
std::uint32_t divide(std::uint32_t all, std::span<ModelCapacities> models,
                     std::uint32_t ModelCapacities::*part, const MostOf& most_of) noexcept
{
    std::uint32_t before = all + 1;
    for (std::size_t round = 0; round < models.size() && all != before; ++round)
    {
        before = all;
        const std::uint32_t each = std::max(all / static_cast<std::uint32_t>(models.size()), 1U);
        for (std::size_t i = 0; i < models.size(); ++i)
        {
            const std::uint32_t missing = most_of(i) - models[i].*part;
            const std::uint32_t given = std::min({each, missing, all});
            models[i].*part += given;
            all -= given;
        }
    }
    return all;
}

/// Plan of try_plan(): each model gets pages, then as many faces as fit beside them.
class CapacityPlan
{
public:
    /// Pages have their shares of `shared` bytes, `bytes` without the rooms for edits.
    CapacityPlan(std::span<const ModelHeader> headers, std::size_t bytes, std::size_t shared,
                 std::span<ModelCapacities> capacities) noexcept
        : headers_(headers)
        , bytes_(bytes)
        , shared_(shared)
        , capacities_(capacities)
        , count_(static_cast<std::uint32_t>(headers.size()))
        , least_more_((kMinFaces + count_ - 1) / count_)
    {
    }

    void share_index_pages() noexcept
    {
        const auto most = static_cast<std::uint32_t>(std::max<std::size_t>(
            kLeastResidentIndexPages, shared_ / kIndexPageShare / sizeof(IndexPage)));
        static_cast<void>(divide(most, capacities_, &ModelCapacities::index_pages,
                                 [this](std::size_t i)
                                 { return std::max(headers_[i].counts().index_pages(), 1U); }));
    }

    /// Shares the pages of `cache_bytes`; 0: the default share, or less if that leaves too little
    /// memory for faces. False if a model gets no page, or the least faces do not fit.
    [[nodiscard]] bool try_share_pages(std::size_t cache_bytes) noexcept
    {
        const std::size_t page_bytes =
            sizeof(Page) + LinkPool::bytes_per_page() + 2 * sizeof(IdTable::Entry);
        const auto fitting = static_cast<std::uint32_t>(std::min<std::size_t>(
            cache_bytes > 0 ? cache_bytes / sizeof(Page) : shared_ / 100 * kPageShare / page_bytes,
            kMaxModels * std::size_t{kMaxRecords >> kRecordsPerChunkLog2}));
        std::uint32_t pages = share_pages(fitting);
        if (cache_bytes == 0 && !do_faces_fit(least_more_))
        {
            std::uint32_t too_many = pages;
            pages = std::min(pages, count_);
            while (too_many - pages > 1)
            {
                const std::uint32_t middle = pages + (too_many - pages) / 2;
                static_cast<void>(share_pages(middle));
                (do_faces_fit(least_more_) ? pages : too_many) = middle;
            }
            pages = share_pages(pages);
        }
        return pages >= count_ && do_faces_fit(least_more_);
    }

    /// Gives the models as many faces beyond their base meshes as fit.
    [[nodiscard]] bool try_share_faces() noexcept
    {
        std::uint32_t fits = least_more_;
        std::uint32_t too_many = 0;
        for (const ModelHeader& header : headers_)
        {
            too_many =
                std::max(too_many, std::max(header.counts().face_ids(), kMinFaces) + kMinFaces);
        }
        while (too_many - fits > 1)
        {
            const std::uint32_t middle = fits + (too_many - fits) / 2;
            (do_faces_fit(middle) ? fits : too_many) = middle;
        }
        return do_faces_fit(fits);
    }

private:
    /// Shares the pages, and returns how many of them the models can use.
    std::uint32_t share_pages(std::uint32_t pages) noexcept
    {
        for (ModelCapacities& one : capacities_)
        {
            one.pages = 0;
        }
        return pages - divide(pages, capacities_, &ModelCapacities::pages,
                              [this](std::size_t i)
                              { return std::max(headers_[i].counts().chunks(), 1U); });
    }

    /// Plans `more` faces beyond each base mesh; true if all fits into the memory. Faces beyond the
    /// whole model are useless; below the base mesh there is no model.
    [[nodiscard]] bool do_faces_fit(std::uint32_t more) noexcept
    {
        std::uint64_t sum = 0;
        for (std::size_t i = 0; i < count_; ++i)
        {
            const ModelCounts counts = headers_[i].counts();
            const std::uint32_t most = std::max(counts.face_ids(), kMinFaces) + kMinFaces - 1;
            capacities_[i] = with_faces(capacities_[i], counts.base_faces + std::min(more, most));
            sum += capacities_[i].faces + capacities_[i].edit_faces;
        }
        return sum <= kMaxPoolFaces && required_bytes(headers_, capacities_) <= bytes_;
    }

    std::span<const ModelHeader> headers_;
    std::size_t bytes_;
    std::size_t shared_;
    std::span<ModelCapacities> capacities_;
    std::uint32_t count_;
    std::uint32_t least_more_; ///< Least number of faces beyond each base mesh.
};

} // namespace

ModelPools::ModelPools(Arena& arena, const ModelCapacities& all, std::uint32_t models) noexcept
    : scratch(arena, all.pages)
    , faces(arena, all.faces + all.edit_faces)
    , tree(arena, tree_part(all))
    , slots{arena.take<Page>(all.pages), arena.take<IndexPage>(all.index_pages),
            BaseMesh{arena.take<Vec3f>(all.base_cells), arena.take<BaseFace>(all.base_cells),
                     arena.take<std::uint32_t>(all.base_cells)}}
    , base_room(all.base_cells)
    , cache(arena, all.pages, all.index_pages, models, all.base_cells > 0 ? models : 0)
    , links(arena, all.pages)
{
}

ModelCapacities sum_of(std::span<const ModelCapacities> each) noexcept
{
    ModelCapacities sum;
    for (const ModelCapacities& one : each)
    {
        sum.pages += one.pages;
        sum.index_pages += one.index_pages;
        sum.faces += one.faces;
        sum.blocks += one.blocks;
        sum.nodes += one.nodes;
        sum.edit_faces += one.edit_faces;
        sum.base_cells += one.base_cells;
    }
    return sum;
}

std::size_t required_bytes(std::span<const ModelHeader> headers,
                           std::span<const ModelCapacities> capacities) noexcept
{
    TACTUS_ASSERT(headers.size() == capacities.size());
    Arena scratch = Arena::measuring();
    const RefineScratch beside(scratch, 0);
    Arena arena = Arena::measuring();
    ModelPools pools(arena, sum_of(capacities), static_cast<std::uint32_t>(headers.size()));
    for (std::uint32_t i = 0; i < headers.size(); ++i)
    {
        const PageSlots slots = pools.slots.of_model(arena, headers[i].counts());
        const Model model(arena, pools, {i}, headers[i], slots, capacities[i], portable_kernels());
    }
    static_cast<void>(arena.take<ModelSlot>(headers.size()));
    static_cast<void>(arena.take<bool>(headers.size()));
    static_cast<void>(arena.take<ModelOutput>(headers.size()));
    return arena.used() - scratch.used();
}

ModelCapacities streamed_model_room(std::uint32_t meshes, std::uint32_t cells, std::uint32_t pages,
                                    std::uint32_t index_pages) noexcept
{
    ModelCapacities room = with_faces({}, 2 * cells + kMinFaces);
    // Each tree has its own reserve of blocks, and of nodes half as many and one more.
    room.blocks += meshes * 2 * AbTree::kReserve;
    room.nodes += meshes * 3 * AbTree::kReserve;
    room.pages = pages;
    room.index_pages = index_pages;
    room.base_cells = cells;
    return room;
}

namespace
{

/// Bytes of the rooms for edits: what models of base meshes need with them and not without.
std::size_t edit_bytes(std::span<const ModelHeader> headers,
                       std::span<ModelCapacities> capacities) noexcept
{
    const auto needed = [&](bool with_edits)
    {
        std::size_t bytes = 0;
        for (std::size_t i = 0; i < headers.size(); ++i)
        {
            ModelCapacities one;
            one.edit_faces = with_edits ? capacities[i].edit_faces : 0;
            one = with_faces(one, headers[i].counts().base_faces + kMinFaces);
            bytes += required_bytes(headers.subspan(i, 1), {&one, 1});
        }
        return bytes;
    };
    return needed(true) - needed(false);
}

} // namespace

bool try_plan(std::span<const ModelHeader> headers, std::size_t bytes, std::size_t cache_bytes,
              std::span<ModelCapacities> capacities) noexcept
{
    TACTUS_ASSERT(headers.size() == capacities.size());
    TACTUS_ASSERT(!headers.empty());
    TACTUS_ASSERT(headers.size() <= kMaxModels);
    // Rooms for edits come first; pages and faces share the rest as without them.
    for (ModelCapacities& one : capacities)
    {
        const std::uint32_t edit_faces = one.edit_faces;
        one = ModelCapacities{};
        one.edit_faces = edit_faces;
    }
    const std::size_t for_edits = edit_bytes(headers, capacities);
    if (for_edits >= bytes)
    {
        return false;
    }
    CapacityPlan plan(headers, bytes, bytes - for_edits, capacities);
    plan.share_index_pages();
    return plan.try_share_pages(cache_bytes) && plan.try_share_faces();
}

Model::Model(Arena& arena, ModelPools& shared, ModelId id, const ModelHeader& model_header,
             PageSlots model_slots, const ModelCapacities& model_capacities,
             const Kernels& kernels) noexcept
    : header(model_header)
    , capacities(model_capacities)
    , slots(model_slots)
    , linker(shared.links, id.value, header, slots)
    , pages(shared.cache.pages, id.value, slots)
    , cache(shared.cache,
            {kept_for(header, capacities).pages, kept_for(header, capacities).index_pages}, header,
            slots, pages, kernels)
    , tree(shared.tree, id, tree_part(kept_for(header, capacities)), header.quantum_m(), kernels)
    , edits(arena, header, model_slots.base.faces.empty() ? 0U : capacities.edit_faces)
    , forest(arena, shared.faces, id, kept_for(header, capacities).faces + edits.room(),
             header.counts(), slots, pages, tree, &edits)
    , refiner(forest, pages, tree, shared.scratch, header.quantum_m())
    , is_streamed_model(model_slots.base.faces.empty())
    , stage(is_streamed_model ? ModelStage::known : ModelStage::resident)
    , shared_(&shared)
{
    if (is_streamed_model)
    {
        cache.close();
    }
}

bool Model::try_want() noexcept
{
    TACTUS_ASSERT(stage == ModelStage::known);
    const ModelCounts counts = header.counts();
    const auto first = shared_->base_room.try_take(BaseMesh::cells_of(counts));
    if (!first)
    {
        return false;
    }
    const ModelCapacities least = with_faces({}, counts.base_faces);
    const bool has_faces = forest.try_promise(least.faces);
    if (!has_faces || !tree.try_promise(tree_part(least)))
    {
        if (has_faces)
        {
            forest.end_promise();
        }
        shared_->base_room.give_back(*first);
        return false;
    }
    first_cell_ = *first;
    stage = ModelStage::wanted;
    return true;
}

void Model::advance(std::uint32_t& entering, std::uint32_t& leaving, std::uint32_t frame,
                    WorkCounters& work) noexcept
{
    if (stage == ModelStage::leaving)
    {
        dissolve(leaving, frame, work);
    }
    if (stage == ModelStage::wanted && cache.try_take_cells_back())
    {
        end_stay();
    }
    if (stage == ModelStage::wanted)
    {
        cache.want_base(first_cell_, frame);
        if (cache.has_base())
        {
            slots.base = shared_->slots.base.part(first_cell_, header.counts());
            forest.begin(slots.base);
            stage = ModelStage::arriving;
        }
    }
    if (stage == ModelStage::arriving)
    {
        entering -= forest.enter(entering);
        if (forest.has_entered())
        {
            cache.open();
            stage = ModelStage::resident;
            ++revision; // Raises the revision, as answers for the former state are outdated.
        }
    }
}

void Model::leave() noexcept
{
    TACTUS_ASSERT(is_streamed_model);
    TACTUS_ASSERT(is_resident());
    cache.close();
    stage = ModelStage::leaving;
    residence = Residence::partial;
    is_refined = false;
    ++revision;
}

/// Does one step of leaving: the faces, then a refit, then the pages, and at last the reservation.
void Model::dissolve(std::uint32_t& leaving, std::uint32_t frame, WorkCounters& work) noexcept
{
    if (forest.active_faces() > 0)
    {
        leaving -= forest.leave(leaving);
        return;
    }
    if (!cache.try_empty(kLeavingSlotsPerFrame, frame, work))
    {
        return;
    }
    refiner.forget_all();
    end_stay();
}

/// Returns the model's reserved memory: the model is known again.
void Model::end_stay() noexcept
{
    TACTUS_ASSERT(stage == ModelStage::wanted || stage == ModelStage::leaving);
    TACTUS_ASSERT(forest.active_faces() == 0);
    forest.end_promise();
    tree.end_promise();
    shared_->base_room.give_back(first_cell_);
    slots.base = {};
    stage = ModelStage::known;
}

double Model::horizon_s(std::int64_t period_ns) const noexcept
{
    TACTUS_ASSERT(period_ns > 0);
    const double latency_s = cache.latency().most_frames() * static_cast<double>(period_ns) * 1e-9;
    return std::min(latency_s + kRefineTime_s, kLongestHorizon_s);
}

void Model::load(ModelId id, const RegionRanking& ranking, const Budgets& budgets,
                 std::uint32_t frame, WorkCounters& work, FrameFault& faults) noexcept
{
    pages_used_max = std::max(pages_used_max, pages.used());
    if (is_complete() || !is_resident())
    {
        return;
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
}

bool Model::may_ask_for(const RankedRegion& region) const noexcept
{
    return !capacities.cache_off || (region.horizon_ns == 0 && !is_refined);
}

bool Model::fits() const noexcept
{
    return brings_all(header.counts(), capacities);
}

void Model::begin_refinement(std::span<const RefineRequest> requests, const Budgets& budgets,
                             WorkCounters& work) noexcept
{
    if (!is_resident() || (is_complete() && requests.empty()))
    {
        return;
    }
    Budgets own = budgets;
    own.scanned = residence == Residence::partial ? budgets.scanned : 0;
    refiner.begin(requests, own, work);
}

void Model::fill(std::uint32_t limit, std::uint32_t frame, WorkCounters& work,
                 FrameFault& faults) noexcept
{
    if (residence != Residence::filling)
    {
        return;
    }
    switch (refiner.fill(header.counts().records, limit, frame, work, faults))
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

void Model::end_refinement(std::span<const RefineRequest> requests, WorkCounters& work) noexcept
{
    is_refined = std::ranges::none_of(requests, [](const RefineRequest& request)
                                      { return request.is_late(); });
    if (capacities.cache_off && is_refined)
    {
        cache.evict_unpinned(work);
    }
}

ModelOutput Model::output() const noexcept
{
    const std::uint32_t index_pages = cache.index_pages_used();
    return {{pages.used(), pages_used_max, capacities.pages},
            {index_pages, index_pages, capacities.index_pages},
            {forest.active_faces(), forest.active_faces_max(), capacities.faces + edits.room()},
            {tree.blocks_used(), tree.blocks_used_max(), capacities.blocks},
            {tree.nodes_used(), tree.nodes_used_max(), capacities.nodes},
            forest.refined_records(),
            forest.state_hash(),
            is_complete(),
            stage,
            {edits.added(), edits.added_max(), edits.room()},
            edits.revision()};
}

std::optional<EditRefusal> Model::edit(const SurfaceEdit& change, WorkCounters& work,
                                       FrameFault& faults) noexcept
{
    const std::optional<EditRefusal> refusal = edits.take(change);
    if (!refusal)
    {
        forest.apply(change);
        work.budget.spend(static_cast<std::uint32_t>(change.removed.size() + change.added.size()) *
                          WorkCost::edited_face);
        refit(work, faults);
    }
    return refusal;
}

void Model::refit(WorkCounters& work, FrameFault& faults) noexcept
{
    tree.offer_unplaced([&](PrimId prim) { return forest.describe(prim); });
    const AbTree::RefitWork refitted = tree.refit();
    revision += refitted.blocks + refitted.nodes > 0 ? 1 : 0;
    work.blocks_refitted += refitted.blocks;
    work.nodes_refitted += refitted.nodes;
    work.budget.spend((refitted.blocks + refitted.nodes) * WorkCost::refit);
    faults |= tree.is_complete() ? FrameFault::none : FrameFault::tree_full;
}

} // namespace tactus
