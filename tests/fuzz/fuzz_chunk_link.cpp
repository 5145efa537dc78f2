// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// An input is a script: which model; edits of its chunks; then steps that bring and take away
/// chunks in any order. Bytes past the end are 0.
///
///     model     1 byte: its lowest bit chooses the Lump
///     edits     1 byte: how many, modulo 8
///     edit      chunk, kind, two bytes of a place, value; kinds 0 .. 3 change a byte of the
///               chunk, the others the parsed record place % 64, by the number place / 64
///     step      1 byte: kind modulo 4 (bring, bring, take away, take updates), chunk or count
///
/// Edited bytes get a new checksum, or they would not be parsed at all.
#include "rt_core/spm/chunk_coding.hpp"
#include "tests/fuzz/coded_model.hpp"
#include "tests/fuzz/law.hpp"
#include "tests/fuzz/link_desk.hpp"
#include "tests/fuzz/model_laws.hpp"
#include "tests/fuzz/seal_model.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <vector>

namespace tactus::fuzz
{

namespace
{

constexpr std::uint32_t kUpdatesInAll = 0xFFFF'FFFFU;

class Script
{
public:
    explicit Script(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }
    std::uint32_t byte() { return at_end() ? 0 : bytes_[at_++]; }
    std::uint32_t two_bytes()
    {
        const std::uint32_t low = byte();
        return low + 256 * byte();
    }

private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_{0};
};

struct Edit
{
    enum Kind : std::uint32_t
    {
        set_byte,
        flip_bit,
        cut,
        insert_byte,
        set_anchor,
        set_place,
        set_fan,
        set_other,
        set_residual,
        set_error,
        set_bucket,
        kinds
    };

    std::uint32_t chunk{0};
    Kind kind{set_byte};
    std::uint32_t place{0};
    std::uint32_t value{0};
};

Edit read_edit(Script& script, std::uint32_t chunks)
{
    Edit edit;
    edit.chunk = script.byte() % chunks;
    edit.kind = static_cast<Edit::Kind>(script.byte() % Edit::kinds);
    edit.place = script.two_bytes();
    edit.value = script.byte();
    return edit;
}

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
        bytes.erase(at + 1, bytes.end()); // One byte stays, for the edits that follow.
        break;
    case Edit::insert_byte:
        bytes.insert(at, static_cast<std::byte>(edit.value));
        break;
    default:
        break;
    }
}

/// A derived owner, a base face or a record, by the lowest bits of the edit's value.
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

/// One of the errors that can be told beside the record's largest one.
ErrorCode error_beside(const CodedRecord& record, const Edit& edit)
{
    const ErrorCode largest = std::max(ErrorCode{1}, std::ranges::max(record.error));
    const std::uint32_t below = 2 * (edit.value / 8 % 16);
    return static_cast<ErrorCode>(below == 30 ? 0U : largest > below ? largest - below : 1U);
}

/// Clears what a chunk doesn't tell of a record with this fan and these sides.
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

/// Changes one record of a parsed page, as another chunk could say it: that reaches records which
/// random bytes of a chunk hardly ever spell. `number` is below 1024.
void edit_record(const Edit& edit, std::uint32_t number, const ModelCounts& counts,
                 CodedRecord& record)
{
    const std::uint32_t value = edit.value;
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
        record.sides = static_cast<std::uint8_t>(1 + value / 36 % 3);
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
        break;
    }
    clear_the_rest(record);
}

/// The chunks that this input serves; each is the same whenever it is asked for.
class ServedChunks
{
public:
    ServedChunks(const CodedModel& model, std::vector<Edit> edits)
        : model_(model), edits_(std::move(edits))
    {
    }

