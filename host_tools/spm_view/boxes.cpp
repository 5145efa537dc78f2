// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "host_tools/encode/replay.hpp"
#include "host_tools/spm_view/cut.hpp"
#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/arena.hpp"
#include "rt_core/spm/index_page.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <iterator>
#include <map>
#include <vector>

namespace tactus::view
{

namespace
{

static_assert(std::endian::native == std::endian::little);

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
