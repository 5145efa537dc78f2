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

DecodedModel::DecodedModel(const ModelHeader& header)
    : header_(header)
    , pages_(header.counts().chunks())
    , base_positions_m_(header.counts().base_vertices)
    , base_faces_(header.counts().base_faces)
    , base_next_(header.counts().base_faces)
{
}

DecodedModel DecodedModel::decode(const ModelStore& store, std::vector<std::string>& damage)
{
    DecodedModel model(store.header());
    model.parse_pieces(store, damage);
    if (damage.empty() && model.header_.counts().records > 0)
    {
        model.link_all(store, damage);
    }
    return model;
}

void DecodedModel::parse_pieces(const ModelStore& store, std::vector<std::string>& damage)
{
    std::vector<std::byte> coded;
    const auto take = [&](ContentKey key, const std::string& name, auto&& parse)
    {
        if (const auto read = store.read(key, coded); !read)
        {
            damage.push_back(read.error().text);
        }
        else if (const Result<Done, SpmRefusal> parsed = parse(); !parsed)
        {
            damage.push_back(fmt::format("{}: {} {}", store.path().string(), name,
                                         refusal_text(parsed.error())));
        }
    };
    take({ContentKind::base, 0}, "the base mesh",
         [&] {
             return parse_base_mesh(coded, header_, {base_positions_m_, base_faces_, base_next_});
         });
    for (std::uint32_t chunk = 0; chunk < pages_.size(); ++chunk)
    {
        take({ContentKind::chunk, chunk}, fmt::format("chunk {}", chunk),
             [&] { return parse_chunk(coded, header_, {chunk}, pages_[chunk]); });
        chunk_bytes_ += coded.size();
    }
}

/// With memory for all pages nothing waits for long: a record is linked, or it can't be.
void DecodedModel::link_all(const ModelStore& store, std::vector<std::string>& damage)
{
    const ModelCounts counts = header_.counts();
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
    for (std::uint32_t chunk = 0; chunk < pages_.size(); ++chunk)
    {
        linker.link_page({chunk}, chunk);
    }
    for (std::uint32_t chunk = 0; chunk < pages_.size(); ++chunk)
    {
        const auto linked = static_cast<std::uint32_t>(std::popcount(linker.linked(chunk)));
        if (linked < records_in_chunk(counts, {chunk}))
        {
            damage.push_back(fmt::format("{}: chunk {}: {} of its records don't fit those that "
                                         "they depend on",
                                         store.path().string(), chunk,
                                         records_in_chunk(counts, {chunk}) - linked));
        }
    }
}

} // namespace tactus
