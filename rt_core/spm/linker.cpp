// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/linker.hpp"

#include "rt_core/spm/chunk_coding.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

namespace tactus
{

namespace
{

/// Relaxed order, see load_next(): SlotQueues::arrived publishes it together with the linked bit.
void store_next(std::uint32_t& next, RecordId id) noexcept
{
    std::atomic_ref<std::uint32_t>(next).store(id.value, std::memory_order_relaxed);
}

} // namespace

LinkPool::LinkPool(Arena& arena, std::size_t slots) noexcept
    : slot_of_(arena, static_cast<std::uint32_t>(slots) + 1)
    , residents_(arena.take<Resident>(slots))
    , rings_(arena.take<StarRing>(slots * kRecordsPerChunk))
    , waiting_(arena.take<Waiting>(slots * kRecordsPerChunk))
    , lists_(arena.take<Seat>(slots * kListsPerPage))
    , behind_(arena.take<std::uint32_t>(slots))
{
    if (!arena.is_measuring())
    {
        TACTUS_ASSERT(waiting_.size() < kNowhere);
        std::ranges::fill(lists_, kNoSeat);
        std::ranges::fill(behind_, kNotOwing);
    }
}

Linker::Linker(LinkPool& pool, std::uint32_t owner, const ModelHeader& header,
               PageSlots slots) noexcept
    : header_(header)
    , counts_(header.counts())
    , slots_(slots)
    , owner_(owner)
    , pool_(&pool)
    , residents_(pool.residents_)
    , rings_(pool.rings_)
    , waiting_(pool.waiting_)
    , lists_(pool.lists_)
    , owing_{.behind = pool.behind_}
{
    TACTUS_ASSERT(residents_.size() == slots.pages.size());
}

void Linker::set_base(const BaseMesh& base) noexcept
{
    TACTUS_ASSERT(pages_here_ == 0);
    slots_.base = base;
}

void Linker::link_page(ChunkId chunk, std::uint32_t slot) noexcept
{
    TACTUS_ASSERT(has_base());
    ++pages_here_;
    TACTUS_ASSERT(chunk.value < counts_.chunks());
    TACTUS_ASSERT(slot < residents_.size());
    TACTUS_ASSERT(residents_[slot].chunk.is_none());
    residents_[slot] = Resident{chunk, owner_, 0, 0};
    const bool inserted =
        pool_->slot_of_.try_insert(PagePool::first_key(owner_) + chunk.value, slot);
    TACTUS_ASSERT(inserted);
    for (std::uint32_t place = 0; place < records_in_chunk(counts_, chunk); ++place)
    {
        link_or_wait((slot << kRecordsPerChunkLog2) + place);
    }
}

void Linker::release_page(std::uint32_t slot) noexcept
{
    TACTUS_ASSERT(slot < residents_.size());
    TACTUS_ASSERT(!residents_[slot].chunk.is_none());
    TACTUS_ASSERT(residents_[slot].owner == owner_);
    TACTUS_ASSERT(pages_here_ > 0);
    --pages_here_;
    const ChunkId chunk = residents_[slot].chunk;
    for (std::uint32_t place = 0; place < records_in_chunk(counts_, chunk); ++place)
    {
        stop_waiting((slot << kRecordsPerChunkLog2) + place);
    }
    // From here on seat_of() finds no record of this page: the loop below skips its own records.
    pool_->slot_of_.erase(PagePool::first_key(owner_) + chunk.value);
    for (std::uint32_t place = 0; place < records_in_chunk(counts_, chunk); ++place)
    {
        let_dependents_wait((slot << kRecordsPerChunkLog2) + place);
    }
    residents_[slot] = Resident{};
    owe_nothing(slot); // Another model may have the slot next.
}

std::uint64_t Linker::tell_linked(std::uint32_t slot) noexcept
{
    TACTUS_ASSERT(slot < residents_.size());
    TACTUS_ASSERT(!residents_[slot].chunk.is_none());
    residents_[slot].told = residents_[slot].linked;
    return residents_[slot].linked;
}

bool Linker::try_take_update(Update& update) noexcept
{
    while (!owing_.is_empty)
    {
        const std::uint32_t slot = owing_.first;
        TACTUS_ASSERT(owing_.behind[slot] != kNotOwing);
        owing_.is_empty = slot == owing_.last;
        owing_.first = owing_.behind[slot];
        owing_.behind[slot] = kNotOwing;
        // Updates reported with the arrival are no longer owed.
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
        TACTUS_ASSERT(owing_.behind[owing_.last] == owing_.last);
        owing_.behind[owing_.last] = slot;
    }
    owing_.last = slot;
    owing_.is_empty = false;
}

/// Removes a slot from the list. One step per slot that owes an update.
void Linker::owe_nothing(std::uint32_t slot) noexcept
{
    if (owing_.behind[slot] == kNotOwing)
    {
        return;
    }
    const std::uint32_t next = std::exchange(owing_.behind[slot], kNotOwing);
    const bool is_last = slot == owing_.last;
    if (slot == owing_.first)
    {
        owing_.is_empty = is_last;
        owing_.first = next;
        return;
    }
    std::uint32_t before = owing_.first;
    while (owing_.behind[before] != slot)
    {
        TACTUS_ASSERT(before != owing_.last);
        before = owing_.behind[before];
    }
    owing_.behind[before] = is_last ? before : next;
    owing_.last = is_last ? before : owing_.last;
}

/// Links the record if nothing is missing, then those that waited for it, and so on. Every turn
/// takes a record off a list and at most puts it back for a later dependency, so this ends.
void Linker::link_or_wait(Seat seat) noexcept
{
    TACTUS_ASSERT(ready_ == kNoSeat);
    TACTUS_ASSERT(!waiting_[seat].is_in_list());
    waiting_[seat].behind = kNoSeat;
    ready_ = seat;
    while (ready_ != kNoSeat)
    {
        const Seat now = ready_;
        ready_ = waiting_[now].behind;
        waiting_[now] = {};
        ++looks_;
        if (is_linked_at(now))
        {
            repair_next(now);
        }
        else if (try_link(now))
        {
            wake_waiting(id_of(now));
        }
    }
}

bool Linker::try_link(Seat seat) noexcept
{
    using Resolver = StarResolver<Linker>;
    const RecordId id = id_of(seat);
    Resolver resolver(*this, counts_, slots_.base.view(), header_.fields(), header_.quantum_m());
    switch (resolver.resolve(id, coded_form(record_at(seat))))
    {
    case Resolver::Outcome::waits:
        wait_for(seat, resolver.missing());
        return false;
    case Resolver::Outcome::resolved:
        if (is_free_for(id, resolver.record()))
        {
            link(seat, resolver.record(), resolver.ring());
            return true;
        }
        break;
    case Resolver::Outcome::refused:
        break;
    }
    ++refused_count_;
    return false;
}

void Linker::link(Seat seat, const VsplitRecord& record, const StarRing& ring) noexcept
{
    TACTUS_ASSERT(!is_linked_at(seat));
    TACTUS_ASSERT(record.fan_size > 0);
    record_at(seat) = record;
    rings_[seat] = ring;
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        store_next(next_of(record.star[2 + i], record.before[i]), id_of(seat));
    }
    const std::uint32_t slot = seat >> kRecordsPerChunkLog2;
    residents_[slot].linked |= std::uint64_t{1} << (seat % kRecordsPerChunk);
    owe_update(slot);
    ++linked_count_;
}

