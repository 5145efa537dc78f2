// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/fuzz/link_desk.hpp"

#include "host_tools/shapes/shapes.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "tests/fuzz/law.hpp"
#include "tests/fuzz/model_laws.hpp"
#include "tests/shared/test_model.hpp"
#include "transport/store/model_store.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace tactus::fuzz
{
namespace
{

CodedModel make_coded_model(Shape shape, const char* name)
{
    const auto mesh = make_shape(shape, 800);
    require(mesh.has_value(), "the generated shape exists");
    const auto store = ModelStore::open(test::test_model(name, mesh.value(), 60).path);
    require(store.has_value(), "the encoder's file opens");
    CodedModel model;
    const auto bytes = store.value().header_bytes();
    model.header_bytes.assign(bytes.begin(), bytes.end());
    model.header = ModelHeader::parse(model.header_bytes).value();
    require(store.value().read({ContentKind::base, 0}, model.base).has_value(), "it has a base");
    model.chunks.resize(model.header.counts().chunks());
    for (std::uint32_t chunk = 0; chunk < model.chunks.size(); ++chunk)
    {
        require(store.value().read({ContentKind::chunk, chunk}, model.chunks[chunk]).has_value(),
                "it has its chunks");
    }
    return model;
}

} // namespace

const CodedModel& coded_model(Lump lump)
{
    static const CodedModel closed = make_coded_model(Shape::bumpy_sphere, "closed");
    static const CodedModel open = make_coded_model(Shape::terrain, "open");
    return lump == Lump::closed ? closed : open;
}

namespace
{

/// Owner by the lowest bits of the edit's value: derived, base face or record.
CodedRecord::Owner owner_of(const Edit& edit, std::uint32_t number, const ModelCounts& counts)
{
    switch (edit.value % 4)
    {
    case 0:
        return {};
    case 1:
        return {number % counts.base_faces, CodedRecord::Owner::Kind::base, {}};
    default:
        return {number % counts.records, CodedRecord::Owner::Kind::record, {}};
    }
}

/// Error that can be coded beside the record's largest one.
ErrorCode error_beside(const CodedRecord& record, const Edit& edit)
{
    const ErrorCode largest = std::max(ErrorCode{1}, std::ranges::max(record.error));
    const std::uint32_t below = 2 * (edit.value / 8 % 16);
    return static_cast<ErrorCode>(below == 30 ? 0U : largest > below ? largest - below : 1U);
}

/// Clears the fields that a chunk does not store for a record with this fan and these sides.
void clear_the_rest(CodedRecord& record)
{
    const std::uint32_t fan = record.fan_size();
    std::fill(record.others.begin() + (fan - 1), record.others.end(), CodedRecord::Owner{});
    std::fill(record.error.begin() + (2 + fan), record.error.end(), ErrorCode{0});
    for (std::uint32_t side = 0; side < 2; ++side)
    {
        record.error[side] = record.has_face(side) ? record.error[side] : ErrorCode{0};
        record.bucket_step[side] = record.has_face(side) ? record.bucket_step[side] : 0;
    }
}

} // namespace

void edit_bytes(const Edit& edit, std::vector<std::byte>& bytes)
{
    const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(edit.place % bytes.size());
    switch (edit.kind)
    {
    case Edit::set_byte:
        *at = static_cast<std::byte>(edit.value);
        break;
    case Edit::flip_bit:
        *at ^= static_cast<std::byte>(1U << (edit.value % 8));
        break;
    case Edit::cut:
        bytes.erase(at + 1, bytes.end()); // One byte stays for the following edits.
        break;
    case Edit::insert_byte:
        bytes.insert(at, static_cast<std::byte>(edit.value));
        break;
    default:
        break;
    }
}

void edit_record(const Edit& edit, const ModelCounts& counts, CodedRecord& record)
{
    const std::uint32_t value = edit.value;
    const std::uint32_t number = edit.place / 64;
    const std::int32_t step = static_cast<std::int32_t>(number) - 512;
    switch (edit.kind)
    {
    case Edit::set_anchor:
        record.anchor = owner_of(edit, number, counts);
        record.place = value % 4 == 1 ? std::uint8_t{0} : record.place;
        break;
    case Edit::set_place:
        record.place = static_cast<std::uint8_t>(value % 8);
        record.corner = static_cast<std::uint8_t>(value / 8 % 3);
        break;
    case Edit::set_fan:
        record.left = static_cast<std::uint8_t>(value % 6);
        record.right = static_cast<std::uint8_t>(value / 6 % (6U - record.left));
        record.sides = static_cast<std::uint8_t>(value / 36 % 4);
        break;
    case Edit::set_other:
        record.others[value / 4 % 5] = owner_of(edit, number, counts);
        break;
    case Edit::set_residual:
        record.residual[value % 3] = step * (1 << (value / 3 % 19));
        break;
    case Edit::set_error:
        record.error[value % 8] = error_beside(record, edit);
        break;
    case Edit::set_bucket:
        record.bucket_step[value % 2] = step * (1 << (value / 2 % 22));
        break;
    default:
        return;
    }
    clear_the_rest(record);
}

namespace
{

constexpr std::uint32_t kAway = 0xFFFF'FFFFU;

/// True if the face is in the state of its owner; derived ones may be in any of a record.
bool is_of(FaceId face, FaceState state, const CodedRecord::Owner& owner)
{
    switch (owner.kind)
    {
    case CodedRecord::Owner::Kind::derived:
        return !state.is_base();
    case CodedRecord::Owner::Kind::record:
        return !state.is_base() && state.record().value == owner.value;
    case CodedRecord::Owner::Kind::base:
        return state.is_base() && face.value == owner.value;
    }
    return false;
}

/// True if a linked record has the fan, the sides and the errors of its chunk.
bool says(const VsplitRecord& record, const CodedRecord& coded)
{
    const std::uint32_t left = coded.left;
    const auto is_right_at = [&](std::uint32_t fan, const CodedRecord::Owner& owner)
    { return is_of(record.star[2 + fan], record.before[fan], owner); };
    bool all = record.fan_size == left + 1 + coded.right && record.error == coded.error &&
               record.has_face(0) == coded.has_face(0) && record.has_face(1) == coded.has_face(1) &&
               is_right_at(left, coded.anchor) &&
               (record.before[left].is_base() || record.before[left].place() == coded.place);
    for (std::uint32_t i = 0; all && i + 1 < record.fan_size; ++i)
    {
        const bool is_right = i < coded.right;
        const std::uint32_t fan = is_right ? left + 1 + i : left - 1 - (i - coded.right);
        all = is_right_at(fan, coded.others[i]);
    }
    return all;
}

} // namespace

LinkDesk::LinkDesk(const CodedModel& model)
    : model_(model)
    , counts_(model.header.counts())
    , slot_of_(counts_.chunks(), kAway)
    , chunk_in_(counts_.chunks())
    , told_(counts_.chunks())
    , parsed_(counts_.chunks())
    , became_(counts_.records)
    , is_stuck_(counts_.records)
{
    Arena measure = Arena::measuring();
    static_cast<void>(LinkPool(measure, counts_.chunks()));
    static_cast<void>(PageSlots::take(measure, counts_, counts_.chunks(), 1));
    memory_.resize(measure.used() / sizeof(Line));
    Arena arena(std::as_writable_bytes(std::span(memory_)));
    slots_ = PageSlots::take(arena, counts_, counts_.chunks(), 1);
    pool_.emplace(arena, counts_.chunks());
    linker_ = std::make_unique<Linker>(*pool_, 0, model.header, slots_);
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
    parsed_[slot] = page;
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
    for (std::uint32_t place = 0; place < records_in_chunk(counts_, chunk); ++place)
    {
        is_stuck_[chunk.value * 64 + place] = false;
    }
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

void LinkDesk::check_links()
{
    std::vector<Whole> whole(counts_.records, Whole::unknown);
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
            const VsplitRecord& parsed = parsed_[slot].records[place];
            if (is_linked(id))
            {
                check_linked(id, record, coded_form(parsed));
                continue;
            }
            require(std::memcmp(&record, &parsed, sizeof(record)) == 0,
                    "a record that isn't linked waits as it was parsed");
            check_unlinked(id, whole);
        }
    }
    require(found_refused_ <= linker_->records_refused(),
            "a record whose dependencies are all linked is linked or refused");
}

