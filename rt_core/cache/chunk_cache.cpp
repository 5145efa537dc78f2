// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/cache/chunk_cache.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/limits.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

namespace tactus
{

namespace
{

/// Box of all index pages' boxes; the origin for a model without any.
QuantumBox extent_of(const ModelHeader& header) noexcept
{
    QuantumBox extent;
    for (std::uint32_t i = 0; i < header.counts().index_pages(); ++i)
    {
        const QuantumBox box = header.index_entry({i}).box;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            extent.low[axis] = i == 0 ? box.low[axis] : std::min(extent.low[axis], box.low[axis]);
            extent.high[axis] =
                i == 0 ? box.high[axis] : std::max(extent.high[axis], box.high[axis]);
        }
    }
    return extent;
}

/// Boxes of `open` that a wider sphere meets; bit i is the box `first` + i of the index page.
std::uint32_t met_of(std::uint32_t open, std::span<const WantedSphere> spheres, double wider,
                     const IndexPage& index, const QuantumBox& page_box,
                     std::uint32_t first) noexcept
{
    std::uint32_t met = 0;
    for (std::uint32_t left = open; left != 0; left &= left - 1)
    {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
        const QuantumBox box = box_of(index, page_box, first + i);
        const bool is_met = std::ranges::any_of(
            spheres,
            [&](const WantedSphere& wanted) {
                return meets({wanted.sphere.center, wanted.sphere.radius * wider}, box);
            });
        met |= is_met ? 1U << i : 0U;
    }
    return met;
}

} // namespace

ChunkCache::ChunkCache(CachePool& pool, const Kept& kept, const ModelHeader& header,
                       PageSlots slots, PageTable& pages, const Kernels& kernels) noexcept
    : pool_(&pool)
    , header_(header)
    , extent_(extent_of(header))
    , slots_(slots)
    , pages_(&pages)
    , kernels_(&kernels)
    , index_meta_(pool.index_metas)
    , chunk_requests_(pool.chunk_requests, pages.owner(), kept.pages)
    , index_requests_(pool.index_requests, pages.owner(), kept.index_pages)
{
    if (pool.caches_.data() != nullptr) // Null when measuring.
    {
        pool.caches_[pages.owner()] = this;
    }
}

void ChunkCache::take(const QueueEvent& event, std::uint32_t frame) noexcept
{
    if (event.kind == QueueEventKind::link_update)
    {
        pages_->update_linked({event.key.number}, event.slot, event.linked);
    }
    else if (event.key.kind == ContentKind::base)
    {
        TACTUS_ASSERT(!is_open_);
        TACTUS_ASSERT(!has_base_);
        has_base_ = event.kind == QueueEventKind::arrival;
        if (!has_base_)
        {
            has_cells_back_ = true;
            cells_back_ = frame;
            end_base(frame);
        }
    }
    else if (is_open_)
    {
        adopt(event, frame);
    }
    else
    {
        send_back(event, frame);
    }
}

/// Returns a slot whose piece arrived after the model was removed.
void ChunkCache::send_back(const QueueEvent& arrival, std::uint32_t frame) noexcept
{
    RequestList& requests =
        arrival.key.kind == ContentKind::chunk ? chunk_requests_ : index_requests_;
    requests.arrive(arrival.key.number, frame);
    requests.give_back_slot();
    const bool freed = pool_->queues.freed.try_push({arrival.key.kind, arrival.slot});
    TACTUS_ASSERT(freed);
}

void ChunkCache::open() noexcept
{
    TACTUS_ASSERT(has_base_);
    is_open_ = true;
    fill_cursor_ = 0;
    begin_again();
}

void ChunkCache::want_base(std::uint32_t first_cell, std::uint32_t frame) noexcept
{
    TACTUS_ASSERT(!is_open_);
    const bool is_under_way =
        base_asked_ != 0 && frame - base_asked_ <= pool_->request_timeout_frames_;
    if (!has_base_ && !is_under_way &&
        pool_->try_request({ContentKind::base, first_cell}, pages_->owner(), frame))
    {
        base_asked_ = frame;
    }
}

