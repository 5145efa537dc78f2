// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/write_spm.hpp"

#include "host_tools/encode/model_pieces.hpp"
#include "host_tools/encode/piece_coding.hpp"
#include "host_tools/encode/region_grid.hpp"
#include "host_tools/simplify/parallel_blocks.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/spm/index_page.hpp"
#include "transport/base/atomic_file.hpp"
#include "transport/content_hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus
{

namespace
{

std::array<std::uint32_t, 3> extent_of(const QuantisedMesh& mesh)
{
    std::array<std::uint32_t, 3> extent{};
    for (const auto& position : mesh.positions)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            TACTUS_ASSERT(position[axis] >= 0);
            extent[axis] = std::max(extent[axis], static_cast<std::uint32_t>(position[axis]));
        }
    }
    return extent;
}

std::optional<std::string> check_base(const Simplification& simplification,
                                      std::size_t base_vertices, std::uint32_t allowed_faces)
{
    const std::size_t faces = simplification.base_faces.size();
    const std::size_t vertices_needed = (base_vertices + 2) / 3;
    if (std::max(faces, vertices_needed) > kMaxBaseFaces)
    {
        return fmt::format(
            "the mesh can't be simplified below {} faces with {} vertices (too many pieces that "
            "can't be removed); a base mesh has at most {} faces with {}",
            faces, base_vertices, kMaxBaseFaces, kMaxBaseVertices);
    }
    if (faces > std::max(kGrownBaseFaces, allowed_faces))
    {
        return fmt::format("the mesh can't be simplified below {0} faces (pieces or borders that "
                           "can't be removed); allow that number with --base-faces {0}",
                           faces);
    }
    return std::nullopt;
}

std::optional<std::string> check_pieces(const ModelPieces& pieces)
{
    if (pieces.max_depth() > kMaxDepth)
    {
        return fmt::format("a record depends on a chain of {} others; at most {} are supported",
                           pieces.max_depth() - 1, kMaxDepth - 1);
    }
    return std::nullopt;
}

/// Edge of a region in quanta: the largest power of two that is not above the user's size.
std::uint32_t cell_of(double region_size_m, double quantum_m)
{
    const double quanta = std::clamp(region_size_m / quantum_m, 1.0, 0x1p30);
    return std::bit_floor(static_cast<std::uint32_t>(quanta));
}

std::optional<std::string> check_regions(const RegionGrid& grid, double quantum_m)
{
    if (grid.count() > kMaxRegions)
    {
        return fmt::format("regions of {} m would number {}; at most {} are supported: set "
                           "--region-size to a larger value",
                           grid.cell_quanta * quantum_m, grid.count(), kMaxRegions);
    }
    return std::nullopt;
}

HeaderFields describe(const PreparedMesh& prepared, const Simplification& simplification,
                      const ModelPieces& pieces, const RegionGrid& grid,
                      std::uint32_t position_bits)
{
    const ModelCounts& counts = pieces.counts();
    HeaderFields fields;
    fields.base_vertices = counts.base_vertices;
    fields.base_faces = counts.base_faces;
    fields.records = counts.records;
    fields.quantum_log2 = std::ilogb(prepared.quantum_m);
    TACTUS_ASSERT(std::ldexp(1.0, fields.quantum_log2) == prepared.quantum_m);
    fields.position_bits = static_cast<std::uint16_t>(position_bits);
    fields.topology = simplification.is_closed ? kClosedTopology : kOpenTopology;
    fields.extent_quanta = extent_of(prepared.mesh);
    fields.max_depth = pieces.max_depth();
    fields.origin_m = prepared.origin_m;
    fields.quantisation_m = prepared.quantisation_m;
    fields.source_vertices = static_cast<std::uint32_t>(prepared.mesh.positions.size());
    fields.source_faces = static_cast<std::uint32_t>(prepared.mesh.faces.size());
    fields.rounds = simplification.rounds;
    fields.max_error_quanta = static_cast<std::uint32_t>(
        std::min(std::ceil(static_cast<double>(error_in_quanta(pieces.max_error()))), 0x1p31));
    fields.region_cell_quanta = grid.cell_quanta;
    fields.region_grid = grid.cells;
    fields.occupied_regions = grid.occupied_count;
    return fields;
}

/// Sets the offsets and sizes in `fields` that depend only on counts.
void place_parts(HeaderFields& fields, const ModelCounts& counts, std::uint64_t regions)
{
    const std::uint64_t header = header_bytes(counts.index_pages(), regions);
    fields.header_bytes = static_cast<std::uint32_t>(header);
    fields.base_offset = header;
    fields.base_bytes = static_cast<std::uint32_t>(coded_base_bytes(fields));
    fields.index_offset = fields.base_offset + fields.base_bytes;
}

std::uint64_t first_chunk_offset(const HeaderFields& fields, const ModelCounts& counts)
{
    std::uint64_t offset = fields.index_offset;
    for (std::uint32_t page = 0; page < counts.index_pages(); ++page)
    {
        offset += coded_index_page_bytes(chunks_in_index_page(counts, {page}));
    }
    return offset;
}

