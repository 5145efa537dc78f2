// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/linker.hpp"

#include "rt_core/spm/chunk_coding.hpp"

#include <algorithm>
#include <atomic>

namespace tactus
{

namespace
{

constexpr std::size_t kListsPerPage = 16; ///< A quarter of the records that may wait at most.

/// Relaxed: see load_next(). The inbox publishes it together with the linked bit.
void store_next(std::uint32_t& next, RecordId id) noexcept
{
    std::atomic_ref<std::uint32_t>(next).store(id.value, std::memory_order_relaxed);
}

} // namespace

Linker::Linker(Arena& arena, const ModelCounts& counts, PageSlots slots) noexcept
    : counts_(counts)
    , slots_(slots)
    , slot_of_(arena, static_cast<std::uint32_t>(slots.pages.size()) + 1)
    , residents_(arena.take<Resident>(slots.pages.size()))
    , waiting_(arena.take<Waiting>(slots.pages.size() * kRecordsPerChunk))
    , lists_(arena.take<Seat>(slots.pages.size() * kListsPerPage))
    , owing_{.behind = arena.take<std::uint32_t>(slots.pages.size())}
{
    if (!arena.is_measuring())
    {
        TACTUS_ASSERT(waiting_.size() < kNoSeat);
        std::ranges::fill(lists_, kNoSeat);
        std::ranges::fill(owing_.behind, kNotOwing);
    }
}

void Linker::link_page(ChunkId chunk, std::uint32_t slot) noexcept
{
    TACTUS_ASSERT(slot < residents_.size() && residents_[slot].chunk.is_none());
    residents_[slot] = Resident{chunk, 0, 0, 0};
    const bool inserted = slot_of_.try_insert(chunk.value, slot);
    TACTUS_ASSERT(inserted);
    for (std::uint32_t place = 0; place < records_in_chunk(counts_, chunk); ++place)
    {
        settle((slot << kRecordsPerChunkLog2) + place);
    }
}

void Linker::release_page(std::uint32_t slot) noexcept
{
    TACTUS_ASSERT(slot < residents_.size() && !residents_[slot].chunk.is_none());
    const ChunkId chunk = residents_[slot].chunk;
    for (std::uint32_t place = 0; place < records_in_chunk(counts_, chunk); ++place)
    {
        stop_waiting((slot << kRecordsPerChunkLog2) + place);
    }
    slot_of_.erase(chunk.value); // From here on no dependent is found in this page itself.
    for (std::uint32_t place = 0; place < records_in_chunk(counts_, chunk); ++place)
    {
        let_dependents_wait((slot << kRecordsPerChunkLog2) + place);
    }
    residents_[slot] = Resident{};
}

std::uint64_t Linker::tell_linked(std::uint32_t slot) noexcept
{
    residents_[slot].told = residents_[slot].linked;
    return residents_[slot].linked;
}

bool Linker::try_take_update(Update& update) noexcept
{
    while (!owing_.is_empty)
    {
        const std::uint32_t slot = owing_.first;
        owing_.is_empty = slot == owing_.last;
        owing_.first = owing_.behind[slot];
        owing_.behind[slot] = kNotOwing;
        // Told with its arrival, or given back meanwhile: then it owes nothing any more.
        if (residents_[slot].linked != residents_[slot].told)
        {
            update = {residents_[slot].chunk, slot, tell_linked(slot)};
            return true;
        }
    }
    return false;
}

void Linker::owe_update(std::uint32_t slot) noexcept
{
    if (owing_.behind[slot] != kNotOwing)
    {
        return;
    }
    owing_.behind[slot] = slot;
    if (owing_.is_empty)
    {
        owing_.first = slot;
    }
    else
    {
        owing_.behind[owing_.last] = slot;
    }
    owing_.last = slot;
    owing_.is_empty = false;
}

/// Links the record if nothing is missing, then those that waited for it, and so on. Every turn
/// takes a record off a list and puts it back for a later dependency at most, so this ends.
void Linker::settle(Seat seat) noexcept
{
    waiting_[seat].value = kNoSeat << 3U;
    ready_ = seat;
    while (ready_ != kNoSeat)
    {
        const Seat now = ready_;
        ready_ = waiting_[now].behind();
        waiting_[now] = {};
        ++looks_;
        if (is_linked(now))
        {
            mend_next(now);
        }
        else if (try_link(now))
        {
            wake_waiting(id_of(now));
        }
    }
}

bool Linker::try_link(Seat seat) noexcept
{
    const VsplitRecord& record = record_at(seat);
    const RecordId id = id_of(seat);
    std::uint32_t depth = 0;
    std::uint32_t missing = record.fan_size;
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        const FaceState state = record.before[i];
        if (!state.is_base() && !owner_is_linked(state))
        {
            missing = std::min(missing, i);
            continue;
        }
        if (!is_possible(id, record, i))
        {
            refuse(seat);
            return false;
        }
        depth = state.is_base() ? depth : std::max<std::uint32_t>(depth, owner(state).depth);
    }
    if (missing < record.fan_size)
    {
        wait_for_owner(seat, missing);
        return false;
    }
    if (record.depth != depth + 1)
    {
        refuse(seat);
        return false;
    }
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        store_next(next_of(record.star[2 + i], record.before[i]), id);
    }
    const std::uint32_t slot = seat >> kRecordsPerChunkLog2;
    residents_[slot].linked |= std::uint64_t{1} << (seat % kRecordsPerChunk);
    owe_update(slot);
    ++linked_count_;
    return true;
}