/// True if this record may split its fan faces: exact faces are never split, taken ones not by a
/// second record.
bool Linker::is_free_for(RecordId id, const VsplitRecord& record) const noexcept
{
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        const std::uint32_t next = next_of(record.star[2 + i], record.before[i]);
        if (next != kNextPending && next != id.value)
        {
            return false;
        }
    }
    return true;
}

/// Sets the pending `next` of a linked record's owners after one of them returned, and waits for
/// the next absent owner.
void Linker::repair_next(Seat seat) noexcept
{
    const VsplitRecord& record = record_at(seat);
    RecordId missing{};
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        const FaceState state = record.before[i];
        if (state.is_base())
        {
            continue;
        }
        if (!is_linked(state.record()))
        {
            missing = missing.is_none() ? state.record() : missing;
        }
        else if (std::uint32_t& next = next_of(record.star[2 + i], state); next == kNextPending)
        {
            store_next(next, id_of(seat)); // Otherwise a record has it.
        }
    }
    if (!missing.is_none())
    {
        wait_for(seat, missing);
    }
}

void Linker::wait_for(Seat seat, RecordId awaited) noexcept
{
    TACTUS_ASSERT(!awaited.is_none());
    TACTUS_ASSERT(!waiting_[seat].is_in_list());
    Seat& first = list_of(awaited);
    waiting_[seat] = {awaited, first};
    first = seat;
}

