// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/fuzz/link_desk.hpp"

#include "rt_core/spm/chunk_coding.hpp"
#include "tests/fuzz/law.hpp"
#include "tests/fuzz/model_laws.hpp"

#include <algorithm>
#include <bit>

namespace tactus::fuzz
{

namespace
{

constexpr std::uint32_t kAway = 0xFFFF'FFFFU;

} // namespace

LinkDesk::LinkDesk(const CodedModel& model)
    : model_(model)
    , counts_(model.header.counts())
    , slot_of_(counts_.chunks(), kAway)
    , chunk_in_(counts_.chunks())
    , told_(counts_.chunks())
{
    Arena measure = Arena::measuring();
    static_cast<void>(
        Linker(measure, counts_, PageSlots::take(measure, counts_, counts_.chunks(), 1)));
    memory_.resize(measure.used() / sizeof(Line));
    Arena arena(std::as_writable_bytes(std::span(memory_)));
    slots_ = PageSlots::take(arena, counts_, counts_.chunks(), 1);
    linker_ = std::make_unique<Linker>(arena, counts_, slots_);
    require(parse_base_mesh(model.base, model.header, slots_.base).has_value() &&
                is_lawful_base(model.header, slots_.base),
            "the model's own base mesh is accepted");
}

std::uint32_t LinkDesk::chunks() const noexcept
{
    return counts_.chunks();
}

void LinkDesk::bring(ChunkId chunk, const Page& page)
{
    if (slot_of_[chunk.value] != kAway)
    {
        return;
    }
    const auto slot =
        static_cast<std::uint32_t>(std::ranges::find(chunk_in_, ChunkId{}) - chunk_in_.begin());
    slot_of_[chunk.value] = slot;
    chunk_in_[slot] = chunk;
    slots_.pages[slot] = page;
    linker_->link_page(chunk, slot);
    told_[slot] = linker_->tell_linked(slot);
    require(linker_->is_resident(chunk), "a page that was linked is resident");
    check_links();
}

void LinkDesk::take_away(ChunkId chunk)
{
    const std::uint32_t slot = slot_of_[chunk.value];
    if (slot == kAway)
    {
        return;
    }
    linker_->release_page(slot);
    slot_of_[chunk.value] = kAway;
    chunk_in_[slot] = {};
    has_taken_away_ = true;
    require(!linker_->is_resident(chunk) && linker_->linked(slot) == 0,
            "of a page that was released nothing is linked");
    check_links();
}

void LinkDesk::take_updates(std::uint32_t limit)
{
    Linker::Update update;
    for (std::uint32_t i = 0; i < limit && linker_->try_take_update(update); ++i)
    {
        require(update.slot < chunk_in_.size() && chunk_in_[update.slot] == update.chunk,
                "an update names a resident chunk and its slot");
        const std::uint64_t before = told_[update.slot];
        require(update.linked == linker_->linked(update.slot) && update.linked != before &&
                    (update.linked & before) == before,
                "an update tells of more linked records, and of all");
        told_[update.slot] = update.linked;
    }
}

void LinkDesk::check_told() const
{
    for (std::uint32_t slot = 0; slot < chunk_in_.size(); ++slot)
    {
        require(chunk_in_[slot].is_none() || told_[slot] == linker_->linked(slot),
                "every linked record was told");
    }
}

std::uint64_t LinkDesk::records_linked_now() const
{
    std::uint64_t count = 0;
    for (std::uint32_t slot = 0; slot < chunk_in_.size(); ++slot)
    {
        count += static_cast<std::uint64_t>(std::popcount(linker_->linked(slot)));
    }
    return count;
}

void LinkDesk::check_links() const
{
    std::uint64_t stuck = 0;
    for (std::uint32_t slot = 0; slot < chunk_in_.size(); ++slot)
    {
        const std::uint32_t records =
            chunk_in_[slot].is_none() ? 0 : records_in_chunk(counts_, chunk_in_[slot]);
        require(records == 64 || linker_->linked(slot) >> records == 0,
                "only records that exist are linked");
        for (std::uint32_t place = 0; place < records; ++place)
        {
            const RecordId id{chunk_in_[slot].value * 64 + place};
            const VsplitRecord& record = slots_.pages[slot].records[place];
            check_next(record);
            if (is_linked(id))
            {
                check_linked(id, record);
            }
            else
            {
                stuck += owners_are_linked(record) ? 1U : 0U;
            }
        }
    }
    require(stuck <= linker_->records_refused(),
            "a record whose dependencies are all linked is linked or refused");
}

/// A linked record fits its resident owners and is one deeper than the deepest. Until something was
/// taken away, it alone splits its fan faces; afterwards a rival may have come first.
void LinkDesk::check_linked(RecordId id, const VsplitRecord& record) const
{
    const bool has_owners = owners_are_linked(record);
    require(has_owners || has_taken_away_, "owners are linked first");
    std::uint32_t depth = 1;
    bool sees_all = true;
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        const FaceState state = record.before[i];
        const VsplitRecord* owner = state.is_base() ? nullptr : find(state.record());
        if (owner != nullptr)
        {
            require(owner->star[state.place()] == record.star[2 + i] &&
                        owner->error[state.place()] != 0,
                    "a linked record's state is one that its owner gives the face");
            depth = std::max(depth, owner->depth + 1U);
        }
        sees_all = sees_all && (state.is_base() || owner != nullptr);
        if (has_owners)
        {
            const std::uint32_t next = next_of(record.star[2 + i], state);
            require(next == id.value || (has_taken_away_ && next < counts_.records),
                    "a linked record is what splits its fan next");
        }
    }
    require(record.depth == depth || (!sees_all && record.depth > depth),
            "a linked record's depth is one more than its deepest dependency's");
}

void LinkDesk::check_next(const VsplitRecord& record) const
{
    for (std::uint32_t place = 0; place < record.star_end(); ++place)
    {
        const std::uint32_t next = record.next[place];
        const bool is_exact = record.error[place] == 0;
        require(record.star[place].is_none() || is_exact == (next == kNextExact),
                "exact faces and only those have no next record");
        require(next == kNextExact || next == kNextPending || next < counts_.records,
                "next is exact, pending or a record");
    }
}

bool LinkDesk::owners_are_linked(const VsplitRecord& record) const
{
    const auto before = std::span(record.before).first(record.fan_size);
    return std::ranges::all_of(before, [this](FaceState state)
                               { return state.is_base() || is_linked(state.record()); });
}

bool LinkDesk::is_linked(RecordId id) const
{
    const std::uint32_t slot = slot_of_[id.value / 64];
    return slot != kAway && ((linker_->linked(slot) >> (id.value % 64)) & 1U) != 0;
}

const VsplitRecord* LinkDesk::find(RecordId id) const
{
    const std::uint32_t slot = slot_of_[id.value / 64];
    return slot == kAway ? nullptr : &slots_.pages[slot].records[id.value % 64];
}

std::uint32_t LinkDesk::next_of(FaceId face, FaceState state) const
{
    return state.is_base() ? slots_.base.next[face.value]
                           : find(state.record())->next[state.place()];
}

} // namespace tactus::fuzz