    /// Null for a chunk that is refused.
    const Page* page(ChunkId chunk)
    {
        const auto [at, is_new] = pages_.try_emplace(chunk.value);
        if (is_new)
        {
            at->second = parse(chunk);
        }
        return at->second ? &*at->second : nullptr;
    }
    [[nodiscard]] bool are_sound() const { return edits_.empty(); }

private:
    std::optional<Page> parse(ChunkId chunk) const
    {
        std::vector<std::byte> bytes = model_.chunks[chunk.value];
        for (const Edit& edit : edits_)
        {
            if (edit.chunk == chunk.value)
            {
                edit_bytes(edit, bytes);
            }
        }
        bytes.shrink_to_fit(); // So that a read beyond the end is seen.
        seal_chunk(bytes, chunk);
        std::optional<Page> page(std::in_place);
        Page other;
        std::memset(static_cast<void*>(&other), 0xA5, sizeof(other));
        const auto parsed = parse_chunk(bytes, model_.header, chunk, *page);
        require(parse_chunk(bytes, model_.header, chunk, other).has_value() == parsed.has_value(),
                "a chunk is accepted or refused whatever the page held before");
        require(parsed || !are_sound(), "the model's own chunks are accepted");
        if (!parsed)
        {
            return std::nullopt;
        }
        require(std::memcmp(&other, &*page, sizeof(other)) == 0,
                "a parsed page holds nothing of what was there before");
        require(is_lawful_parsed_page(model_.header, chunk, *page),
                "an accepted chunk is in its ranges");
        edit_records(chunk, *page);
        return page;
    }

    void edit_records(ChunkId chunk, Page& page) const
    {
        const std::uint32_t records = records_in_chunk(model_.header.counts(), chunk);
        for (const Edit& edit : edits_)
        {
            if (edit.chunk != chunk.value)
            {
                continue;
            }
            VsplitRecord& record = page.records[edit.place % 64 % records];
            const VsplitRecord before = record;
            CodedRecord coded = coded_form(record);
            edit_record(edit, edit.place / 64, model_.header.counts(), coded);
            record = waiting_form(coded);
            if (!is_lawful_parsed_page(model_.header, chunk, page))
            {
                record = before; // No parser gives that to the linker.
            }
        }
    }

    const CodedModel& model_;
    std::vector<Edit> edits_;
    std::map<std::uint32_t, std::optional<Page>> pages_;
};

void bring(LinkDesk& desk, ServedChunks& served, ChunkId chunk)
{
    if (const Page* page = served.page(chunk))
    {
        desk.bring(chunk, *page);
    }
}

void take_step(std::uint32_t step, LinkDesk& desk, ServedChunks& served)
{
    const std::uint32_t operand = step / 4;
    const ChunkId chunk{operand % desk.chunks()};
    switch (step % 4)
    {
    case 2:
        desk.take_away(chunk);
        break;
    case 3:
        desk.take_updates(1 + operand);
        break;
    default:
        bring(desk, served, chunk);
        break;
    }
}

void run(Script script)
{
    const CodedModel& model = coded_model(static_cast<Lump>(script.byte() % 2));
    LinkDesk desk(model);
    std::vector<Edit> edits(script.byte() % 8);
    for (Edit& edit : edits)
    {
        edit = read_edit(script, desk.chunks());
    }
    ServedChunks served(model, std::move(edits));
    while (!script.at_end())
    {
        take_step(script.byte(), desk, served);
    }
    for (ChunkId chunk{0}; chunk.value < desk.chunks(); ++chunk.value)
    {
        bring(desk, served, chunk);
    }
    desk.take_updates(kUpdatesInAll);
    desk.check_told();
    ++accepted_inputs;
    if (served.are_sound())
    {
        require(desk.records_linked_now() == model.header.counts().records &&
                    desk.records_refused() == 0,
                "a sound model is linked whole, whatever the order of its chunks");
    }
}

} // namespace

} // namespace tactus::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    constexpr std::size_t longest = 96; // Steps repeat; a longer script tells nothing new.
    tactus::fuzz::run(tactus::fuzz::Script({data, std::min(size, longest)}));
    return 0;
}
