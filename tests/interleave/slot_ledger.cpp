// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/interleave/slot_ledger.hpp"

#include "rt_core/spm/chunk_coding.hpp"
#include "transport/served_model.hpp"

#include <cstring>

namespace tactus::interleave
{

namespace
{

/// Compares all but `next`, which the transport thread may be writing.
bool is_same_but_next(const VsplitRecord& a, const VsplitRecord& b)
{
    return a.position_m == b.position_m && a.parent == b.parent && a.star == b.star &&
           a.before == b.before && a.error == b.error && a.bucket == b.bucket &&
           a.depth == b.depth && a.fan_size == b.fan_size && a.reach == b.reach;
}

} // namespace

Truth::Truth(const test::TinyModel& tiny)
    : model(tiny), header(parse_trusted_header(tiny.header).value()), parsed(tiny.chunks.size())
{
    for (std::uint32_t chunk = 0; chunk < parsed.size(); ++chunk)
    {
        const auto done = parse_chunk(tiny.chunks[chunk], header, {chunk}, parsed[chunk]);
        TACTUS_ASSERT(done.has_value());
    }
    for (bool is_more = true; is_more;) // A record whose dependencies are linkable is linkable too.
    {
        is_more = false;
        for (std::uint32_t id = 0; id < linkable.size() * kRecordsPerChunk; ++id)
        {
            std::uint64_t& chunk = linkable.at(id / kRecordsPerChunk);
            const std::uint64_t bit = std::uint64_t{1} << (id % kRecordsPerChunk);
            if ((chunk & bit) == 0 && depends_on_linkable(id))
            {
                chunk |= bit;
                is_more = true;
            }
        }
    }
}

bool Truth::is_linkable(RecordId record) const
{
    const std::uint32_t chunk = record.value / kRecordsPerChunk;
    return chunk < linkable.size() &&
           ((linkable.at(chunk) >> (record.value % kRecordsPerChunk)) & 1U) != 0;
}

bool Truth::depends_on_linkable(std::uint32_t id) const
{
    const VsplitRecord& record = model.records[id];
    const auto is_resident = [&](VertexId vertex)
    { return model.counts.is_base(vertex) || is_linkable(model.counts.record_of(vertex)); };
    bool all = is_resident(record.parent) && is_resident(model.rings[id].w[record.fan_size]);
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        const FaceState state = record.before[i];
        all = all && is_resident(model.rings[id].w[i]) &&
              (state.is_base() || is_linkable(state.record()));
    }
    return all;
}

SlotLedger::SlotLedger(const Truth& truth, const PageSlots& slots, const PageTable& pages)
    : truth_(truth), pages_(slots), table_(pages), slots_(slots.pages.size())
{
}

void SlotLedger::receive(ContentKey key, std::span<const std::byte> /*bytes*/)
{
    on_their_way_.push_back({key, freed_at_step_});
    ++(key.kind == ContentKind::chunk ? handed_chunks_ : handed_indices_);
}

void SlotLedger::adopted(const QueueTake& take)
{
    for (const QueueEvent& event : take.events)
    {
        if (event.kind == QueueEventKind::link_update)
        {
            update(event);
            continue;
        }
        adopt(event);
    }
}

void SlotLedger::adopt(const QueueEvent& arrival)
{
    const std::uint32_t number = arrival.key.number;
    require(!on_their_way_.empty(), "adopted what was never handed over", number);
    if (has_failed())
    {
        return;
    }
    const HandOver expected = on_their_way_.front();
    on_their_way_.pop_front();
    require(expected.key == arrival.key, "adopted out of order", number);
    require(expected.freed == arrival.freed_taken, "a wrong count of slots taken back", number);
    if (arrival.key.kind != ContentKind::chunk)
    {
        --handed_indices_;
        return;
    }
    --handed_chunks_;
    for (const Slot& other : slots_)
    {
        require(other.chunk.value != number, "adopted a second time", number);
    }
    Slot& slot = slots_.at(arrival.slot);
    require(slot.chunk.is_none(), "adopted into a slot that is in use", arrival.slot);
    require(slot.freed_as <= arrival.freed_taken, "filled before it was taken back", arrival.slot);
    slot.chunk = {number};
    slot.told = arrival.linked;
}

