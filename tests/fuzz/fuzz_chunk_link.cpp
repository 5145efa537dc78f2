// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// The input is a script: a model; edits of its chunks; then steps that add and remove chunks in
/// any order. Bytes past the end are 0.
///
///     model     1 byte: its lowest bit chooses the Lump
///     edits     1 byte: their number, modulo 8
///     edit      chunk, kind, two bytes of a place, value; kinds 0 .. 3 change a byte of the
///               chunk, the others the parsed record place % 64, by the number place / 64
///     step      1 byte: kind modulo 4 (add, add, remove, take updates), chunk or count
///
/// Edited bytes get a new checksum, or they would not be parsed.
#include "rt_core/spm/chunk_coding.hpp"
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

Edit read_edit(Script& script, std::uint32_t chunks)
{
    Edit edit;
    edit.chunk = script.byte() % chunks;
    edit.kind = static_cast<Edit::Kind>(script.byte() % Edit::kinds);
    edit.place = script.two_bytes();
    edit.value = script.byte();
    return edit;
}

/// Chunks that this input serves; each is the same at every request.
class ServedChunks
{
public:
    ServedChunks(const CodedModel& model, std::vector<Edit> edits)
        : model_(model), edits_(std::move(edits))
    {
    }

    /// Page of a chunk; null if it is refused.
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
        bytes.shrink_to_fit(); // Reads beyond the end are detected.
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
            edit_record(edit, model_.header.counts(), coded);
            record = waiting_form(coded);
            if (!is_lawful_parsed_page(model_.header, chunk, page))
            {
                record = before; // No parser passes that to the linker.
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
    constexpr std::size_t longest = 96; // Steps repeat, so a longer script finds nothing new.
    tactus::fuzz::run(tactus::fuzz::Script({data, std::min(size, longest)}));
    return 0;
}
