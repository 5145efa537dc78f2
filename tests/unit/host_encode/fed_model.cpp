// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_encode/fed_model.hpp"

#include "rt_core/spm/chunk_coding.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace tactus::test
{
namespace
{

std::vector<std::byte> read_piece(const ModelStore& store, ContentKey key)
{
    std::vector<std::byte> coded;
    if (const auto done = store.read(key, coded); !done)
    {
        throw std::runtime_error(done.error().text);
    }
    return coded;
}

} // namespace

FedModel::FedModel(const ModelStore& store, std::span<const ChunkId> chunks)
    : store_(store), chunks_(chunks.begin(), chunks.end())
{
    make_model(static_cast<std::uint32_t>(chunks.size()));
    for (std::uint32_t slot = 0; slot < chunks.size(); ++slot)
    {
        feed(chunks[slot], slot);
    }
    Linker::Update update;
    while (model_->linker.try_take_update(update))
    {
        model_->pages.update_linked(update.chunk, update.slot, update.linked);
    }
}

void FedModel::make_model(std::uint32_t chunks)
{
    const ModelHeader& header = store_.header();
    ModelCapacities capacities;
    capacities.pages = std::max(chunks, 1U);
    capacities.index_pages = 1;
    capacities.faces = header.counts().base_faces + 2 * kRecordsPerChunk * chunks;
    capacities.blocks = capacities.faces / 2 + 2 * AbTree::kReserve;
    capacities.nodes = capacities.blocks;
    Arena scratch = Arena::measuring();
    const RefineScratch beside(scratch, 0);
    memory_.emplace(scratch.used() + required_bytes({&header, 1}, {&capacities, 1}));
    arena_.emplace(memory_->span());
    pools_.emplace(*arena_, capacities, 1);
    const PageSlots slots = pools_->slots.of_model(*arena_, header.counts());
    if (!parse_base_mesh(read_piece(store_, {ContentKind::base, 0}), header, slots.base))
    {
        throw std::runtime_error("the base mesh can't be parsed");
    }
    model_.emplace(*arena_, *pools_, ModelId{0}, header, slots, capacities, best_kernels());
}

void FedModel::feed(ChunkId chunk, std::uint32_t slot)
{
    if (!parse_chunk(read_piece(store_, {ContentKind::chunk, chunk.value}), store_.header(), chunk,
                     model_->slots.pages[slot]))
    {
        throw std::runtime_error("a chunk can't be parsed");
    }
    model_->linker.link_page(chunk, slot);
    model_->pages.adopt(chunk, slot, ChunkCache::kFirstFrame, model_->linker.tell_linked(slot));
}

void FedModel::split_linked()
{
    std::vector<std::pair<std::uint32_t, RecordId>> by_depth;
    for (const ChunkId chunk : chunks_)
    {
        for (std::uint32_t place = 0; place < kRecordsPerChunk; ++place)
        {
            const RecordId id{(chunk.value << kRecordsPerChunkLog2) + place};
            if (const VsplitRecord* record = model_->pages.find_linked(id))
            {
                by_depth.emplace_back(record->depth, id);
            }
        }
    }
    std::sort(by_depth.begin(), by_depth.end());
    for (const auto& [depth, id] : by_depth)
    {
        if (model_->forest.split(id) != VertexForest::SplitOutcome::done)
        {
            throw std::runtime_error("a linked record can't be split");
        }
    }
}

std::uint32_t FedModel::linked_records() const
{
    std::uint32_t linked = 0;
    for (std::uint32_t slot = 0; slot < chunks_.size(); ++slot)
    {
        linked += static_cast<std::uint32_t>(std::popcount(model_->pages.meta(slot).linked));
    }
    return linked;
}

bool FedModel::is_exact(FaceId face, FaceState state) const
{
    const PrimId prim = model_->forest.find(face);
    return prim.value != IdTable::kAbsent && model_->forest.face(prim).state == state &&
           model_->forest.next_of(prim) == kNextExact && model_->forest.error_of(prim) == 0;
}

} // namespace tactus::test
