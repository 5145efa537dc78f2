// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// The input is a model's file. It is read twice: unchanged, and with corrected hashes
/// (seal_model.hpp), so that faults reach every later check.
#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/encode/replay.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "tests/fuzz/law.hpp"
#include "tests/fuzz/model_laws.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/seal_model.hpp"
#include "transport/store/model_store.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

namespace tactus::fuzz
{

namespace
{

using Bytes = std::vector<std::byte>;

/// Separate memory, so that a read beyond the part is detected; shorter if the file ends.
Bytes copy_part(std::span<const std::byte> file, std::uint64_t offset, std::uint64_t bytes)
{
    const std::uint64_t start = std::min<std::uint64_t>(offset, file.size());
    const auto part = file.subspan(start, std::min<std::uint64_t>(bytes, file.size() - start));
    return {part.begin(), part.end()};
}

void parse_base(std::span<const std::byte> file, const ModelHeader& header)
{
    const HeaderFields& fields = header.fields();
    std::vector<Vec3f> positions_m(fields.base_vertices);
    std::vector<BaseFace> faces(fields.base_faces);
    std::vector<std::uint32_t> next(fields.base_faces);
    const BaseMesh mesh{positions_m, faces, next};
    if (parse_base_mesh(copy_part(file, fields.base_offset, fields.base_bytes), header, mesh))
    {
        require(is_lawful_base(header, mesh), "an accepted base mesh is in its ranges");
    }
}

/// Parsing stops at the first page outside of the file.
void parse_index(std::span<const std::byte> file, const ModelHeader& header)
{
    const ModelCounts counts = header.counts();
    for (IndexPageId id{0}; id.value < counts.index_pages(); ++id.value)
    {
        const std::size_t bytes = coded_index_page_bytes(chunks_in_index_page(counts, id));
        IndexPage page;
        std::vector<ChunkEntry> entries(kChunksPerIndexPage);
        const std::uint64_t offset = header.fields().index_offset + std::uint64_t{id.value} * 1'928;
        if (!parse_index_page(copy_part(file, offset, bytes), counts, id, page, entries))
        {
            return;
        }
        require(is_lawful_index_page(counts, id, page, entries),
                "an accepted index page is in its ranges");
        const QuantumBox box = header.index_entry(id).box;
        for (std::uint32_t i = 0; i < page.chunks; ++i)
        {
            const QuantumBox of_chunk = box_of(page, box, i);
            require(meets({{0.0, 0.0, 0.0}, 1e300}, of_chunk), "a sphere of all meets every box");
        }
    }
}

void parse_parts(std::span<const std::byte> file)
{
    HeaderFields fields;
    if (file.size() >= sizeof(fields))
    {
        std::memcpy(&fields, file.data(), sizeof(fields));
    }
    const Bytes bytes = copy_part(file, 0, fields.header_bytes);
    const auto header = ModelHeader::parse(bytes);
    if (!header)
    {
        return;
    }
    require(is_lawful_header(header.value(), bytes), "an accepted header is in its ranges");
    for (const double place : {-1e300, 0.0, 1e-9, 1e300})
    {
        const RegionId region = header.value().region_at({place, -place, 0.5 * place});
        require(region.value < header.value().region_count(), "a point's region exists");
    }
    parse_base(file, header.value());
    parse_index(file, header.value());
}

void parse_chunks(const ModelStore& store)
{
    Bytes coded;
    Page page;
    for (ChunkId id{0}; id.value < store.header().counts().chunks(); ++id.value)
    {
        if (store.read({ContentKind::chunk, id.value}, coded) &&
            parse_chunk(coded, store.header(), id, page))
        {
            require(is_lawful_parsed_page(store.header(), id, page),
                    "an accepted chunk is in its ranges");
        }
    }
}

/// Splits the linked records; refusals are as good as splits.
void play(const DecodedModel& model)
{
    for (RecordId id{0}; id.value < model.header().counts().records; ++id.value)
    {
        require(is_lawful_linked(model.header(), id, model.record(id)),
                "a linked record is in its ranges");
    }
    Replay replay(model);
    for (const RecordId record : in_dependency_order(model))
    {
        const std::uint32_t faces = replay.face_count();
        const auto refusal = replay.split(record);
        require(refusal.has_value() == (faces == replay.face_count()),
                "a split adds faces and a refused one changes nothing");
    }
    require(replay.mesh().faces.size() == replay.face_count(), "the replayed mesh has its faces");
}

void require_message(const std::string& text, const std::filesystem::path& path)
{
    require(is_clear_refusal(text, path.string()),
            "a refusal is one clear line that begins with the file's name");
}

void open_file(std::span<const std::byte> file)
{
    static ScratchFile scratch("model.spm");
    scratch.replace(file);
    const auto store = ModelStore::open(scratch.path());
    if (!store)
    {
        require_message(store.error().text, scratch.path());
        return;
    }
    require(is_lawful_header(store.value().header(), store.value().header_bytes()),
            "an opened model's header is in its ranges");
    parse_chunks(store.value());
    std::vector<std::string> damage;
    const DecodedModel model = DecodedModel::decode(store.value(), damage);
    for (const std::string& line : damage)
    {
        require_message(line, scratch.path());
        require(line.find("the file was cut short") == std::string::npos,
                "an opened file holds all its pieces");
    }
    if (damage.empty())
    {
        ++accepted_inputs;
        play(model);
    }
}

void read_whole(std::span<const std::byte> file)
{
    parse_parts(file);
    open_file(file);
}

} // namespace

} // namespace tactus::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const auto input = std::as_bytes(std::span(data, size));
    std::vector<std::byte> file(input.begin(), input.end());
    tactus::fuzz::read_whole(file);
    tactus::fuzz::seal_model(file);
    tactus::fuzz::read_whole(file);
    return 0;
}