bool ChunkCache::try_empty(std::uint32_t most, std::uint32_t frame, WorkCounters& work) noexcept
{
    TACTUS_ASSERT(!is_open_);
    TACTUS_ASSERT(has_base_);
    const std::uint32_t pages = pages_->capacity();
    const auto all = static_cast<std::uint32_t>(pages + index_meta_.size());
    const std::uint32_t end = std::min(all, empty_cursor_ + most);
    for (; empty_cursor_ < std::min(end, pages); ++empty_cursor_)
    {
        if (pages_->is_own(empty_cursor_))
        {
            pages_->forget_refined(empty_cursor_);
            evict(empty_cursor_, work);
        }
    }
    for (; empty_cursor_ < end; ++empty_cursor_)
    {
        const IndexMeta& meta = index_meta_[empty_cursor_ - pages];
        if (!meta.page.is_none() && meta.owner == pages_->owner())
        {
            evict_index_page(empty_cursor_ - pages);
        }
    }
    if (empty_cursor_ < all)
    {
        return false;
    }
    TACTUS_ASSERT(pages_->used() == 0);
    empty_cursor_ = 0;
    end_base(frame);
    return true;
}

/// Marks the base mesh as returned; older requests for it are void for the transport thread.
void ChunkCache::end_base(std::uint32_t frame) noexcept
{
    has_base_ = false;
    base_asked_ = 0;
    const bool freed = pool_->queues.freed.try_push({ContentKind::base, pages_->owner(), frame});
    TACTUS_ASSERT(freed);
}

void ChunkCache::adopt(const QueueEvent& arrival, std::uint32_t frame) noexcept
{
    if (arrival.key.kind == ContentKind::chunk)
    {
        TACTUS_ASSERT(arrival.key.number < header_.counts().chunks());
        pages_->adopt({arrival.key.number}, arrival.slot, frame, arrival.linked);
        chunk_requests_.arrive(arrival.key.number, frame);
        ++loads_;
        return;
    }
    TACTUS_ASSERT(arrival.key.kind == ContentKind::index_page);
    TACTUS_ASSERT(arrival.key.number < header_.counts().index_pages());
    TACTUS_ASSERT(arrival.slot < index_meta_.size());
    TACTUS_ASSERT(index_meta_[arrival.slot].page.is_none());
    index_meta_[arrival.slot] = {IndexPageId{arrival.key.number}, frame, pages_->owner()};
    const bool inserted = pool_->index_slot_of.try_insert(
        PagePool::first_key(pages_->owner()) + arrival.key.number, arrival.slot);
    TACTUS_ASSERT(inserted);
    ++index_pages_used_;
    index_requests_.arrive(arrival.key.number, frame);
    forget(IndexPageId{arrival.key.number}); // The new page has not been searched yet.
}

void ChunkCache::request_missing(std::span<const RankedRegion> regions, const Budgets& budgets,
                                 std::uint32_t frame, WorkCounters& work,
                                 FrameFault& faults) noexcept
{
    frame_ = frame;
    work.budget.spend(WorkCost::search);
    const bool has_expired = chunk_requests_.take_expired();
    if (index_requests_.take_expired() || has_expired)
    {
        begin_again(); // Requests without an answer must be repeated.
    }
    const IndexSearch::Spheres urgent = to_quanta(regions, true);
    const IndexSearch::Spheres patient = to_quanta(regions, false);
    const bool is_far = urgent.empty() && patient.empty();
    work.skipped.add(Skip::models, is_far ? 1 : 0);
    const std::uint32_t pages = header_.counts().index_pages();
    urgent_.aim(urgent, pages, frame, variant_.keeps_searches);
    patient_.aim(patient, pages, frame, variant_.keeps_searches);
    lends_before_ = is_far ? frame : unused_since();
    Budgets most = budgets;
    if (!patient_.is_at_rest())
    {
        most.requests -= budgets.requests / kPatientShare;
        most.regions -= budgets.regions / kPatientShare;
    }
    search(urgent_, most, work, faults);
    search(patient_, budgets, work, faults);
}