void SlotLedger::update(const QueueEvent& update)
{
    require(update.key.kind == ContentKind::chunk, "an update of an index page");
    Slot& slot = slots_.at(update.slot);
    if (slot.chunk.value != update.key.number)
    {
        ++late_updates_; // The slot was freed meanwhile.
        return;
    }
    ++updates_;
    require((slot.told & ~update.linked) == 0, "a record is unlinked", update.slot);
    slot.told = update.linked;
}

void SlotLedger::find_freed()
{
    for (std::uint32_t at = 0; at < slots_.size(); ++at)
    {
        Slot& slot = slots_[at];
        if (!slot.chunk.is_none() && table_.meta(at).chunk.is_none())
        {
            slot = {ChunkId{}, 0, ++freed_};
        }
    }
}

void SlotLedger::check(const ChunkLoader& chunk_loader, const SlotQueues& queues,
                       const ChunkCache& cache)
{
    // Freed slots are of pages alone: no index page returns here.
    const std::size_t freed = queues.freed.size();
    require(chunk_loader.free_pages() + handed_chunks_ + table_.used() + freed == slots_.size(),
            "a page slot is in no place or in two");
    require(chunk_loader.free_index_pages() + handed_indices_ + cache.index_pages_used() ==
                pages_.index_pages.size(),
            "a slot of index pages is in no place or in two");
    require(queues.arrived.size() <= queues.arrived.capacity(), "too many arrivals");
    require(queues.wanted.size() <= queues.wanted.capacity(), "too many requests");
    for (std::uint32_t slot = 0; slot < slots_.size(); ++slot)
    {
        const PageTable::Meta& meta = table_.meta(slot);
        require(meta.chunk == slots_[slot].chunk, "the page table has another chunk", slot);
        require(meta.linked == slots_[slot].told, "the page table has other linked bits", slot);
        if (!meta.chunk.is_none() && !has_failed())
        {
            check_page(slot);
        }
    }
}

void SlotLedger::check_page(std::uint32_t slot)
{
    const ChunkId chunk = slots_[slot].chunk;
    for (std::uint32_t place = 0; place < records_in_chunk(truth_.model.counts, chunk); ++place)
    {
        const std::uint32_t id = chunk.value * kRecordsPerChunk + place;
        const VsplitRecord& record = pages_.pages[slot].records[place];
        const bool is_linked_form = is_same_but_next(record, truth_.model.records[id]);
        if (((slots_[slot].told >> place) & 1U) == 0)
        {
            const VsplitRecord& parsed = truth_.parsed[chunk.value].records[place];
            require(is_linked_form || std::memcmp(&record, &parsed, sizeof(parsed)) == 0,
                    "a waiting record is not what its chunk says", id);
            continue;
        }
        require(is_linked_form, "a record told as linked is not what the model says", id);
        check_links(record, id);
    }
}

void SlotLedger::check_links(const VsplitRecord& record, std::uint32_t id)
{
    const VsplitRecord& expected = truth_.model.records[id];
    for (std::uint32_t i = 0; i < kMaxStarFaces; ++i)
    {
        const std::uint32_t next = record.next[i];
        if (!expected.star[i].is_none() && next != expected.next[i])
        {
            require(next == kNextPending, "a next names another record", id);
            require(!has_all_it_needs(expected.next[i]), "a next is not set", id);
        }
    }
}

bool SlotLedger::is_told(std::uint32_t record) const
{
    return ((told({record / kRecordsPerChunk}) >> (record % kRecordsPerChunk)) & 1U) != 0;
}

bool SlotLedger::has_all_it_needs(std::uint32_t record) const
{
    bool all = is_told(record);
    for (const FaceState state : truth_.model.records[record].before)
    {
        all = all && (state.is_base() || is_told(state.record().value));
    }
    return all;
}

std::uint64_t SlotLedger::told(ChunkId chunk) const
{
    for (const Slot& slot : slots_)
    {
        if (slot.chunk == chunk)
        {
            return slot.told;
        }
    }
    return 0;
}

void SlotLedger::require(bool holds, const char* what, std::uint32_t number)
{
    if (!holds && failure_.empty())
    {
        failure_ = std::string(what) + " (" + std::to_string(number) + ")";
    }
}

} // namespace tactus::interleave
