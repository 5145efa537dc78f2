// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/pool_memory.hpp"
#include "rt_core/frame/model.hpp"
#include "transport/store/model_store.hpp"

#include <optional>
#include <span>
#include <vector>

namespace tactus::test
{

/// Model with base mesh and selected chunks only, loaded directly.
struct FedModel
{
    /// Parses and links the chunks. The store must outlive it.
    FedModel(const ModelStore& store, std::span<const ChunkId> chunks);

    /// Splits every linked record.
    void split_linked();

    [[nodiscard]] std::uint32_t linked_records() const;
    /// True if the face is active in this state and no record splits it further.
    [[nodiscard]] bool is_exact(FaceId face, FaceState state) const;

private:
    void make_model(std::uint32_t chunks);
    void feed(ChunkId chunk, std::uint32_t slot);

    const ModelStore& store_;
    std::optional<PoolMemory> memory_;
    std::optional<Arena> arena_;
    std::optional<ModelPools> pools_;
    std::optional<Model> model_;
    std::vector<ChunkId> chunks_;
};

} // namespace tactus::test
