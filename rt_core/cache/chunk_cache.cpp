// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/cache/chunk_cache.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/limits.hpp"

#include <algorithm>
#include <bit>

namespace tactus
{

ChunkCache::ChunkCache(Arena& arena, const ModelHeader& header, PageSlots slots, PageTable& pages,
                       ChunkInbox& inbox) noexcept
    : header_(header)
    , slots_(slots)
    , pages_(&pages)
    , inbox_(&inbox)
    , index_slot_of_(arena, static_cast<std::uint32_t>(slots.index_pages.size()) + 1)
    , index_meta_(arena.take<IndexMeta>(slots.index_pages.size()))
    , chunk_wishes_(arena, static_cast<std::uint32_t>(slots.pages.size()))
    , index_wishes_(arena, static_cast<std::uint32_t>(slots.index_pages.size()))
    , taken_(arena.take<DoorEvent>(kMaxArrivalsPerFrame + kMaxLinkUpdatesPerFrame))
{
}

void ChunkCache::adopt_arrivals(std::uint32_t budget, std::uint32_t frame,
                                WorkCounters& work) noexcept
{
    // Looked at once a frame: the other side makes room at any time, and how many wishes leave must
    // not depend on when.
    wish_room_ = static_cast<std::uint32_t>(inbox_->wanted.capacity() - inbox_->wanted.size());
    wish_room_at_start_ = wish_room_;
    taken_count_ = 0;
    const std::uint32_t arrivals_end = std::min(budget, kMaxArrivalsPerFrame);
    std::uint32_t arrivals = 0;
    std::uint32_t updates = 0;
    DoorEvent event;
    while (arrivals < arrivals_end && updates < kMaxLinkUpdatesPerFrame &&
           inbox_->arrived.try_pop(event))
    {
        taken_[taken_count_++] = event;
        if (event.kind == DoorEventKind::link_update)
        {
            pages_->update_linked({event.key.number}, event.slot, event.linked);
            ++updates;
            continue;
        }
        adopt(event, frame);
        ++arrivals;
    }
    work.pages_adopted += arrivals;
}

void ChunkCache::adopt(const DoorEvent& arrival, std::uint32_t frame) noexcept
{
    if (arrival.key.kind == ContentKind::chunk)
    {
        TACTUS_ASSERT(arrival.key.number < header_.counts().chunks());
        pages_->adopt({arrival.key.number}, arrival.slot, frame, arrival.linked);
        chunk_wishes_.arrive(arrival.key.number, frame);
        ++loads_;
        return;
    }
    TACTUS_ASSERT(arrival.key.kind == ContentKind::index_page);
    TACTUS_ASSERT(arrival.key.number < header_.counts().index_pages());
    TACTUS_ASSERT(arrival.slot < index_meta_.size());
    TACTUS_ASSERT(index_meta_[arrival.slot].page.is_none());
    index_meta_[arrival.slot] = {IndexPageId{arrival.key.number}, frame};
    const bool inserted = index_slot_of_.try_insert(arrival.key.number, arrival.slot);
    TACTUS_ASSERT(inserted);
    index_wishes_.arrive(arrival.key.number, frame);
}

/// False when the door had no room for one more wish at the start of the frame.
bool ChunkCache::try_wish(ContentKey key, std::uint32_t generation) noexcept
{
    if (wish_room_ == 0)
    {
        return false;
    }
    --wish_room_;
    const bool pushed = inbox_->wanted.try_push({key, generation});
    TACTUS_ASSERT(pushed);
    return true;
}

void ChunkCache::request_missing(std::span<const RankedRegion> regions, const Budgets& budgets,
                                 std::uint32_t frame, WorkCounters& work,
                                 FrameFault& faults) noexcept
{
    frame_ = frame;
    chunk_wishes_.expire(frame, wish_timeout_frames_);
    index_wishes_.expire(frame, wish_timeout_frames_);
    const RankedBalls balls = to_quanta(regions);
    const std::uint32_t pages = header_.counts().index_pages();
    std::uint32_t searched = 0;
    // The upper level is cheap to look at: sixteen entries count as much as one page.
    for (std::uint32_t looked = 0; looked < pages && searched < budgets.regions; ++looked)
    {
        if (looked / 16 >= budgets.regions)
        {
            break;
        }
        const IndexPageId page{cursor_};
        TACTUS_ASSERT(page.value < pages);
        cursor_ = cursor_ + 1 >= pages ? 0 : cursor_ + 1;
        if (cursor_ == 0)
        {
            last_round_began_ = round_began_;
            round_began_ = frame;
        }
        const QuantumBox box = header_.index_entry(page).box;
        if (meets(balls.present, box) || meets(balls.ahead, box))
        {
            ++searched;
            search_page(page, balls, budgets, frame, work, faults);
        }
    }
    work.regions_searched += searched;
}

void ChunkCache::request_everything(const Budgets& budgets, WorkCounters& work,
                                    FrameFault& faults) noexcept
{
    const std::uint32_t chunks = header_.counts().chunks();
    for (std::uint32_t looked = 0;
         looked < std::min(chunks, kChunksPerIndexPage) && work.requests < budgets.requests &&
         chunk_wishes_.under_way() < kMaxFillingWishes && pages_->used() < chunks;
         ++looked)
    {
        const ChunkId chunk{fill_cursor_};
        TACTUS_ASSERT(chunk.value < chunks);
        const IndexPageId page{chunk.value >> kChunksPerIndexPageLog2};
        if (index_slot_of_.find(page.value) == IdTable::kAbsent)
        {
            want_index_page(page, frame_, work, faults); // What verifies the chunk comes first.
            return;
        }
        want_chunk(chunk, {frame_, last_round_began_}, budgets, work, faults);
        fill_cursor_ = fill_cursor_ + 1 == chunks ? 0 : fill_cursor_ + 1;
    }
}

ChunkCache::RankedBalls ChunkCache::to_quanta(std::span<const RankedRegion> regions) const noexcept
{
    const double per_metre = 1.0 / static_cast<double>(header_.quantum_m());
    RankedBalls balls;
    for (const RankedRegion& region : regions)
    {
        const Vec3 center = region.center_m * per_metre;
        const double radius = region.radius_m * per_metre;
        (region.lead_ns == 0 ? balls.present : balls.ahead)
            .push_back({{center.x(), center.y(), center.z()}, radius});
    }
    return balls;
}

bool ChunkCache::meets(const Balls& balls, const QuantumBox& box) noexcept
{
    for (const QuantumBall& ball : balls)
    {
        double distance_sq = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const double gap =
                std::max({static_cast<double>(box.low[axis]) - ball.center[axis],
                          ball.center[axis] - static_cast<double>(box.high[axis]), 0.0});
            distance_sq += gap * gap;
        }
        if (distance_sq <= ball.radius * ball.radius)
        {
            return true;
        }
    }
    return false;
}

