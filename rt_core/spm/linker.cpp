// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/linker.hpp"

#include "rt_core/spm/chunk_coding.hpp"

#include <atomic>
#include <bit>

namespace tactus
{

Linker::Linker(Arena& arena, const ModelCounts& counts, PageSlots slots) noexcept
    : counts_(counts)
    , slots_(slots)
    , slot_of_(arena, static_cast<std::uint32_t>(slots.pages.size()) + 1)
    , residents_(arena.take<Resident>(slots.pages.size()))
{
}

void Linker::link_page(ChunkId chunk, std::uint32_t slot) noexcept
{
    TACTUS_ASSERT(slot < residents_.size() && residents_[slot].chunk.is_none());
    residents_[slot] = Resident{chunk, {}, 0, 0, 0, true};
    update_cursor_ = 0;
    const bool inserted = slot_of_.try_insert(chunk.value, slot);
    TACTUS_ASSERT(inserted);
    slots_in_use_end_ = slot + 1 > slots_in_use_end_ ? slot + 1 : slots_in_use_end_;
    sign(slot);
    for (std::uint32_t place = 0; place < records_in_chunk(counts_, chunk); ++place)
    {
        try_link(slot, place);
    }
    // Every pass that goes on has linked at least one more record, so this ends.
    for (bool any = true; any;)
    {
        any = false;
        for (std::uint32_t source = 0; source < slots_in_use_end_; ++source)
        {
            if (!residents_[source].changed)
            {
                continue;
            }
            residents_[source].changed = false;
            any = true;
            for (std::uint32_t other = 0; other < slots_in_use_end_; ++other)
            {
                look_again(other, residents_[source].chunk);
            }
        }
    }
}

void Linker::release_page(std::uint32_t slot) noexcept
{
    TACTUS_ASSERT(slot < residents_.size() && !residents_[slot].chunk.is_none());
    slot_of_.erase(residents_[slot].chunk.value);
    residents_[slot] = Resident{};
    any_released_ = true;
}

std::uint64_t Linker::tell_linked(std::uint32_t slot) noexcept
{
    residents_[slot].told = residents_[slot].linked;
    return residents_[slot].linked;
}

bool Linker::try_take_update(Update& update) noexcept
{
    for (; update_cursor_ < slots_in_use_end_; ++update_cursor_)
    {
        const Resident& resident = residents_[update_cursor_];
        if (resident.linked != resident.told)
        {
            update = {resident.chunk, update_cursor_, tell_linked(update_cursor_)};
            return true;
        }
    }
    return false;
}

bool Linker::has_waiting_records(std::uint32_t slot) const noexcept
{
    const std::uint64_t settled = residents_[slot].linked | residents_[slot].refused;
    return static_cast<std::uint32_t>(std::popcount(settled)) <
           records_in_chunk(counts_, residents_[slot].chunk);
}

void Linker::sign(std::uint32_t slot) noexcept
{
    Resident& resident = residents_[slot];
    for (std::uint32_t place = 0; place < records_in_chunk(counts_, resident.chunk); ++place)
    {
        const VsplitRecord& record = slots_.pages[slot].records[place];
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            if (!record.before[i].is_base())
            {
                resident.refers_to.add(chunk_of(record.before[i].record()));
            }
        }
    }
}

/// `changed` has come in or has more linked records: what in this page waited for that?
void Linker::look_again(std::uint32_t slot, ChunkId changed) noexcept
{
    const Resident& resident = residents_[slot];
    if (resident.chunk.is_none() || !resident.refers_to.may_hold(changed))
    {
        return;
    }
    // A page whose records are all linked only has something to mend when one came back.
    if (!any_released_ && !has_waiting_records(slot))
    {
        return;
    }
    for (std::uint32_t place = 0; place < records_in_chunk(counts_, resident.chunk); ++place)
    {
        if (is_linked(slot, place))
        {
            relink_next(slot, place, changed);
        }
        else
        {
            try_link(slot, place);
        }
    }
}