void Linker::wake_waiting(RecordId linked) noexcept
{
    Seat kept = kNoSeat;
    for (Seat seat = list_of(linked); seat != kNoSeat;)
    {
        const Seat behind = waiting_[seat].behind;
        const bool is_own = residents_[seat >> kRecordsPerChunkLog2].owner == owner_;
        Seat& list = is_own && waiting_[seat].awaited == linked ? ready_ : kept;
        waiting_[seat].behind = list;
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
    Seat* link = &list_of(waiting_[seat].awaited);
    while (*link != seat)
    {
        TACTUS_ASSERT(*link != kNoSeat);
        link = &waiting_[*link].behind;
    }
    *link = waiting_[seat].behind;
    waiting_[seat] = {};
}

/// Makes the linked records named in the `next` of a leaving record wait for its return, when they
/// set it again.
void Linker::let_dependents_wait(Seat leaving) noexcept
{
    if (!is_linked_at(leaving))
    {
        return;
    }
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
        if (dependent == kNoSeat || !is_linked_at(dependent) || waiting_[dependent].is_in_list())
        {
            // The dependent is absent, or waits for an owner and checks all of them later.
            continue;
        }
        wait_for(dependent, id);
    }
}

LinkedStar Linker::find(RecordId id) const noexcept
{
    const Seat seat = seat_of(id);
    return seat != kNoSeat && is_linked_at(seat) ? LinkedStar{&record_at(seat), &rings_[seat], id}
                                                 : LinkedStar{};
}

bool Linker::is_linked(RecordId record) const noexcept
{
    const Seat seat = seat_of(record);
    return seat != kNoSeat && is_linked_at(seat);
}

std::uint32_t& Linker::next_of(FaceId face, FaceState state) const noexcept
{
    if (state.is_base())
    {
        TACTUS_ASSERT(counts_.is_base(face));
        return slots_.base.next[face.value];
    }
    const Seat owner = seat_of(state.record());
    TACTUS_ASSERT(owner != kNoSeat);
    return record_at(owner).next[state.place()];
}

/// Seat of a record; kNoSeat if its page is absent.
Linker::Seat Linker::seat_of(RecordId record) const noexcept
{
    const std::uint32_t slot = slot_of(chunk_of(record));
    return slot == IdTable::kAbsent ? kNoSeat
                                    : (slot << kRecordsPerChunkLog2) + place_in_chunk(record);
}

RecordId Linker::id_of(Seat seat) const noexcept
{
    const ChunkId chunk = residents_[seat >> kRecordsPerChunkLog2].chunk;
    TACTUS_ASSERT(!chunk.is_none());
    return {(chunk.value << kRecordsPerChunkLog2) + seat % kRecordsPerChunk};
}

VsplitRecord& Linker::record_at(Seat seat) const noexcept
{
    return slots_.pages[seat >> kRecordsPerChunkLog2].records[seat % kRecordsPerChunk];
}

bool Linker::is_linked_at(Seat seat) const noexcept
{
    const std::uint64_t linked = residents_[seat >> kRecordsPerChunkLog2].linked;
    return ((linked >> (seat % kRecordsPerChunk)) & 1U) != 0;
}

Linker::Seat& Linker::list_of(RecordId awaited) noexcept
{
    const std::uint32_t mixed = (awaited.value + owner_ * 0x85EB'CA6BU) * 0x9E37'79B9U;
    return lists_[(std::uint64_t{mixed} * lists_.size()) >> 32U];
}

} // namespace tactus
