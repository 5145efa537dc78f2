// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/decoded_model.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "tests/codec/decoders.hpp"
#include "tests/fuzz/law.hpp"
#include "tests/fuzz/model_laws.hpp"
#include "tests/fuzz/record_laws.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/seal_model.hpp"
#include "tests/unit/transport/tiny_model.hpp"

namespace tactus::codec
{

namespace
{

/// Two chunks, the second one with 36 records.
const test::TinyModel& sample_model()
{
    static const test::TinyModel made = test::make_tiny_model({.records = 100});
    return made;
}

const ModelHeader& sample_model_header()
{
    static const ModelHeader header = ModelHeader::parse(sample_model().header).value();
    return header;
}

Reading refused(SpmRefusal refusal)
{
    return {refusal_text(refusal)};
}

Reading read_header(std::span<const std::byte> bytes)
{
    const auto header = ModelHeader::parse(bytes);
    return header ? Reading{"", fuzz::is_lawful_header(header.value(), bytes)}
                  : refused(header.error());
}

Reading read_base(std::span<const std::byte> bytes)
{
    const ModelCounts counts = sample_model_header().counts();
    std::vector<Vec3f> positions_m(counts.base_vertices);
    std::vector<BaseFace> faces(counts.base_faces);
    std::vector<std::uint32_t> next(counts.base_faces);
    const BaseMesh mesh{positions_m, faces, next};
    const auto done = parse_base_mesh(bytes, sample_model_header(), mesh);
    return done ? Reading{"", fuzz::is_lawful_base(sample_model_header(), mesh)}
                : refused(done.error());
}

Reading read_index_page(std::span<const std::byte> bytes)
{
    const ModelCounts counts = sample_model_header().counts();
    IndexPage page;
    std::vector<ChunkEntry> entries(kChunksPerIndexPage);
    const auto done = parse_index_page(bytes, counts, {0}, page, entries);
    return done ? Reading{"", fuzz::is_lawful_index_page(counts, {0}, page, entries)}
                : refused(done.error());
}

Reading read_chunk(std::span<const std::byte> bytes)
{
    Page page;
    const auto done = parse_chunk(bytes, sample_model_header(), {1}, page);
    return done ? Reading{"", fuzz::is_lawful_parsed_page(sample_model_header(), {1}, page)}
                : refused(done.error());
}

/// One clear line about the file as a whole, or about the one chunk that is damaged.
Reading read_model_file(std::span<const std::byte> bytes)
{
    static fuzz::ScratchFile file("model.spm");
    file.replace(bytes);
    const auto store = ModelStore::open(file.path());
    if (!store)
    {
        const std::string& text = store.error().text;
        return {text, fuzz::is_clear_refusal(text, file.path().string() + ": ")};
    }
    std::vector<std::string> damage;
    static_cast<void>(DecodedModel::decode(store.value(), damage));
    if (damage.empty())
    {
        return {};
    }
    const bool is_clear = fuzz::is_clear_refusal(damage[0], file.path().string() + ": chunk ");
    return {damage[0],
            is_clear && damage.size() == 1 && damage[0].find(" at offset ") != std::string::npos};
}

} // namespace

std::vector<Decoder> model_decoders()
{
    const std::string too_short = refusal_text(SpmRefusal::too_short);
    const std::string trailing = refusal_text(SpmRefusal::trailing_bytes);
    return {{.name = "model_header",
             .samples = [] { return std::vector<Bytes>{sample_model().header}; },
             .read = read_header,
             .cut = too_short,
             .followed = trailing,
             .seal = fuzz::seal_piece,
             .version_at = {8, 9, 10, 11},
             .unknown_version = refusal_text(SpmRefusal::unknown_version)},
            {.name = "base_mesh",
             .samples = [] { return std::vector<Bytes>{sample_model().base}; },
             .read = read_base,
             .cut = too_short,
             .followed = trailing,
             .seal = fuzz::seal_piece},
            {.name = "index_page",
             .samples = [] { return sample_model().index_pages; },
             .read = read_index_page,
             .cut = too_short,
             .followed = trailing,
             .seal = fuzz::seal_piece},
            {.name = "chunk",
             .samples = [] { return std::vector<Bytes>{sample_model().chunks[1]}; },
             .read = read_chunk,
             .cut = "",
             .followed = trailing,
             .seal = [](std::span<std::byte> bytes) { fuzz::seal_chunk(bytes, {1}); },
             .tells_its_size = false},
            {.name = "model_file",
             .samples = [] { return std::vector<Bytes>{sample_model().file}; },
             .read = read_model_file,
             .cut = "",
             .followed = "followed by other bytes",
             .version_at = {8, 9, 10, 11},
             .unknown_version = "has format version"}};
}

} // namespace tactus::codec