/// Codes one index page; advances `chunks_offset` to the next page's chunks.
std::vector<std::byte> code_index_page(IndexPageId id, const ModelPieces& pieces,
                                       std::span<const ChunkEntry> all_entries,
                                       std::uint64_t& chunks_offset, IndexPageEntry& page)
{
    const std::size_t first = std::size_t{id.value} << kChunksPerIndexPageLog2;
    const std::uint32_t chunks = chunks_in_index_page(pieces.counts(), id);
    const auto entries = all_entries.subspan(first, chunks);
    const auto boxes = pieces.influence_boxes().subspan(first, chunks);
    page.box = union_of(boxes);
    page.chunks_offset = chunks_offset;
    std::vector<InfluenceBox> relative;
    for (const QuantumBox& box : boxes)
    {
        relative.push_back(relative_to(page.box, box));
    }
    for (const ChunkEntry& entry : entries)
    {
        chunks_offset += entry.coded_bytes;
    }
    std::vector<std::byte> coded = encode_index_page(id, relative, entries);
    page.hash = content_hash(coded);
    return coded;
}

/// Codes header, base mesh and index pages: all parts before the chunks, which depend on them.
std::vector<std::byte> code_front(HeaderFields& fields, const ModelPieces& pieces,
                                  std::span<const ChunkEntry> entries, const RegionGrid& grid)
{
    const std::vector<std::byte> base = pieces.coded_base(BaseLayout(fields));
    fields.base_hash = content_hash(base);
    std::uint64_t offset = first_chunk_offset(fields, pieces.counts());
    std::vector<IndexPageEntry> pages(pieces.counts().index_pages());
    ByteWriter index;
    for (std::uint32_t page = 0; page < pages.size(); ++page)
    {
        index.write_bytes(code_index_page({page}, pieces, entries, offset, pages[page]));
    }
    fields.file_bytes = offset;
    ByteWriter front;
    front.write_bytes(encode_header(fields, pages, grid.occupied));
    front.write_bytes(base);
    front.write_bytes(index.bytes());
    return front.take();
}

/// Codes the chunks of `batch`, from `first` on, and their index entries.
void code_chunks(const ModelPieces& pieces, std::uint32_t first,
                 std::span<std::vector<std::byte>> batch, std::span<ChunkEntry> entries,
                 unsigned threads)
{
    parallel_blocks(
        threads, batch.size(), 1,
        [&](unsigned, std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; ++i)
            {
                const ChunkId id{first + static_cast<std::uint32_t>(i)};
                batch[i] = pieces.coded_chunk(id);
                entries[i] = {static_cast<std::uint16_t>(batch[i].size()), content_hash(batch[i])};
            }
        });
}

/// Writes a gap for header, base mesh and index pages, then the chunks; fills the gap last.
Result<Done, Refusal> write_pieces(AtomicFile& file, HeaderFields& fields,
                                   const ModelPieces& pieces, const RegionGrid& grid,
                                   const EncodeOptions& options)
{
    constexpr std::uint32_t kBatch = 256;
    const ModelCounts& counts = pieces.counts();
    const std::vector<std::byte> gap(first_chunk_offset(fields, counts));
    auto written = file.write(gap);
    std::vector<ChunkEntry> entries(counts.chunks());
    for (std::uint32_t first = 0; written && first < counts.chunks(); first += kBatch)
    {
        std::vector<std::vector<std::byte>> batch(std::min(kBatch, counts.chunks() - first));
        code_chunks(pieces, first, batch, std::span{entries}.subspan(first), options.threads);
        for (std::size_t i = 0; written && i < batch.size(); ++i)
        {
            written = file.write(batch[i]);
        }
        if (options.progress)
        {
            options.progress(first + batch.size(), counts.chunks());
        }
    }
    if (!written)
    {
        return written;
    }
    const std::vector<std::byte> front = code_front(fields, pieces, entries, grid);
    TACTUS_ASSERT(front.size() == gap.size());
    written = file.write_at(0, front);
    return written ? file.commit() : written;
}

} // namespace

Result<HeaderFields, Refusal> write_spm(const std::filesystem::path& path,
                                        const PreparedMesh& prepared,
                                        const Simplification& simplification,
                                        const EncodeOptions& options)
{
    const QuantisedMesh& mesh = prepared.mesh;
    const auto refuse = [&](const std::string& what)
    { return Refusal{fmt::format("{}: not written: {}", path.string(), what)}; };
    if (const auto refusal =
            check_base(simplification, mesh.positions.size() - simplification.collapses.size(),
                       options.base_faces))
    {
        return refuse(*refusal);
    }
    const std::array<std::uint32_t, 3> extent = extent_of(mesh);
    TACTUS_ASSERT(*std::max_element(extent.begin(), extent.end()) >> options.position_bits == 0);
    RegionGrid grid = make_region_grid(
        extent, options.region_size_m ? cell_of(*options.region_size_m, prepared.quantum_m)
                                      : default_cell(extent));
    if (const auto refusal = check_regions(grid, prepared.quantum_m))
    {
        return refuse(*refusal);
    }
    const ModelPieces pieces(prepared, simplification, options.threads);
    if (const auto refusal = check_pieces(pieces))
    {
        return refuse(*refusal);
    }
    mark_occupied(grid, mesh);
    HeaderFields fields = describe(prepared, simplification, pieces, grid, options.position_bits);
    fields.revision = options.revision;
    place_parts(fields, pieces.counts(), grid.count());
    auto file = AtomicFile::create(path);
    if (!file)
    {
        return file.error();
    }
    if (const auto written = write_pieces(file.value(), fields, pieces, grid, options); !written)
    {
        return written.error();
    }
    return fields;
}

} // namespace tactus