void Linker::relink_next(std::uint32_t slot, std::uint32_t place, ChunkId changed) noexcept
{
    const VsplitRecord& record = slots_.pages[slot].records[place];
    const std::uint32_t id = (residents_[slot].chunk.value << kRecordsPerChunkLog2) + place;
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        const FaceState state = record.before[i];
        if (!state.is_base() && chunk_of(state.record()) == changed)
        {
            std::uint32_t* next = next_of(record.star[2 + i], state);
            if (*next == kNextPending) // Otherwise taken, by this record or a rival of it.
            {
                // Relaxed, pairs with nothing: see load_next().
                std::atomic_ref<std::uint32_t>(*next).store(id, std::memory_order_relaxed);
            }
        }
    }
}

void Linker::try_link(std::uint32_t slot, std::uint32_t place) noexcept
{
    Resident& resident = residents_[slot];
    const std::uint64_t bit = std::uint64_t{1} << place;
    if ((resident.refused & bit) != 0 || is_linked(slot, place))
    {
        return;
    }
    const RecordId id{(resident.chunk.value << kRecordsPerChunkLog2) + place};
    const VsplitRecord& record = slots_.pages[slot].records[place];
    const Fit result = fit(id, record);
    if (result == Fit::refused)
    {
        resident.refused |= bit;
        ++refused_count_;
    }
    if (result != Fit::fits)
    {
        return;
    }
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        std::uint32_t* next = next_of(record.star[2 + i], record.before[i]);
        // Relaxed: see load_next(). The inbox publishes it together with the linked bit.
        std::atomic_ref<std::uint32_t>(*next).store(id.value, std::memory_order_relaxed);
    }
    resident.linked |= bit;
    resident.changed = true;
    ++linked_count_;
}

Linker::Fit Linker::fit(RecordId id, const VsplitRecord& record) const noexcept
{
    bool waits = false;
    std::uint32_t depth = 0;
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        const Fit one = fit_one(id, record, i, depth);
        if (one == Fit::refused)
        {
            return Fit::refused;
        }
        waits = waits || one == Fit::waits;
    }
    if (waits)
    {
        return Fit::waits;
    }
    return record.depth == depth + 1 ? Fit::fits : Fit::refused;
}

Linker::Fit Linker::fit_one(RecordId id, const VsplitRecord& record, std::uint32_t fan_place,
                            std::uint32_t& depth) const noexcept
{
    const FaceId face = record.star[2 + fan_place];
    const FaceState state = record.before[fan_place];
    if (!state.is_base())
    {
        const std::uint32_t slot = slot_of_.find(chunk_of(state.record()).value);
        if (slot == IdTable::kAbsent || !is_linked(slot, place_in_chunk(state.record())))
        {
            return Fit::waits;
        }
        const VsplitRecord& owner = slots_.pages[slot].records[place_in_chunk(state.record())];
        if (owner.star[state.place()] != face)
        {
            return Fit::refused;
        }
        depth = owner.depth > depth ? owner.depth : depth;
    }
    // The owner is here, so `next` is: exact faces are never split, taken ones not by a second.
    const std::uint32_t next = *next_of(face, state);
    return next == kNextPending || next == id.value ? Fit::fits : Fit::refused;
}

std::uint32_t* Linker::next_of(FaceId face, FaceState state) const noexcept
{
    if (state.is_base())
    {
        return &slots_.base.next[face.value];
    }
    const std::uint32_t slot = slot_of_.find(chunk_of(state.record()).value);
    TACTUS_ASSERT(slot != IdTable::kAbsent);
    return &slots_.pages[slot].records[place_in_chunk(state.record())].next[state.place()];
}

bool Linker::is_linked(std::uint32_t slot, std::uint32_t place) const noexcept
{
    return ((residents_[slot].linked >> place) & 1U) != 0;
}

void Linker::Signature::add(ChunkId chunk) noexcept
{
    const std::uint32_t hash = (chunk.value * 0x9E37'79B9U) >> 24U;
    bits[hash / 64] |= std::uint64_t{1} << (hash % 64);
}

bool Linker::Signature::may_hold(ChunkId chunk) const noexcept
{
    const std::uint32_t hash = (chunk.value * 0x9E37'79B9U) >> 24U;
    return ((bits[hash / 64] >> (hash % 64)) & 1U) != 0;
}

} // namespace tactus