void ChunkCache::search_page(IndexPageId page, const RankedBalls& balls, const Budgets& budgets,
                             std::uint32_t frame, WorkCounters& work, FrameFault& faults) noexcept
{
    const std::uint32_t slot = index_slot_of_.find(page.value);
    if (slot == IdTable::kAbsent)
    {
        want_index_page(page, frame, work, faults);
        return;
    }
    TACTUS_ASSERT(index_meta_[slot].page == page);
    index_meta_[slot].touched = frame;
    const IndexPage& index = slots_.index_pages[slot];
    const QuantumBox box = header_.index_entry(page).box;
    const auto with_those_meeting = [&](const Balls& some, std::uint64_t chunks)
    {
        for (const QuantumBall& ball : some)
        {
            chunks = chunks_meeting(index, box, ball, chunks);
        }
        return chunks;
    };
    const std::uint64_t present = with_those_meeting(balls.present, 0);
    const Urgency now{frame, last_round_began_};
    const Urgency later{frame - kAheadAge, last_round_began_ - kAheadAge};
    for (std::uint64_t left = with_those_meeting(balls.ahead, present); left != 0; left &= left - 1)
    {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
        const ChunkId chunk{(page.value << kChunksPerIndexPageLog2) + i};
        want_chunk(chunk, ((present >> i) & 1U) != 0 ? now : later, budgets, work, faults);
    }
}

