// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/decoded_model.hpp"

#include "rt_core/base/arena.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "rt_core/spm/linker.hpp"

#include <fmt/format.h>

#include <bit>

namespace tactus
{

DecodedModel::DecodedModel(const ModelHeader& header, std::span<const RefinementStatePage> pages)
    : header_(header)
    , pages_(pages.size())
    , linked_(pages.size())
    , slots_(header.counts().chunks())
    , base_positions_m_(header.counts().base_vertices)
    , base_faces_(header.counts().base_faces)
    , base_next_(header.counts().base_faces)
{
    for (std::uint32_t slot = 0; slot < pages.size(); ++slot)
    {
        TACTUS_ASSERT(pages[slot].chunk.value < slots_.size());
        slots_[pages[slot].chunk.value] = slot;
    }
}

DecodedModel DecodedModel::decode(const ModelStore& store, std::vector<std::string>& damage)
{
    const ModelCounts counts = store.header().counts();
    std::vector<RefinementStatePage> pages;
    for (std::uint32_t chunk = 0; chunk < counts.chunks(); ++chunk)
    {
        const std::uint32_t records = records_in_chunk(counts, {chunk});
        pages.push_back({{chunk}, ~std::uint64_t{0} >> (kRecordsPerChunk - records)});
    }
    return decode_pages(
        store.header(), pages,
        [&](ContentKey key, std::vector<std::byte>& coded) { return store.read(key, coded); },
        store.path().string(), damage);
}

DecodedModel DecodedModel::decode_pages(const ModelHeader& header,
                                        std::span<const RefinementStatePage> pages,
                                        const ReadPiece& read, const std::string& name,
                                        std::vector<std::string>& damage)
{
    DecodedModel model(header, pages);
    model.parse_pieces(pages, read, name, damage);
    if (damage.empty() && !pages.empty())
    {
        model.link_all(pages, name, damage);
    }
    return model;
}

void DecodedModel::parse_pieces(std::span<const RefinementStatePage> pages, const ReadPiece& read,
                                const std::string& name, std::vector<std::string>& damage)
{
    std::vector<std::byte> coded;
    const auto take = [&](ContentKey key, const std::string& piece, auto&& parse)
    {
        if (const auto done = read(key, coded); !done)
        {
            damage.push_back(done.error().text);
        }
        else if (const Result<Done, SpmRefusal> parsed = parse(); !parsed)
        {
            damage.push_back(fmt::format("{}: {} {}", name, piece, refusal_text(parsed.error())));
        }
    };
    take({ContentKind::base, 0}, "the base mesh",
         [&] {
             return parse_base_mesh(coded, header_, {base_positions_m_, base_faces_, base_next_});
         });
    for (std::uint32_t slot = 0; slot < pages.size(); ++slot)
    {
        const ChunkId chunk = pages[slot].chunk;
        take({ContentKind::chunk, chunk.value}, fmt::format("chunk {}", chunk.value),
             [&] { return parse_chunk(coded, header_, chunk, pages_[slot]); });
        chunk_bytes_ += coded.size();
    }
}

/// Links all pages and reports the records that should be linked and cannot be. There is memory for
/// all pages, so no record waits for others.
void DecodedModel::link_all(std::span<const RefinementStatePage> pages, const std::string& name,
                            std::vector<std::string>& damage)
{
    struct alignas(Arena::kAlignment) Line
    {
        std::array<std::byte, Arena::kAlignment> bytes;
    };
    const PageSlots slots{pages_, {}, {base_positions_m_, base_faces_, base_next_}};
    Arena measure = Arena::measuring();
    static_cast<void>(LinkPool(measure, pages_.size()));
    std::vector<Line> memory(measure.used() / sizeof(Line));
    Arena arena(std::as_writable_bytes(std::span(memory)));
    LinkPool pool(arena, pages_.size());
    Linker linker(pool, 0, header_, slots);
    for (std::uint32_t slot = 0; slot < pages.size(); ++slot)
    {
        linker.link_page(pages[slot].chunk, slot);
    }
    for (std::uint32_t slot = 0; slot < pages.size(); ++slot)
    {
        linked_[slot] = linker.linked(slot);
        const std::uint64_t lacking = pages[slot].refined & ~linked_[slot];
        if (lacking != 0)
        {
            damage.push_back(fmt::format(
                "{}: chunk {}: {} of its records don't match the records that they depend on", name,
                pages[slot].chunk.value, std::popcount(lacking)));
        }
    }
}

} // namespace tactus