/// The regions' spheres near the model in quanta, sorted by level: those of touching and soon pairs
/// if `are_urgent`, otherwise the rest.
IndexSearch::Spheres ChunkCache::to_quanta(std::span<const RankedRegion> regions,
                                           bool are_urgent) const noexcept
{
    const double per_metre = 1.0 / static_cast<double>(header_.quantum_m());
    IndexSearch::Spheres spheres;
    const std::uint32_t first = are_urgent ? 0 : level_of(PriorityClass::later, true);
    const std::uint32_t end = are_urgent ? level_of(PriorityClass::later, true) : kWantedLevels;
    for (std::uint32_t level = first; level < end; ++level)
    {
        for (const RankedRegion& region : regions)
        {
            if (level_of(region.of, region.horizon_ns == 0) != level)
            {
                continue;
            }
            const Vec3 center = region.center_m * per_metre;
            const QuantumSphere sphere{{center.x(), center.y(), center.z()},
                                       region.radius_m * per_metre};
            if (!variant_.asks_near_models_only || meets(sphere, extent_))
            {
                spheres.push_back({sphere, level});
            }
        }
    }
    return spheres;
}

/// Searches due groups, then pages of the round, until most.regions or the work budget is spent.
void ChunkCache::search(IndexSearch& search, const Budgets& most, WorkCounters& work,
                        FrameFault& faults) noexcept
{
    if (search.is_at_rest())
    {
        work.skipped.add(Skip::searches, search.spheres().empty() ? 0 : 1);
        return;
    }
    const SphereLanes lanes(search.spheres(), search.wider());
    constexpr std::uint32_t kGroups = IndexSearch::kGroups;
    const std::uint32_t groups =
        kGroups * (most.regions - std::min(most.regions, work.regions_searched));
    const std::uint32_t group_cost =
        WorkCost::index_group +
        static_cast<std::uint32_t>(search.spheres().size()) * WorkCost::index_sphere;
    std::uint32_t looked = 0;
    const auto look = [&](IndexSearch::NearPage& near)
    {
        const std::uint32_t more = search_page(near, {search, lanes, most}, work, faults);
        work.budget.spend(more * group_cost);
        looked += more;
    };
    // One page is searched even with a spent budget; the others stay due.
    const auto may_look = [&]
    { return looked + kGroups <= groups && (looked == 0 || !work.budget.is_spent()); };
    while (may_look())
    {
        IndexSearch::NearPage* const near = search.next_due();
        if (near == nullptr)
        {
            break;
        }
        look(*near);
    }
    // Entries of the header are cheap: sixteen count as much as one index page.
    const std::uint32_t entries = 16 / kGroups * groups;
    for (std::uint32_t entry = 0; entry < entries && may_look() && search.is_on_round(); ++entry)
    {
        const IndexPageId page = search.next(frame_);
        if (search.may_come_to(header_.index_entry(page).box))
        {
            look(search.add(page));
        }
    }
    work.regions_searched += (looked + kGroups - 1) / kGroups;
}

void ChunkCache::request_everything(const Budgets& budgets, WorkCounters& work,
                                    FrameFault& faults) noexcept
{
    const std::uint32_t chunks = header_.counts().chunks();
    for (std::uint32_t looked = 0;
         looked < std::min(chunks, kChunksPerIndexPage) && work.requests < budgets.requests &&
         chunk_requests_.under_way() < kMaxFillingRequests && pages_->used() < chunks;
         ++looked)
    {
        const ChunkId chunk{fill_cursor_};
        TACTUS_ASSERT(chunk.value < chunks);
        const IndexPageId page{chunk.value >> kChunksPerIndexPageLog2};
        if (find_index_page(page) == IdTable::kAbsent)
        {
            // The index page with the chunk's hash comes first.
            static_cast<void>(try_want_index_page(page, work, faults));
            return;
        }
        const Want want = want_of(0, 0);
        if (!try_touch(chunk, want, work))
        {
            static_cast<void>(try_want(chunk, want, budgets, work, faults));
        }
        fill_cursor_ = fill_cursor_ + 1 == chunks ? 0 : fill_cursor_ + 1;
    }
}

