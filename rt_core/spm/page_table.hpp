// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/base/id_table.hpp"
#include "rt_core/spm/page_pool.hpp"
#include "rt_core/spm/page_slots.hpp"

#include <bit>
#include <cstdint>
#include <span>

namespace tactus
{

/// The haptic thread's view of one model's pages: slot of each chunk, refined (split) records, and
/// last use. Haptic thread only.
class PageTable
{
public:
    using Meta = PageMeta;

    /// `pool` and `slots` are shared by all models; the pool has as many slots and outlives the
    /// table.
    PageTable(PagePool& pool, std::uint32_t owner, PageSlots slots) noexcept
        : pool_(&pool)
        , meta_(pool.metas)
        , slots_(slots)
        , owner_(owner)
        , first_key_(PagePool::first_key(owner))
    {
        TACTUS_ASSERT(slots.pages.size() == pool.metas.size());
    }

    /// Adds a page that arrived in a slot; `linked` has a bit for each record that find_linked()
    /// may return.
    void adopt(ChunkId chunk, std::uint32_t slot, std::uint32_t frame,
               std::uint64_t linked = 0) noexcept
    {
        TACTUS_ASSERT(!chunk.is_none());
        TACTUS_ASSERT(slot < meta_.size());
        TACTUS_ASSERT(meta_[slot].chunk.is_none());
        meta_[slot] = Meta{{chunk, owner_, 0}, 0, linked, frame};
        pool_->mark_changed(slot);
        const bool inserted = pool_->slot_of.try_insert(first_key_ + chunk.value, slot);
        TACTUS_ASSERT(inserted);
        ++used_;
    }

    /// Adds linked records of the chunk. No effect if the slot does not hold it any more: the
    /// update was under way when the page was evicted.
    void update_linked(ChunkId chunk, std::uint32_t slot, std::uint64_t linked) noexcept
    {
        TACTUS_ASSERT(slot < meta_.size());
        if (meta_[slot].chunk == chunk && meta_[slot].owner == owner_)
        {
            TACTUS_ASSERT((meta_[slot].linked & ~linked) == 0);
            meta_[slot].linked = linked;
        }
    }

    /// Removes an unpinned page; the slot may be returned to the transport thread.
    void evict(std::uint32_t slot) noexcept
    {
        TACTUS_ASSERT(slot < meta_.size());
        TACTUS_ASSERT(is_own(slot));
        TACTUS_ASSERT(meta_[slot].refined == 0);
        TACTUS_ASSERT(meta_[slot].held == 0);
        pool_->slot_of.erase(first_key_ + meta_[slot].chunk.value);
        meta_[slot] = Meta{};
        meta_[slot].owner = owner_;
        pool_->mark_changed(slot);
        --used_;
    }

    /// Clears the refined and held bits of a page, after VertexForest::leave().
    void forget_refined(std::uint32_t slot) noexcept
    {
        TACTUS_ASSERT(is_own(slot));
        meta_[slot].refined = 0;
        meta_[slot].held = 0;
        pool_->mark_changed(slot);
    }

    /// The chunk's slot, or IdTable::kAbsent.
    [[nodiscard]] std::uint32_t find(ChunkId chunk) const noexcept
    {
        return pool_->slot_of.find(first_key_ + chunk.value);
    }

    /// The record if its page is adopted and the record is linked; otherwise null.
    [[nodiscard]] VsplitRecord* find_linked(RecordId record) const noexcept
    {
        const std::uint32_t slot = find(chunk_of(record));
        return slot == IdTable::kAbsent ? nullptr : find_linked(record, slot);
    }
    /// The same for a record whose chunk is in `slot`.
    [[nodiscard]] VsplitRecord* find_linked(RecordId record, std::uint32_t slot) const noexcept
    {
        TACTUS_ASSERT(slot < meta_.size());
        TACTUS_ASSERT(meta_[slot].chunk == chunk_of(record));
        const std::uint32_t place = place_in_chunk(record);
        const bool is_linked = ((meta_[slot].linked >> place) & 1U) != 0;
        return is_linked ? &slots_.pages[slot].records[place] : nullptr;
    }

    /// Record of a page that must be resident (asserted). Pages with refined records always are.
    [[nodiscard]] VsplitRecord& resident(RecordId record) const noexcept
    {
        const std::uint32_t slot = find(chunk_of(record));
        TACTUS_ASSERT(slot != IdTable::kAbsent);
        return slots_.pages[slot].records[place_in_chunk(record)];
    }

    [[nodiscard]] bool is_refined(RecordId record) const noexcept
    {
        const std::uint32_t slot = find(chunk_of(record));
        return slot != IdTable::kAbsent &&
               ((meta_[slot].refined >> place_in_chunk(record)) & 1U) != 0;
    }
    void set_refined(RecordId record, bool refined) noexcept
    {
        const std::uint32_t slot = slot_of_resident(record);
        Meta& meta = meta_[slot];
        const std::uint64_t bit = bit_of(record);
        TACTUS_ASSERT(((meta.refined & bit) != 0) != refined);
        TACTUS_ASSERT((meta.held & bit) == 0);
        meta.refined ^= bit;
        pool_->mark_changed(slot);
    }
    [[nodiscard]] bool is_held(RecordId record) const noexcept
    {
        const std::uint32_t slot = find(chunk_of(record));
        return slot != IdTable::kAbsent && ((meta_[slot].held >> place_in_chunk(record)) & 1U) != 0;
    }
    void set_held(RecordId record, bool held) noexcept
    {
        Meta& meta = meta_[slot_of_resident(record)];
        const std::uint64_t bit = bit_of(record);
        TACTUS_ASSERT((meta.refined & bit) != 0);
        meta.held = held ? meta.held | bit : meta.held & ~bit;
    }

    void touch(std::uint32_t slot, std::uint32_t frame) noexcept
    {
        TACTUS_ASSERT(!meta_[slot].chunk.is_none());
        meta_[slot].touched = frame;
    }
    /// State of a slot of any model.
    [[nodiscard]] const Meta& meta(std::uint32_t slot) const noexcept { return meta_[slot]; }
    /// True if a page of this model is in the slot.
    [[nodiscard]] bool is_own(std::uint32_t slot) const noexcept
    {
        return meta_[slot].owner == owner_ && !meta_[slot].chunk.is_none();
    }
    [[nodiscard]] std::uint32_t owner() const noexcept { return owner_; }
    /// Number of slots of all models.
    [[nodiscard]] std::uint32_t capacity() const noexcept
    {
        return static_cast<std::uint32_t>(meta_.size());
    }
    [[nodiscard]] std::uint32_t used() const noexcept { return used_; }
    [[nodiscard]] const PageSlots& slots() const noexcept { return slots_; }

private:
    [[nodiscard]] std::uint32_t slot_of_resident(RecordId record) const noexcept
    {
        const std::uint32_t slot = find(chunk_of(record));
        TACTUS_ASSERT(slot != IdTable::kAbsent);
        return slot;
    }
    [[nodiscard]] static std::uint64_t bit_of(RecordId record) noexcept
    {
        return std::uint64_t{1} << place_in_chunk(record);
    }

    PagePool* pool_;
    std::span<Meta> meta_; ///< Span of the whole pool.
    PageSlots slots_;
    std::uint32_t owner_;
    std::uint32_t first_key_;
    std::uint32_t used_{0};
};

} // namespace tactus
