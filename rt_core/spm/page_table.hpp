// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/id_table.hpp"
#include "rt_core/spm/page_slots.hpp"

#include <bit>
#include <cstdint>
#include <span>

namespace tactus
{

/// The haptic thread's view of a model's pages: which chunk is in which slot, which of its records
/// are refined (split), and when it was last of use. Haptic thread only.
class PageTable
{
public:
    static_assert(kRecordsPerChunk <= 64); // Meta has a bit for each.
    struct Meta
    {
        ChunkId chunk{};          ///< None: the slot is the transport thread's.
        std::uint32_t touched{0}; ///< Frame number of the last use.
        std::uint64_t refined{0}; ///< One bit a record. The page is pinned while any is set.
        std::uint64_t held{0};    ///< Refined for a closure that isn't complete; not to be merged.
        std::uint64_t linked{0};  ///< As the inbox has told so far; the linker may know of more.
    };

    PageTable(Arena& arena, PageSlots slots) noexcept
        : slots_(slots)
        , slot_of_(arena, static_cast<std::uint32_t>(slots.pages.size()))
        , meta_(arena.take<Meta>(slots.pages.size()))
    {
    }

    /// `linked` has a bit for each record that find_linked() may return.
    void adopt(ChunkId chunk, std::uint32_t slot, std::uint32_t frame,
               std::uint64_t linked = 0) noexcept
    {
        TACTUS_ASSERT(!chunk.is_none());
        TACTUS_ASSERT(slot < meta_.size());
        TACTUS_ASSERT(meta_[slot].chunk.is_none());
        meta_[slot] = Meta{chunk, frame, 0, 0, linked};
        const bool inserted = slot_of_.try_insert(chunk.value, slot);
        TACTUS_ASSERT(inserted);
    }

    /// More records of the chunk are linked. No effect when the slot does not hold it any more: the
    /// update was on its way when the page was evicted.
    void update_linked(ChunkId chunk, std::uint32_t slot, std::uint64_t linked) noexcept
    {
        TACTUS_ASSERT(slot < meta_.size());
        if (meta_[slot].chunk == chunk)
        {
            TACTUS_ASSERT((meta_[slot].linked & ~linked) == 0);
            meta_[slot].linked = linked;
        }
    }

    /// Forgets an unpinned page; the slot may go back to the transport thread.
    void evict(std::uint32_t slot) noexcept
    {
        TACTUS_ASSERT(slot < meta_.size());
        TACTUS_ASSERT(!meta_[slot].chunk.is_none());
        TACTUS_ASSERT(meta_[slot].refined == 0);
        TACTUS_ASSERT(meta_[slot].held == 0);
        slot_of_.erase(meta_[slot].chunk.value);
        meta_[slot] = Meta{};
    }

    /// The chunk's slot, or IdTable::kAbsent.
    [[nodiscard]] std::uint32_t find(ChunkId chunk) const noexcept
    {
        return slot_of_.find(chunk.value);
    }

    /// The record when its page is adopted and it is linked; otherwise null.
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

    /// A record whose page must be here: refined records pin theirs.
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
        Meta& meta = meta_[slot_of_resident(record)];
        const std::uint64_t bit = bit_of(record);
        TACTUS_ASSERT(((meta.refined & bit) != 0) != refined);
        TACTUS_ASSERT((meta.held & bit) == 0);
        meta.refined ^= bit;
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
    [[nodiscard]] const Meta& meta(std::uint32_t slot) const noexcept { return meta_[slot]; }
    [[nodiscard]] std::uint32_t capacity() const noexcept
    {
        return static_cast<std::uint32_t>(meta_.size());
    }
    [[nodiscard]] std::uint32_t used() const noexcept { return slot_of_.size(); }
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

    PageSlots slots_;
    IdTable slot_of_;
    std::span<Meta> meta_;
};

} // namespace tactus