ChunkCache::Want ChunkCache::want_of(std::uint32_t level, std::uint32_t touch_level) const noexcept
{
    const std::uint32_t age = kLevelAge * level;
    return {frame_ - kLevelAge * touch_level, unused_since() - age, age, level};
}

std::uint32_t ChunkCache::unused_since() const noexcept
{
    return std::min(urgent_.last_round_began(), patient_.last_round_began());
}

/// Searches the due groups of a page: requests chunks that a sphere meets, and finds how far the
/// spheres may move before the groups are due again. Returns the number of searched groups.
std::uint32_t ChunkCache::search_page(IndexSearch::NearPage& near, const Look& look,
                                      WorkCounters& work, FrameFault& faults) noexcept
{
    const QuantumBox box = header_.index_entry(near.page).box;
    if (!near.is_met)
    {
        if (const std::optional<double> gap = look.search.gap_to(box, look.search.wider()))
        {
            near.until.fill(look.search.until(*gap));
            return 0;
        }
        near.due = IndexSearch::kAllGroups;
    }
    const std::uint32_t slot = find_index_page(near.page);
    near.is_met = slot != IdTable::kAbsent;
    if (!near.is_met)
    {
        if (!try_want_index_page(near.page, work, faults))
        {
            begin_again();
        }
        near.until.fill(IndexSearch::kNever);
        return IndexSearch::kGroups;
    }
    TACTUS_ASSERT(index_meta_[slot].page == near.page);
    index_meta_[slot].touched = frame_;
    const IndexPage& index = slots_.index_pages[slot];
    for (std::uint32_t left = near.due; left != 0; left &= left - 1)
    {
        near.until[static_cast<std::size_t>(std::countr_zero(left))] = IndexSearch::kNever;
    }
    near.due &= (1U << ((index.chunks + 7) / 8)) - 1; // The last page may have fewer groups.
    search_boxes(near, index, box, look, work, faults);
    return static_cast<std::uint32_t>(std::popcount(near.due));
}

void ChunkCache::search_boxes(IndexSearch::NearPage& near, const IndexPage& index,
                              const QuantumBox& page_box, const Look& look, WorkCounters& work,
                              FrameFault& faults) noexcept
{
    const KernelPage page = look.lanes.page(page_box);
    const std::span<const WantedSphere> spheres = look.search.spheres();
    std::array<float, IndexSearch::kGroups> gaps{};
    gaps.fill(IndexSearch::kNever);
    std::uint64_t known = ~(~std::uint64_t{0} >> (kChunksPerIndexPage - index.chunks));
    std::uint32_t waiting = 0;
    for (std::size_t first = 0, end = 0; first < spheres.size(); first = end)
    {
        const std::uint32_t level = spheres[first].level;
        while (end < spheres.size() && spheres[end].level == level)
        {
            ++end;
        }
        std::uint64_t met = 0;
        for (std::uint32_t left = near.due; left != 0; left &= left - 1)
        {
            const auto group = static_cast<std::uint32_t>(std::countr_zero(left));
            const NearBoxes seen = kernels_->near_boxes(
                &index.low[0][std::size_t{8} * group], page, look.lanes.from(first),
                static_cast<std::uint32_t>(end - first), known >> 8 * group & 0xffU);
            const std::uint32_t opened = met_of(seen.open, spheres.subspan(first, end - first),
                                                look.search.wider(), index, page_box, 8 * group);
            gaps[group] = std::min(gaps[group], opened == seen.open ? seen.gap : 0.0F);
            met |= std::uint64_t{seen.met | opened} << 8 * group;
        }
        const Want want = want_of(level, look.search.touch_level(first));
        for (std::uint64_t left = met; left != 0; left &= left - 1)
        {
            const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
            const ChunkId chunk{(near.page.value << kChunksPerIndexPageLog2) + i};
            if (try_touch(chunk, want, work))
            {
                continue;
            }
            float& gap = gaps[i / 8];
            if (const auto way = look.search.gap_to(box_of(index, page_box, i), 1.0))
            {
                gap = std::min(gap, static_cast<float>(*way)); // Only a wider sphere meets the box.
            }
            else if (!try_want(chunk, want, look.most, work, faults))
            {
                waiting |= 1U << i / 8;
            }
        }
        known |= met;
    }
    if (waiting != 0 && !chunk_requests_.has_credit())
    {
        begin_again();
    }
    for (std::uint32_t left = near.due; left != 0; left &= left - 1)
    {
        const auto group = static_cast<std::uint32_t>(std::countr_zero(left));
        // A chunk of the group may have been evicted meanwhile.
        const bool is_still_due =
            (waiting >> group & 1U) != 0 || near.until[group] == IndexSearch::kNow;
        near.until[group] =
            is_still_due ? IndexSearch::kNow : look.search.until(static_cast<double>(gaps[group]));
    }
}