void ChunkCache::want_chunk(ChunkId chunk, const Urgency& urgency, const Budgets& budgets,
                            WorkCounters& work, FrameFault& faults) noexcept
{
    if (const std::uint32_t slot = pages_->find(chunk); slot != IdTable::kAbsent)
    {
        pages_->touch(slot, std::max(pages_->meta(slot).touched, urgency.touch));
        ++work.cache_hits;
        return;
    }
    if (chunk_wishes_.is_under_way(chunk.value) || work.requests >= budgets.requests)
    {
        return;
    }
    if (!chunk_wishes_.has_credit())
    {
        static_cast<void>(try_evict_page(urgency.evict_before, work));
    }
    // One page may not be enough when late answers to expired wishes took slots meanwhile.
    if (!chunk_wishes_.has_credit())
    {
        // What is only predicted may go without: it was worth asking for, no more.
        faults |= urgency.touch == frame_ ? FrameFault::cache_full : FrameFault::none;
        return;
    }
    if (try_wish({ContentKind::chunk, chunk.value}, frame_))
    {
        chunk_wishes_.ask(chunk.value, frame_);
        ++work.requests;
        ++work.cache_misses;
    }
}

void ChunkCache::want_index_page(IndexPageId page, std::uint32_t frame, WorkCounters& work,
                                 FrameFault& faults) noexcept
{
    if (index_wishes_.is_under_way(page.value))
    {
        return;
    }
    if (!index_wishes_.has_credit())
    {
        static_cast<void>(try_evict_index_page());
    }
    if (!index_wishes_.has_credit())
    {
        faults |= FrameFault::cache_full;
        return;
    }
    if (try_wish({ContentKind::index_page, page.value}, frame))
    {
        index_wishes_.ask(page.value, frame);
        ++work.requests;
    }
}

/// Gives the least recently touched page back that is not pinned and was last touched before the
/// frame given. One look at each page.
bool ChunkCache::try_evict_page(std::uint32_t touched_before, WorkCounters& work) noexcept
{
    std::uint32_t oldest = pages_->capacity();
    for (std::uint32_t slot = 0; slot < pages_->capacity(); ++slot)
    {
        const PageTable::Meta& meta = pages_->meta(slot);
        if (!meta.chunk.is_none() && meta.refined == 0 && meta.touched < touched_before &&
            (oldest == pages_->capacity() || meta.touched < pages_->meta(oldest).touched))
        {
            oldest = slot;
        }
    }
    if (oldest == pages_->capacity())
    {
        return false;
    }
    evict(oldest, work);
    return true;
}

void ChunkCache::evict_unpinned(WorkCounters& work) noexcept
{
    for (std::uint32_t slot = 0; slot < pages_->capacity(); ++slot)
    {
        const PageTable::Meta& meta = pages_->meta(slot);
        if (!meta.chunk.is_none() && meta.refined == 0)
        {
            evict(slot, work);
        }
    }
}

void ChunkCache::evict(std::uint32_t slot, WorkCounters& work) noexcept
{
    pages_->evict(slot);
    const bool freed = inbox_->freed.try_push({ContentKind::chunk, slot});
    TACTUS_ASSERT(freed);
    chunk_wishes_.give_back_slot();
    ++work.evictions;
    ++evictions_;
}

bool ChunkCache::try_evict_index_page() noexcept
{
    auto oldest = static_cast<std::uint32_t>(index_meta_.size());
    for (std::uint32_t slot = 0; slot < index_meta_.size(); ++slot)
    {
        const IndexMeta& meta = index_meta_[slot];
        if (!meta.page.is_none() && meta.touched < last_round_began_ &&
            (oldest == index_meta_.size() || meta.touched < index_meta_[oldest].touched))
        {
            oldest = slot;
        }
    }
    if (oldest == index_meta_.size())
    {
        return false;
    }
    index_slot_of_.erase(index_meta_[oldest].page.value);
    index_meta_[oldest] = IndexMeta{};
    const bool freed = inbox_->freed.try_push({ContentKind::index_page, oldest});
    TACTUS_ASSERT(freed);
    index_wishes_.give_back_slot();
    return true;
}

} // namespace tactus