void LinkDesk::check_linked(RecordId id, const VsplitRecord& record, const CodedRecord& coded)
{
    require(is_lawful_linked(model_.header, id, record), "a linked record is in its ranges");
    require(says(record, coded), "a linked record is what its chunk says");
    VsplitRecord now = record;
    now.next = {};
    if (!became_[id.value])
    {
        became_[id.value] = now;
    }
    require(std::memcmp(&now, &*became_[id.value], sizeof(now)) == 0,
            "a record becomes the same whenever it is linked");
    require(!is_stuck_[id.value], "a refused record stays so while it is here");
    check_owners(id, record);
}

/// A linked record fits its resident owners and is one deeper than the deepest. Until a chunk was
/// removed, it alone splits its fan faces; afterwards a rival may have been first.
void LinkDesk::check_owners(RecordId id, const VsplitRecord& record) const
{
    const bool has_owners = owners_are_linked(record);
    require(has_owners || has_taken_away_, "owners are linked first");
    std::uint32_t depth = 1;
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
        if (has_owners)
        {
            const std::uint32_t next = next_of(record.star[2 + i], state);
            require(next == id.value || (has_taken_away_ && next < counts_.records),
                    "a linked record is what splits its fan next");
        }
    }
    require(record.depth == depth || (!has_owners && record.depth > depth),
            "a linked record's depth is one more than its deepest dependency's");
}

/// Besides its named owners a record depends only on their dependencies: the ones that created the
/// corners of their faces, and faces around these. If these are all linked there is nothing to wait
/// for.
void LinkDesk::check_unlinked(RecordId id, std::vector<Whole>& whole)
{
    const std::uint32_t slot = slot_of_[id.value / 64];
    const CodedRecord coded = coded_form(parsed_[slot].records[id.value % 64]);
    const auto is_there = [&](const CodedRecord::Owner& owner)
    { return owner.kind != CodedRecord::Owner::Kind::record || is_whole({owner.value}, whole); };
    if (!is_stuck_[id.value] && is_there(coded.anchor) &&
        std::ranges::all_of(coded.others, is_there))
    {
        is_stuck_[id.value] = true;
        ++found_refused_;
    }
}

/// Terminates: owners of a linked record are less deep.
bool LinkDesk::is_whole(RecordId id, std::vector<Whole>& whole) const
{
    if (whole[id.value] == Whole::unknown)
    {
        const VsplitRecord* record = find(id);
        const auto is_there = [&](FaceState state)
        { return state.is_base() || is_whole(state.record(), whole); };
        const bool is =
            record != nullptr &&
            std::ranges::all_of(std::span(record->before).first(record->fan_size), is_there);
        whole[id.value] = is ? Whole::yes : Whole::no;
    }
    return whole[id.value] == Whole::yes;
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
    return is_linked(id) ? &slots_.pages[slot_of_[id.value / 64]].records[id.value % 64] : nullptr;
}

std::uint32_t LinkDesk::next_of(FaceId face, FaceState state) const
{
    return state.is_base() ? slots_.base.next[face.value]
                           : find(state.record())->next[state.place()];
}

} // namespace tactus::fuzz