/// Touches a chunk; true if it is resident or under way.
bool ChunkCache::try_touch(ChunkId chunk, const Want& want, WorkCounters& work) noexcept
{
    if (const std::uint32_t slot = pages_->find(chunk); slot != IdTable::kAbsent)
    {
        pages_->touch(slot, std::max(pages_->meta(slot).touched, want.touch));
        ++work.cache_hits;
        return true;
    }
    return chunk_requests_.is_under_way(chunk.value);
}

/// Requests a chunk that is neither resident nor under way; false if the request can't be sent.
bool ChunkCache::try_want(ChunkId chunk, const Want& want, const Budgets& most, WorkCounters& work,
                          FrameFault& faults) noexcept
{
    if (work.requests < most.requests && !chunk_requests_.has_credit())
    {
        give_page_back(want, work);
        // One page may not be enough if late answers to expired requests took slots meanwhile. A
        // predicted chunk may fail without a fault.
        if (is_present(want.level) && !chunk_requests_.has_credit())
        {
            faults |= FrameFault::cache_full;
            if (pool_->barren_looks_ >= pages_->capacity())
            {
                pool_->refuse(class_of(want.level));
            }
        }
    }
    if (work.requests >= most.requests || !chunk_requests_.has_credit() ||
        !pool_->try_request({ContentKind::chunk, chunk.value}, pages_->owner(), frame_))
    {
        return false;
    }
    chunk_requests_.ask(chunk.value, frame_);
    ++work.requests;
    ++work.cache_misses;
    return true;
}

/// Requests an index page unless it is under way; false if the request can't be sent.
bool ChunkCache::try_want_index_page(IndexPageId page, WorkCounters& work,
                                     FrameFault& faults) noexcept
{
    if (index_requests_.is_under_way(page.value))
    {
        return true;
    }
    const bool has_credit = index_requests_.has_credit() || try_evict_index_page();
    faults |= has_credit ? FrameFault::none : FrameFault::cache_full;
    if (!has_credit ||
        !pool_->try_request({ContentKind::index_page, page.value}, pages_->owner(), frame_))
    {
        return false;
    }
    index_requests_.ask(page.value, frame_);
    ++work.requests;
    return true;
}

