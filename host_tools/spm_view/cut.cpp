// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/cut.hpp"

#include "host_tools/encode/replay.hpp"
#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/arena.hpp"
#include "rt_core/spm/error_code.hpp"
#include "rt_core/spm/index_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

namespace tactus::view
{

namespace
{

static_assert(std::endian::native == std::endian::little);

template <typename T>
void append(std::string& bytes, const T& value)
{
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// Refusal of pages with split records that the model lacks.
std::optional<Refusal> look_at(const ModelCounts& counts,
                               std::span<const RefinementStatePage> pages)
{
    for (const RefinementStatePage& page : pages)
    {
        if (page.refined == 0)
        {
            continue;
        }
        const auto last = static_cast<std::uint32_t>(std::bit_width(page.refined)) - 1;
        if (page.chunk.value >= counts.chunks() ||
            page.chunk.value * kRecordsPerChunk + last >= counts.records)
        {
            return Refusal{fmt::format(
                "the refinement state has record {} of chunk {}, which the model does not have",
                last, page.chunk.value)};
        }
    }
    return std::nullopt;
}

/// Split records of the pages by depth, then number; each follows the records it depends on.
std::vector<RecordId> split_records(const DecodedModel& model,
                                    std::span<const RefinementStatePage> pages)
{
    std::vector<RecordId> records;
    for (const RefinementStatePage& page : pages)
    {
        for (std::uint64_t bits = page.refined; bits != 0; bits &= bits - 1)
        {
            const auto place = static_cast<std::uint32_t>(std::countr_zero(bits));
            records.push_back({page.chunk.value * kRecordsPerChunk + place});
        }
    }
    std::ranges::sort(records, {},
                      [&](RecordId id) { return std::pair(model.record(id).depth, id.value); });
    return records;
}

/// Faces that are shown, ascending: the active ones without those that edits removed. An active
/// face has its final corners if its error is zero.
std::vector<FaceId> shown_faces(const DecodedModel& model, const Replay& replay,
                                const EditState* edits)
{
    std::vector<FaceId> faces;
    for (std::uint32_t face = 0; face < model.header().counts().face_ids(); ++face)
    {
        const bool is_gone = replay.is_active({face}) && edits != nullptr &&
                             edits->is_removed({face}) &&
                             error_in_quanta(model.error_of({face}, replay.state({face}))) == 0.0F;
        if (replay.is_active({face}) && !is_gone)
        {
            faces.push_back({face});
        }
    }
    return faces;
}

/// Appends the vertices that the faces use, and sets their number. Returns the place of each vertex
/// id among these; kNoneValue for unused ones.
std::vector<std::uint32_t> append_vertices(const DecodedModel& model, const Replay& replay,
                                           std::span<const FaceId> faces, std::uint32_t& count,
                                           std::string& bytes)
{
    constexpr std::uint32_t none = VertexId::kNoneValue;
    std::vector<std::uint32_t> places(model.header().counts().vertices(), none);
    for (const FaceId face : faces)
    {
        for (const VertexId corner : replay.corners(face))
        {
            places[corner.value] = 0;
        }
    }
    count = 0;
    for (std::uint32_t vertex = 0; vertex < places.size(); ++vertex)
    {
        if (places[vertex] != none)
        {
            places[vertex] = count++;
            append(bytes, model.position_m({vertex}));
        }
    }
    return places;
}

} // namespace

std::uint64_t cut_id(std::span<const RefinementStatePage> pages) noexcept
{
    std::uint64_t hash = 0xCBF2'9CE4'8422'2325U;
    const auto add = [&hash](std::uint64_t value)
    {
        for (int shift = 0; shift < 64; shift += 8)
        {
            hash = (hash ^ ((value >> shift) & 0xFFU)) * 0x0000'0100'0000'01B3U;
        }
    };
    for (const RefinementStatePage& page : pages)
    {
        if (page.refined != 0)
        {
            add(page.chunk.value);
            add(page.refined);
        }
    }
    return hash;
}

Result<DecodedModel, Refusal> decode_cut(KnownModel& model,
                                         std::span<const RefinementStatePage> pages, bool whole)
{
    if (auto refusal = look_at(model.header().counts(), pages))
    {
        return *refusal;
    }
    std::vector<RefinementStatePage> needed;
    std::vector<ContentKey> keys;
    for (const RefinementStatePage& page : pages)
    {
        if (page.refined != 0)
        {
            needed.push_back({page.chunk, whole ? page.refined : 0});
            keys.push_back({ContentKind::chunk, page.chunk.value});
        }
    }
    if (auto refusal = model.bring(keys))
    {
        return *refusal;
    }
    std::vector<std::string> damage;
    DecodedModel decoded = DecodedModel::decode_pages(
        model.header(), needed,
        [&](ContentKey key, std::vector<std::byte>& coded) { return model.read(key, coded); },
        model.name(), damage);
    if (!damage.empty())
    {
        return Refusal{damage.front()};
    }
    return decoded;
}

std::optional<Refusal> split_all(Replay& replay, const DecodedModel& model,
                                 std::span<const RefinementStatePage> pages)
{
    if (auto refusal = look_at(model.header().counts(), pages))
    {
        return *refusal;
    }
    for (const RecordId id : split_records(model, pages))
    {
        if (const auto fault = replay.split(id))
        {
            return Refusal{"the refinement state contradicts the model: " + *fault};
        }
    }
    return std::nullopt;
}

std::vector<RefinementStatePage> splittable_part(const DecodedModel& model,
                                                 std::span<const RefinementStatePage> pages)
{
    std::vector<RefinementStatePage> linked(pages.begin(), pages.end());
    std::vector<RefinementStatePage> part = linked;
    for (std::size_t i = 0; i < part.size(); ++i)
    {
        linked[i].refined =
            part[i].refined == 0 ? 0 : part[i].refined & model.linked(part[i].chunk);
        part[i].refined = 0;
    }
    Replay replay(model);
    for (const RecordId id : split_records(model, linked))
    {
        if (!replay.split(id))
        {
            const auto page =
                std::ranges::lower_bound(part, chunk_of(id), {}, &RefinementStatePage::chunk);
            page->refined |= std::uint64_t{1} << place_in_chunk(id);
        }
    }
    return part;
}

Result<std::string, Refusal> cut_bytes(const DecodedModel& model,
                                       std::span<const RefinementStatePage> pages,
                                       const EditState* edits)
{
    Replay replay(model);
    if (auto refusal = split_all(replay, model, pages))
    {
        return *refusal;
    }
    const std::vector<FaceId> faces = shown_faces(model, replay, edits);
    std::uint32_t vertices = 0;
    std::string positions;
    const std::vector<std::uint32_t> places =
        append_vertices(model, replay, faces, vertices, positions);
    std::string corners;
    std::string errors;
    std::string levels;
    const float quantum_m = model.header().quantum_m();
    for (const FaceId face : faces)
    {
        for (const VertexId corner : replay.corners(face))
        {
            append(corners, places[corner.value]);
        }
        const FaceState state = replay.state(face);
        append(errors, error_in_quanta(model.error_of(face, state)) * quantum_m);
        append(levels, state.is_base() ? std::uint16_t{0} : model.record(state.record()).depth);
    }
    auto count = static_cast<std::uint32_t>(faces.size());
    if (edits != nullptr)
    {
        for (const auto& [slot, face] : edits->added())
        {
            for (const Vec3f& corner_m : face.corners_m)
            {
                append(positions, corner_m);
                append(corners, vertices++);
            }
            append(errors, 0.0F);
            append(levels, std::uint16_t{0});
            ++count;
        }
    }
    if (count % 2 != 0)
    {
        append(levels, std::uint16_t{0});
    }
    std::string bytes;
    append(bytes, vertices);
    append(bytes, count);
    return bytes + positions + corners + errors + levels;
}

namespace
{

struct alignas(Arena::kAlignment) Line
{
    std::array<std::byte, Arena::kAlignment> bytes;
};

std::string bytes_of(const std::vector<Aabb>& boxes)
{
    static_assert(sizeof(Aabb) == 6 * sizeof(float));
    const auto count = static_cast<std::uint32_t>(boxes.size());
    std::string bytes(sizeof(count) + boxes.size() * sizeof(Aabb), '\0');
    std::memcpy(bytes.data(), &count, sizeof(count));
    if (count > 0)
    {
        std::memcpy(bytes.data() + sizeof(count), boxes.data(), boxes.size() * sizeof(Aabb));
    }
    return bytes;
}

/// Face in the form in which the controller's forest passes it to the tree.
ChangedFace face_of(const DecodedModel& model, const Replay& replay, FaceId id, PrimId prim)
{
    const ModelCounts counts = model.header().counts();
    const std::uint32_t index = counts.is_base(id) ? 0 : id.value - counts.base_faces;
    ChangedFace face;
    face.prim = prim;
    face.face = id;
    face.bucket = counts.is_base(id) ? model.base_faces()[id.value].bucket
                                     : model.record({index / 2}).bucket[index % 2];
    face.error = model.error_of(id, replay.state(id));
    std::ranges::transform(replay.corners(id), face.corners_m.begin(),
                           [&](VertexId vertex) { return model.position_m(vertex); });
    return face;
}

void add_boxes(const AbTree& tree, TreeRef ref, const Aabb& box, std::uint32_t level,
               std::vector<Aabb>& boxes)
{
    if (level == 0 || ref.is_block())
    {
        boxes.push_back(box);
        return;
    }
    const AbNode& node = tree.node(ref.index());
    for (std::uint32_t child = 0; child < kNodeChildren; ++child)
    {
        if ((node.mask >> child & 1U) != 0)
        {
            add_boxes(tree, node.children[child], node.box_of(child), level - 1, boxes);
        }
    }
}

} // namespace

Result<std::string, Refusal> tree_box_bytes(const DecodedModel& model,
                                            std::span<const RefinementStatePage> pages,
                                            std::uint32_t level)
{
    Replay replay(model);
    if (auto refusal = split_all(replay, model, pages))
    {
        return *refusal;
    }
    // Capacity for the worst case: one face in each block, two children in each node.
    const std::uint32_t faces = replay.face_count();
    const TreeCapacities capacities{faces, faces + AbTree::kReserve, faces + AbTree::kReserve};
    Arena measure = Arena::measuring();
    static_cast<void>(TreePool(measure, capacities));
    std::vector<Line> memory(measure.used() / sizeof(Line) + 1);
    Arena arena(std::as_writable_bytes(std::span(memory)));
    TreePool pool(arena, capacities);
    AbTree tree(pool, ModelId{0}, capacities, model.header().quantum_m());
    std::uint32_t prim = 0;
    for (std::uint32_t id = 0; id < model.header().counts().face_ids(); ++id)
    {
        if (replay.is_active({id}))
        {
            tree.insert(face_of(model, replay, {id}, {prim++}));
        }
    }
    tree.refit();
    std::vector<Aabb> boxes;
    if (!tree.root().is_none())
    {
        add_boxes(tree, tree.root(), tree.box(), std::min(level, kTreeLevelsMax), boxes);
    }
    return bytes_of(boxes);
}

Result<std::string, Refusal> chunk_box_bytes(KnownModel& model, std::span<const ChunkId> chunks)
{
    const ModelCounts counts = model.header().counts();
    std::vector<ContentKey> keys;
    for (const ChunkId chunk : chunks)
    {
        if (chunk.value >= counts.chunks())
        {
            return Refusal{"the refinement state has a chunk that the model does not have"};
        }
        const ContentKey key{ContentKind::index_page, chunk.value >> kChunksPerIndexPageLog2};
        if (keys.empty() || keys.back() != key) // Keys ascend.
        {
            keys.push_back(key);
        }
    }
    if (auto refusal = model.bring(keys))
    {
        return *refusal;
    }
    std::map<std::uint32_t, IndexPage> index;
    std::vector<std::byte> coded;
    for (const ContentKey key : keys)
    {
        const auto done = model.read(key, coded);
        std::array<ChunkEntry, kChunksPerIndexPage> entries;
        if (!done || !parse_index_page(coded, counts, {key.number}, index[key.number], entries))
        {
            return done ? Refusal{"an index page is damaged"} : done.error();
        }
    }
    std::vector<Aabb> boxes;
    const float quantum_m = model.header().quantum_m();
    for (const ChunkId chunk : chunks)
    {
        const std::uint32_t number = chunk.value >> kChunksPerIndexPageLog2;
        const QuantumBox whole = model.header().index_entry({number}).box;
        const InfluenceBox part = index[number].box(chunk.value % kChunksPerIndexPage);
        Aabb& box = boxes.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const auto low = static_cast<float>(whole.low[axis]);
            const auto step = static_cast<float>(index_step(whole.low[axis], whole.high[axis]));
            box.low[axis] = (low + step * static_cast<float>(part.low[axis])) * quantum_m;
            box.high[axis] = (low + step * static_cast<float>(part.high[axis])) * quantum_m;
        }
    }
    return bytes_of(boxes);
}

std::vector<ChunkId> chunks_of(std::span<const RefinementStatePage> pages)
{
    std::vector<ChunkId> chunks;
    std::ranges::transform(pages, std::back_inserter(chunks), &RefinementStatePage::chunk);
    return chunks;
}

} // namespace tactus::view