/// May this record split the fan face, as far as the face's owner tells? Exact faces are never
/// split, taken ones not by a second record.
bool Linker::is_possible(RecordId id, const VsplitRecord& record,
                         std::uint32_t fan_place) const noexcept
{
    const FaceId face = record.star[2 + fan_place];
    const FaceState state = record.before[fan_place];
    if (!state.is_base() && owner(state).star[state.place()] != face)
    {
        return false;
    }
    const std::uint32_t next = next_of(face, state);
    return next == kNextPending || next == id.value;
}

void Linker::refuse(Seat seat) noexcept
{
    residents_[seat >> kRecordsPerChunkLog2].refused |= std::uint64_t{1}
                                                        << (seat % kRecordsPerChunk);
    ++refused_count_;
}

/// A linked record of which an owner came back: sets what isn't set any more, and waits for the
/// next owner that is away.
void Linker::mend_next(Seat seat) noexcept
{
    const VsplitRecord& record = record_at(seat);
    std::uint32_t missing = record.fan_size;
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        const FaceState state = record.before[i];
        if (state.is_base())
        {
            continue;
        }
        if (!owner_is_linked(state))
        {
            missing = std::min(missing, i);
        }
        else if (std::uint32_t& next = next_of(record.star[2 + i], state); next == kNextPending)
        {
            store_next(next, id_of(seat)); // Otherwise taken, by this record or a rival of it.
        }
    }
    if (missing < record.fan_size)
    {
        wait_for_owner(seat, missing);
    }
}

void Linker::wait_for_owner(Seat seat, std::uint32_t fan_place) noexcept
{
    Seat& first = list_of(record_at(seat).before[fan_place].record());
    waiting_[seat].value = first << 3U | fan_place;
    first = seat;
}

void Linker::wake_waiting(RecordId linked) noexcept
{
    Seat kept = kNoSeat;
    for (Seat seat = list_of(linked); seat != kNoSeat;)
    {
        const Seat behind = waiting_[seat].behind();
        const std::uint32_t fan_place = waiting_[seat].fan_place();
        const bool is_ready = record_at(seat).before[fan_place].record() == linked;
        Seat& list = is_ready ? ready_ : kept;
        waiting_[seat].value = list << 3U | fan_place;
        list = seat;
        seat = behind;
    }
    list_of(linked) = kept;
}

void Linker::stop_waiting(Seat seat) noexcept
{
    if (!waiting_[seat].is_in_list())
    {
        return;
    }
    const std::uint32_t fan_place = waiting_[seat].fan_place();
    Seat& first = list_of(record_at(seat).before[fan_place].record());
    const Seat behind = waiting_[seat].behind();
    if (first == seat)
    {
        first = behind;
    }
    else
    {
        Seat before = first;
        while (waiting_[before].behind() != seat)
        {
            before = waiting_[before].behind();
        }
        waiting_[before].value = behind << 3U | waiting_[before].fan_place();
    }
    waiting_[seat] = {};
}

/// The linked records that stand in the `next` of one that leaves have to set them anew when it
/// comes back.
void Linker::let_dependents_wait(Seat leaving) noexcept
{
    const RecordId id = id_of(leaving);
    const VsplitRecord& record = record_at(leaving);
    for (std::uint32_t place = 0; place < record.star_end(); ++place)
    {
        const std::uint32_t next = record.next[place];
        if (record.star[place].is_none() || next == kNextExact || next == kNextPending)
        {
            continue;
        }
        const Seat dependent = seat_of({next});
        if (dependent == kNoSeat || !is_linked(dependent) || waiting_[dependent].is_in_list())
        {
            continue; // Away, or it looks at all its owners when the one it waits for comes back.
        }
        const auto& before = record_at(dependent).before;
        const auto found = std::ranges::find(before, FaceState::after(id, place));
        TACTUS_ASSERT(found != before.end());
        wait_for_owner(dependent, static_cast<std::uint32_t>(found - before.begin()));
    }
}

bool Linker::owner_is_linked(FaceState state) const noexcept
{
    const Seat seat = seat_of(state.record());
    return seat != kNoSeat && is_linked(seat);
}

VsplitRecord& Linker::owner(FaceState state) const noexcept
{
    const Seat seat = seat_of(state.record());
    TACTUS_ASSERT(seat != kNoSeat);
    return record_at(seat);
}

std::uint32_t& Linker::next_of(FaceId face, FaceState state) const noexcept
{
    return state.is_base() ? slots_.base.next[face.value] : owner(state).next[state.place()];
}

/// kNoSeat when the record's page is away.
Linker::Seat Linker::seat_of(RecordId record) const noexcept
{
    const std::uint32_t slot = slot_of_.find(chunk_of(record).value);
    return slot == IdTable::kAbsent ? kNoSeat
                                    : (slot << kRecordsPerChunkLog2) + place_in_chunk(record);
}

RecordId Linker::id_of(Seat seat) const noexcept
{
    const ChunkId chunk = residents_[seat >> kRecordsPerChunkLog2].chunk;
    return {(chunk.value << kRecordsPerChunkLog2) + seat % kRecordsPerChunk};
}

VsplitRecord& Linker::record_at(Seat seat) const noexcept
{
    return slots_.pages[seat >> kRecordsPerChunkLog2].records[seat % kRecordsPerChunk];
}

bool Linker::is_linked(Seat seat) const noexcept
{
    const std::uint64_t linked = residents_[seat >> kRecordsPerChunkLog2].linked;
    return ((linked >> (seat % kRecordsPerChunk)) & 1U) != 0;
}

Linker::Seat& Linker::list_of(RecordId awaited) noexcept
{
    const std::uint32_t mixed = awaited.value * 0x9E37'79B9U;
    return lists_[(std::uint64_t{mixed} * lists_.size()) >> 32U];
}

} // namespace tactus