/// Evicts one page to free a slot: the least recently touched of the next kEvictionLooks that has
/// no refined record and was unused long enough. It may be another model's with more than its
/// reservation.
void ChunkCache::give_page_back(const Want& want, WorkCounters& work) noexcept
{
    const std::uint32_t slots = pages_->capacity();
    const std::uint32_t looks = std::min(slots, CachePool::kEvictionLooks);
    std::uint32_t oldest = slots;
    for (std::uint32_t look = 0; look < looks; ++look)
    {
        const std::uint32_t slot = pool_->hand_;
        pool_->hand_ = slot + 1 == slots ? 0 : slot + 1;
        const PageTable::Meta& meta = pages_->meta(slot);
        if (meta.chunk.is_none() || meta.refined != 0 ||
            (oldest != slots && meta.touched >= pages_->meta(oldest).touched))
        {
            continue;
        }
        const ChunkCache& owner = *pool_->caches_[meta.owner];
        const std::uint32_t before =
            &owner == this ? want.evict_before
                           : owner.lends_before(owner.chunk_requests_, frame_, want.age);
        oldest = meta.touched < before ? slot : oldest;
    }
    if (oldest == slots)
    {
        pool_->barren_looks_ = std::min(pool_->barren_looks_ + looks, slots);
        return;
    }
    pool_->barren_looks_ = 0;
    pool_->caches_[pages_->meta(oldest).owner]->evict(oldest, work);
}

/// Frame before which a piece's last touch lets other models take its slot; 0, which means none,
/// within this model's reservation. A piece used in the last two rounds, or `age` frames before
/// them, stays. A model without requests in this frame has no rounds.
std::uint32_t ChunkCache::lends_before(const RequestList& requests, std::uint32_t frame,
                                       std::uint32_t age) const noexcept
{
    const bool is_idle = frame - frame_ > 1;
    return requests.has_more_than_its_own() ? (is_idle ? frame : lends_before_) - age : 0;
}

/// Begins new rounds of both searches in the next frame.
void ChunkCache::begin_again() noexcept
{
    urgent_.begin_again();
    patient_.begin_again();
}

/// Drops certificates that depend on a loaded or evicted index page.
void ChunkCache::forget(IndexPageId page) noexcept
{
    urgent_.forget(page);
    patient_.forget(page);
}

std::uint32_t ChunkCache::find_index_page(IndexPageId page) const noexcept
{
    return pool_->index_slot_of.find(PagePool::first_key(pages_->owner()) + page.value);
}

void ChunkCache::evict_unpinned(WorkCounters& work) noexcept
{
    for (std::uint32_t slot = 0; slot < pages_->capacity(); ++slot)
    {
        if (pages_->is_own(slot) && pages_->meta(slot).refined == 0)
        {
            evict(slot, work);
        }
    }
}

void ChunkCache::evict(std::uint32_t slot, WorkCounters& work) noexcept
{
    const ChunkId chunk = pages_->meta(slot).chunk;
    urgent_.forget(chunk);
    patient_.forget(chunk);
    pages_->evict(slot);
    const bool freed = pool_->queues.freed.try_push({ContentKind::chunk, slot});
    TACTUS_ASSERT(freed);
    chunk_requests_.give_back_slot();
    ++work.evictions;
    ++evictions_;
}

bool ChunkCache::try_evict_index_page() noexcept
{
    auto oldest = static_cast<std::uint32_t>(index_meta_.size());
    for (std::uint32_t slot = 0; slot < index_meta_.size(); ++slot)
    {
        const IndexMeta& meta = index_meta_[slot];
        if (meta.page.is_none() ||
            (oldest != index_meta_.size() && meta.touched >= index_meta_[oldest].touched))
        {
            continue;
        }
        const ChunkCache& owner = *pool_->caches_[meta.owner];
        const std::uint32_t before =
            &owner == this ? unused_since() : owner.lends_before(owner.index_requests_, frame_, 0);
        oldest = meta.touched < before ? slot : oldest;
    }
    if (oldest == index_meta_.size())
    {
        return false;
    }
    pool_->caches_[index_meta_[oldest].owner]->evict_index_page(oldest);
    return true;
}

void ChunkCache::evict_index_page(std::uint32_t slot) noexcept
{
    forget(index_meta_[slot].page);
    pool_->index_slot_of.erase(PagePool::first_key(pages_->owner()) + index_meta_[slot].page.value);
    --index_pages_used_;
    index_meta_[slot] = IndexMeta{};
    const bool freed = pool_->queues.freed.try_push({ContentKind::index_page, slot});
    TACTUS_ASSERT(freed);
    index_requests_.give_back_slot();
}

} // namespace tactus
